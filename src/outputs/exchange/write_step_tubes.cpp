#include "outputs/exchange/write_step_tubes.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <string>

#include "geometry/linking.hpp"
#include "outputs/atomic_file.hpp"
#include "outputs/exchange/step_file.hpp"
#include "outputs/exchange/yarn_skin.hpp"
#include "outputs/tube_mesh.hpp"
#include "outputs/yarn_scene.hpp"

namespace loopwright {
namespace {

// The uniform cubic B-spline through `values` at its knots, with the slopes at its ends that are given (per
// knot). Its n + 2 control points, by the tridiagonal system (c_k + 4 c_(k+1) + c_(k+2)) / 6 = value_k.
std::vector<Vec3> spline_through(const std::vector<Vec3>& values, const Vec3& first_slope,
                                 const Vec3& last_slope) {
  const std::size_t n = values.size();
  // the slopes (c_2 - c_0) / 2 take the outer control points out
  std::vector<double> upper(n);
  std::vector<Vec3> x(n);
  for (std::size_t k = 0; k < n; ++k) {
    const bool is_first = k == 0, is_last = k + 1 == n;
    Vec3 right = values[k] * 6;
    if (is_first) right += first_slope * 2;
    if (is_last) right += last_slope * -2;
    const double before = is_first ? 0 : is_last ? 2 : 1, after = is_last ? 0 : is_first ? 2 : 1;
    const double pivot = 4 - (is_first ? 0 : before * upper[k - 1]);
    upper[k] = after / pivot;
    x[k] = (is_first ? right : right - x[k - 1] * before) / pivot;
  }
  std::vector<Vec3> control(n + 2);
  for (std::size_t k = n; k-- > 0;) control[k + 1] = k + 1 == n ? x[k] : x[k] - control[k + 2] * upper[k];
  control[0] = control[2] - first_slope * 2;
  control[n + 1] = control[n - 1] + last_slope * 2;
  return control;
}

// Slope at values[0] from the values there and on, per place; fourth order where there are five.
Vec3 end_slope(const Vec3* values, std::size_t count, std::ptrdiff_t step) {
  const auto at = [&](int k) { return values[k * step]; };
  if (count >= 5) return (at(0) * -25 + at(1) * 48 - at(2) * 36 + at(3) * 16 - at(4) * 3) / 12;
  return at(1) - at(0);
}

// A yarn's tube: control points of C, N and B as uniform cubics over the same knots, in mm; r is in N and B.
struct TubeSpline {
  std::vector<Vec3> centre, normal, binormal;
  struct Ring {
    Vec3 centre, tangent, normal;  // mm, unit, unit
  };
  std::vector<Ring> rings;  // at the knots
};

TubeSpline tube_spline(const Fabric& fabric, const FabricYarn& yarn, int per_segment) {
  const std::vector<TubeRing> rings = tube_rings(fabric, yarn, per_segment);
  const std::size_t n = rings.size();
  std::vector<Vec3> centre, normal, binormal;
  for (const TubeRing& ring : rings) centre.push_back(ring.centre);
  const auto slope_at = [&](int segment) {
    return (control_point(fabric, yarn, segment + 2) - control_point(fabric, yarn, segment)) *
           (0.5 / per_segment);
  };
  TubeSpline tube;
  tube.centre = spline_through(centre, slope_at(0), slope_at(yarn.segments()));
  // frames across the spline's own tangent
  std::vector<Vec3> tangent;
  for (std::size_t k = 0; k < n; ++k) {
    tangent.push_back(normalized(tube.centre[k + 2] - tube.centre[k]));
    normal.push_back(normalized(rings[k].normal - tangent[k] * dot(tangent[k], rings[k].normal)));
    binormal.push_back(cross(tangent[k], normal[k]));
  }
  const bool ring = is_closed(yarn);
  const auto through = [&](std::vector<Vec3>& values) {
    if (ring) values.back() = values.front();
    if (ring && n >= 3) {
      const Vec3 slope = (values[1] - values[n - 2]) / 2;
      return spline_through(values, slope, slope);
    }
    return spline_through(values, end_slope(values.data(), n, 1), -end_slope(&values.back(), n, -1));
  };
  tube.normal = through(normal);
  tube.binormal = through(binormal);
  const double d = fabric.diameter_mm, radius = yarn.diameter / 2 * d;
  for (std::size_t k = 0; k < n; ++k) tube.rings.push_back({centre[k] * d, tangent[k], normal[k]});
  if (ring) tube.rings.back() = tube.rings.front();
  const auto scale = [](std::vector<Vec3>& points, double factor) {
    for (Vec3& p : points) p *= factor;
  };
  scale(tube.centre, d);
  scale(tube.normal, radius);
  scale(tube.binormal, radius);
  return tube;
}

// The nine control points of the unit circle as a rational quadratic; the weights of the corners are
// sqrt(1/2).
constexpr std::array<std::array<double, 2>, 9> circle{
    {{1, 0}, {1, 1}, {0, 1}, {-1, 1}, {-1, 0}, {-1, -1}, {0, -1}, {1, -1}, {1, 0}}};

// The side is cut into faces of so many segments of the yarn: meshers, OpenCASCADE's among them, lose their
// way on one face that winds through a whole course.
constexpr int segments_in_a_face = 2;

class TubeWriter {
 public:
  TubeWriter(StepWriter& step, const TubeSpline& tube, int face_length, double radius, bool ring,
             const Vec3& moved)
      : step_(step),
        tube_(tube),
        face_length_(static_cast<std::size_t>(face_length)),
        radius_(radius),
        ring_(ring),
        moved_(moved) {}

  int solid(const std::string& name) {
    const std::size_t last_knot = tube_.rings.size() - 1;
    const Edges first = edges_at(0);
    Edges from = first;
    std::vector<int> faces;
    for (std::size_t begin = 0; begin < last_knot;) {
      std::size_t end = std::min(begin + face_length_, last_knot);
      if (last_knot - end < face_length_ / 2) end = last_knot;  // no sliver
      const Edges to = ring_ && end == last_knot ? first : edges_at(end);
      faces.push_back(side(begin, end, from, to));
      begin = end, from = to;
    }
    if (!ring_) {
      faces.push_back(face(plane(tube_.rings.front()), {oriented(first.circle, false)}, false));
      faces.push_back(face(plane(tube_.rings.back()), {oriented(from.circle, true)}, true));
    }
    const int shell = step_.put("CLOSED_SHELL(''," + step_list(faces) + ')');
    return step_.put("MANIFOLD_SOLID_BREP(" + step_text(name) + ',' + step_ref(shell) + ')');
  }

 private:
  // The circle where faces meet, and the point on it where it begins and ends.
  struct Edges {
    int vertex = 0, circle = 0;
  };
  Edges edges_at(std::size_t knot) {
    const TubeSpline::Ring& ring = tube_.rings[knot];
    const int point = step_.point(ring.centre + ring.normal * radius_ + moved_);
    Edges edges;
    edges.vertex = step_.put("VERTEX_POINT(''," + step_ref(point) + ')');
    const int curve = step_.put("CIRCLE(''," + step_ref(placement(ring)) + ',' + step_real(radius_) + ')');
    edges.circle = edge(edges.vertex, edges.vertex, curve);
    return edges;
  }

  int side(std::size_t begin, std::size_t end, const Edges& from, const Edges& to) {
    const std::vector<std::vector<int>> rows = put_rows(begin, end);
    const int surface = put_surface(rows);
    const int seam = edge(from.vertex, to.vertex, step_.curve("", rows[0], false));
    return face(surface,
                {oriented(from.circle, true), oriented(seam, true), oriented(to.circle, false),
                 oriented(seam, false)},
                true);
  }

  // Numbers of the surface's control points between two knots, by u, then v.
  std::vector<std::vector<int>> put_rows(std::size_t begin, std::size_t end) {
    const auto part = [&](const std::vector<Vec3>& control) {
      return clamped({control.begin() + static_cast<std::ptrdiff_t>(begin),
                      control.begin() + static_cast<std::ptrdiff_t>(end) + 3});
    };
    const std::vector<Vec3> centre = part(tube_.centre), normal = part(tube_.normal),
                            binormal = part(tube_.binormal);
    std::vector<std::vector<int>> rows(circle.size());
    for (std::size_t u = 0; u + 1 < circle.size(); ++u)
      for (std::size_t v = 0; v < centre.size(); ++v)
        rows[u].push_back(
            step_.point(moved_ + centre[v] + normal[v] * circle[u][0] + binormal[v] * circle[u][1]));
    rows.back() = rows.front();  // the circle ends where it begins
    return rows;
  }

  int put_surface(const std::vector<std::vector<int>>& rows) {
    std::string points = "(", weights = "(";
    for (std::size_t u = 0; u < rows.size(); ++u) {
      points += (u > 0 ? "," : "") + step_list(rows[u]);
      weights += u > 0 ? ",(" : "(";
      const std::string weight = u % 2 == 0 ? "1." : step_real(std::sqrt(0.5));
      for (std::size_t v = 0; v < rows[u].size(); ++v) weights += (v > 0 ? "," : "") + weight;
      weights += ')';
    }
    const std::string knots = clamped_knots(rows[0].size() - 3);
    const std::size_t parted = knots.find("),(");
    return step_.put("(BOUNDED_SURFACE()B_SPLINE_SURFACE(2,3," + points +
                     "),.UNSPECIFIED.,.T.,.F.,.F.)B_SPLINE_SURFACE_WITH_KNOTS((3,2,2,2,3)," +
                     knots.substr(0, parted + 1) + ",(0.,1.,2.,3.,4.)," + knots.substr(parted + 2) +
                     ",.UNSPECIFIED.)GEOMETRIC_REPRESENTATION_ITEM()RATIONAL_B_SPLINE_SURFACE(" + weights +
                     "))REPRESENTATION_ITEM('')SURFACE())");
  }

  int placement(const TubeSpline::Ring& end) {
    const int centre = step_.point(end.centre + moved_), axis = step_.direction(end.tangent),
              across = step_.direction(end.normal);
    return step_.put("AXIS2_PLACEMENT_3D(''," + step_ref(centre) + ',' + step_ref(axis) + ',' +
                     step_ref(across) + ')');
  }
  int plane(const TubeSpline::Ring& end) { return step_.put("PLANE(''," + step_ref(placement(end)) + ')'); }
  int edge(int from, int to, int curve) {
    return step_.put("EDGE_CURVE(''," + step_ref(from) + ',' + step_ref(to) + ',' + step_ref(curve) +
                     ",.T.)");
  }
  int oriented(int edge, bool forward) {
    return step_.put("ORIENTED_EDGE('',*,*," + step_ref(edge) + (forward ? ",.T.)" : ",.F.)"));
  }
  int face(int surface, const std::vector<int>& edges, bool outward) {
    const int loop = step_.put("EDGE_LOOP(''," + step_list(edges) + ')');
    const int bound = step_.put("FACE_OUTER_BOUND(''," + step_ref(loop) + ",.T.)");
    return step_.put("ADVANCED_FACE('',(" + step_ref(bound) + ")," + step_ref(surface) +
                     (outward ? ",.T.)" : ",.F.)"));
  }

  StepWriter& step_;
  const TubeSpline& tube_;
  std::size_t face_length_ = 1;  // knots
  double radius_ = 0;
  bool ring_ = false;
  Vec3 moved_;
};

int surface_style(StepWriter& step, const std::array<std::uint8_t, 3>& rgb) {
  int number = step.put("FILL_AREA_STYLE_COLOUR(''," + step_ref(step.colour(rgb)) + ')');
  number = step.put("FILL_AREA_STYLE('',(" + step_ref(number) + "))");
  number = step.put("SURFACE_STYLE_FILL_AREA(" + step_ref(number) + ')');
  number = step.put("SURFACE_SIDE_STYLE('',(" + step_ref(number) + "))");
  number = step.put("SURFACE_STYLE_USAGE(.BOTH.," + step_ref(number) + ')');
  return step.put("PRESENTATION_STYLE_ASSIGNMENT((" + step_ref(number) + "))");
}

}  // namespace

void write_step_tubes(const std::filesystem::path& path, const Fabric& fabric, const ExportOptions& options) {
  check_tube_options(options);
  AtomicFile file(path);
  std::ostream& out = file.stream();
  put_step_header(out, fabric, "yarns as solids");
  StepWriter step(out);
  const StepPart part = put_step_part(step, fabric.name);
  std::vector<int> solids, styled;
  std::map<std::array<std::uint8_t, 3>, int> styles;
  for (std::size_t y = 0; y < fabric.yarns.size(); ++y) {
    const FabricYarn& yarn = fabric.yarns[y];
    const TubeSpline tube = tube_spline(fabric, yarn, options.per_segment);
    const auto rgb = drawn_colour(fabric, y);
    if (!styles.contains(rgb)) styles[rgb] = surface_style(step, rgb);
    for_each_cell(fabric, options, [&](int m, int n, const Vec3& moved) {
      TubeWriter writer(step, tube, segments_in_a_face * options.per_segment,
                        yarn.diameter / 2 * fabric.diameter_mm, is_closed(yarn), moved * fabric.diameter_mm);
      solids.push_back(writer.solid(step_name(fabric, options, y, m, n)));
      styled.push_back(
          step.put("STYLED_ITEM('',(" + step_ref(styles[rgb]) + ")," + step_ref(solids.back()) + ')'));
    });
  }
  const int shape = step.put("ADVANCED_BREP_SHAPE_REPRESENTATION('yarns'," + step_list(solids) + ',' +
                             step_ref(part.context) + ')');
  step.put("SHAPE_DEFINITION_REPRESENTATION(" + step_ref(part.definition_shape) + ',' + step_ref(shape) +
           ')');
  step.put("MECHANICAL_DESIGN_GEOMETRIC_PRESENTATION_REPRESENTATION(''," + step_list(styled) + ',' +
           step_ref(part.context) + ')');
  put_step_end(out);
  file.commit();
}

}  // namespace loopwright
