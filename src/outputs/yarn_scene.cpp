#include "outputs/yarn_scene.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <span>
#include <stdexcept>

#include "base/parallel.hpp"
#include "base/stop.hpp"
#include "outputs/fuzz.hpp"
#include "outputs/sky.hpp"
#include "outputs/tube_mesh.hpp"

namespace loopwright {
namespace {

// Muted colours that stay apart in lightness too, so that they can be told apart without colour vision.
constexpr std::array<std::array<std::uint8_t, 3>, 8> palette{{{222, 207, 182},
                                                              {62, 88, 122},
                                                              {178, 78, 66},
                                                              {112, 142, 110},
                                                              {226, 170, 86},
                                                              {122, 94, 128},
                                                              {92, 150, 158},
                                                              {92, 84, 78}}};

struct Detail {
  int per_segment, sides;
};

// Rings and sides such that chords stay within a quarter of a pixel of the round tube and of the bent
// centreline.
Detail detail_for(const FabricYarn& yarn, double pixels_per_diameter) {
  const double radius_px = std::max(yarn.diameter * pixels_per_diameter / 2, 0.5);
  const double cosine = std::clamp(1 - 0.25 / radius_px, 0.0, 0.999);
  const int sides = std::clamp(static_cast<int>(std::ceil(std::numbers::pi / std::acos(cosine))), 5, 40);
  // sagitta c^2 kappa / 8 with the curvature of a tight loop, 0.7 / d
  const double chord = std::sqrt(8 * 0.25 / (0.7 * std::max(pixels_per_diameter, 1.0)));
  const double segment = std::max(yarn.segment_rest_length, 1e-3);
  return {std::clamp(static_cast<int>(std::ceil(segment / chord)), 1, 16), sides};
}

std::array<std::int8_t, 4> packed(const Vec3& v) {
  const auto byte = [](double x) {
    return static_cast<std::int8_t>(std::lround(std::clamp(x, -1.0, 1.0) * 127));
  };
  return {byte(v.x), byte(v.y), byte(v.z), 0};
}

std::array<float, 3> as_floats(const Vec3& v) {
  return {static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z)};
}

// Sets the open share of the sky of the vertices from `first` on. Vertices of a ring lie together, so the
// search is shared by a few of them.
void shade_crevices(const Sky& sky, YarnScene& scene, std::size_t first) {
  constexpr std::size_t per_chunk = 8192;
  const auto chunks = static_cast<int>((scene.vertices.size() - first + per_chunk - 1) / per_chunk);
  parallel_chunks(chunks, [&](int chunk) {
    std::vector<SkySample> near;
    Vec3 searched;
    bool fresh = true;
    const std::size_t begin = first + static_cast<std::size_t>(chunk) * per_chunk;
    for (std::size_t k = begin; k < std::min(begin + per_chunk, scene.vertices.size()); ++k) {
      SceneVertex& v = scene.vertices[k];
      const Vec3 p = Vec3{v.position[0], v.position[1], v.position[2]} + scene.centre;
      const Vec3 normal = Vec3{1.0 * v.normal[0], 1.0 * v.normal[1], 1.0 * v.normal[2]} / 127;
      if (fresh || squared_norm(p - searched) > 0.04) {
        sky.gather(p, near);
        searched = p;
        fresh = false;
      }
      v.colour[3] = static_cast<std::uint8_t>(std::lround(255 * Sky::open_share(p, normal, near)));
    }
  });
}

// Adds tubes to the scene. Long yarns are cut where the pattern of plies repeats, so that the arc length
// stays small enough for a float.
class TubeBuilder {
 public:
  TubeBuilder(YarnScene& scene, const Sky& sky, double pixels_per_diameter)
      : scene_(scene), sky_(sky), pixels_per_diameter_(pixels_per_diameter) {}

  // `colours`: by segment; empty: the yarn's own.
  void add(const Fabric& fabric, std::size_t y, std::span<const std::array<std::uint8_t, 3>> colours) {
    const FabricYarn& yarn = fabric.yarns[y];
    const Detail detail = detail_for(yarn, pixels_per_diameter_);
    const std::vector<TubeRing> rings = tube_rings(fabric, yarn, detail.per_segment);
    sides_ = detail.sides;
    // the polygon's perimeter is that of the circle, so that seen from all sides it is as wide on average
    // (Cauchy)
    const double half_step = std::numbers::pi / sides_;
    radius_ = yarn.diameter / 2 * half_step / std::sin(half_step);
    const auto rgb = drawn_colour(fabric, y);
    colour_ = {rgb[0], rgb[1], rgb[2], 255};
    const double length = rings.back().arc;
    // one ply moves to its neighbour's place in this length
    const double pitch = 1 / (scene_.look.plies * std::abs(scene_.look.twist));
    const double whole = std::max(1.0, std::round(length / pitch)) * pitch;
    const double stretch = yarn.periodic && length > 0 ? whole / length : 1;
    repeat_ = yarn.periodic ? whole : 256 * pitch;

    double start = 0;
    const std::size_t first = scene_.vertices.size();
    const auto first_index = static_cast<std::uint32_t>(scene_.indices.size());
    first_vertex_.clear();
    for (std::size_t k = 0; k < rings.size(); ++k) {
      if (!colours.empty()) {
        const auto& here =
            colours[std::min(k / static_cast<std::size_t>(detail.per_segment), colours.size() - 1)];
        colour_ = {here[0], here[1], here[2], 255};
      }
      const double arc = rings[k].arc * stretch - start;
      add_ring(rings[k], arc);
      if (k > 0) join_last_rings();
      if (k % 256 == 0) stop_if_told();
      if (!yarn.periodic && arc > repeat_ && k + 1 < rings.size()) {
        start += repeat_;
        add_ring(rings[k], arc - repeat_);
      }
      first_vertex_.push_back(scene_.vertices.size() - static_cast<std::size_t>(sides_ + 1));
    }
    if (!(yarn.periodic && yarn.shift == std::array<int, 2>{0, 0})) {
      add_cap(rings.front(), -rings.front().tangent);
      add_cap(rings.back(), rings.back().tangent);
    }
    scene_.parts.push_back({first_index, static_cast<std::uint32_t>(6 * sides_ * detail.per_segment),
                            static_cast<std::uint32_t>(scene_.indices.size()) - first_index});
    if (scene_.look.occlusion) shade_crevices(sky_, scene_, first);
    const double thickness = yarn.diameter * pixels_per_diameter_;
    if (scene_.look.fuzz > 0 && thickness >= 14) add_hairs(rings, y, std::min(1.0, thickness / 28));
  }

 private:
  SceneVertex vertex(const TubeRing& ring, const Vec3& out, double turns, double arc) const {
    SceneVertex v;
    v.position = as_floats(ring.centre + out * radius_ - scene_.centre);
    v.along = {static_cast<float>(turns), static_cast<float>(arc), static_cast<float>(repeat_)};
    v.normal = packed(out);
    v.tangent = packed(ring.tangent);
    v.colour = colour_;
    return v;
  }

  // sides + 1 vertices: the last has the place of the first and the angle of a full turn
  void add_ring(const TubeRing& ring, double arc) {
    for (int s = 0; s <= sides_; ++s) {
      const double turns = static_cast<double>(s) / sides_, angle = 2 * std::numbers::pi * turns;
      scene_.vertices.push_back(
          vertex(ring, ring.normal * std::cos(angle) + ring.binormal * std::sin(angle), turns, arc));
    }
  }

  void join_last_rings() {
    const auto n = static_cast<std::uint32_t>(sides_ + 1),
               end = static_cast<std::uint32_t>(scene_.vertices.size());
    const std::uint32_t a = end - 2 * n, c = end - n;
    for (std::uint32_t s = 0; s + 1 < n; ++s)
      scene_.indices.insert(scene_.indices.end(), {a + s, a + s + 1, c + s + 1, a + s, c + s + 1, c + s});
  }

  void add_cap(const TubeRing& ring, const Vec3& outward) {
    const auto base = static_cast<std::uint32_t>(scene_.vertices.size());
    const bool at_end = dot(outward, ring.tangent) > 0;
    for (int s = 0; s < sides_; ++s) {
      const double turns = static_cast<double>(s) / sides_, angle = 2 * std::numbers::pi * turns;
      SceneVertex v = vertex(ring, ring.normal * std::cos(angle) + ring.binormal * std::sin(angle), turns, 0);
      v.normal = packed(outward);
      scene_.vertices.push_back(v);
    }
    for (std::uint32_t s = 1; s + 1 < static_cast<std::uint32_t>(sides_); ++s)
      scene_.indices.insert(scene_.indices.end(),
                            {base, base + s + (at_end ? 0 : 1), base + s + (at_end ? 1 : 0)});
  }

  void add_hairs(const std::vector<TubeRing>& rings, std::size_t y, double share) {
    const auto seed = static_cast<std::uint32_t>(y);
    for (const Hair& hair : loose_fibres(rings, radius_, sides_, 28 * share * scene_.look.fuzz, seed)) {
      for (int i = 0; i < Hair::point_count; ++i) {
        // its root's vertex gives colour, light, normal and tangent
        SceneVertex v = scene_.vertices[first_vertex_[hair.ring] + static_cast<std::size_t>(hair.side)];
        v.position = as_floats(hair.points[static_cast<std::size_t>(i)] - scene_.centre);
        v.along = {static_cast<float>(i) / (Hair::point_count - 1), 0, 1};
        if (i > 0) {
          const auto here = static_cast<std::uint32_t>(scene_.vertices.size());
          scene_.hair_indices.insert(scene_.hair_indices.end(), {here - 1, here});
        }
        scene_.vertices.push_back(v);
      }
    }
  }

  YarnScene& scene_;
  const Sky& sky_;
  double pixels_per_diameter_;
  std::vector<std::size_t> first_vertex_;  // of each ring
  std::array<std::uint8_t, 4> colour_{};
  int sides_ = 0;
  double radius_ = 0, repeat_ = 0;
};

}  // namespace

std::array<int, 2> drawn_repeats(const Fabric& fabric, std::array<int, 2> asked) {
  if (!fabric.periodic) return {1, 1};
  const auto enough = [](int wanted, double per_cell) {
    return wanted > 0 ? wanted : std::max(1, static_cast<int>(std::ceil(6 / std::max(per_cell, 0.5) - 1e-9)));
  };
  return {enough(asked[0], fabric.wales), enough(asked[1], fabric.courses)};
}

Bounds fabric_bounds(const Fabric& fabric, std::array<int, 2> repeats) {
  constexpr double most = std::numeric_limits<double>::max();
  Bounds box{{most, most, most}, {-most, -most, -most}};
  for (const FabricYarn& yarn : fabric.yarns)
    for (const Vec3& p : polyline(fabric, yarn, 4)) {
      if (!is_finite(p))
        throw std::invalid_argument("the fabric has coordinates that are not finite numbers");
      for (int i = 0; i < 3; ++i) {
        box.lower[i] = std::min(box.lower[i], p[i] - yarn.diameter / 2);
        box.upper[i] = std::max(box.upper[i], p[i] + yarn.diameter / 2);
      }
    }
  if (box.lower.x > box.upper.x) throw std::invalid_argument("the fabric has no yarn to draw");
  const Bounds one = box;
  for (const auto& [m, n] :
       {std::pair{repeats[0] - 1, 0}, {0, repeats[1] - 1}, {repeats[0] - 1, repeats[1] - 1}}) {
    const Vec3 shift = fabric.lattice(m, n);
    for (int i = 0; i < 3; ++i) {
      box.lower[i] = std::min(box.lower[i], one.lower[i] + shift[i]);
      box.upper[i] = std::max(box.upper[i], one.upper[i] + shift[i]);
    }
  }
  return box;
}

YarnScene yarn_scene(const Fabric& fabric, const SceneOptions& options) {
  if (options.look.plies < 1 || !(std::abs(options.look.twist) > 1e-3))
    throw std::invalid_argument("a yarn is drawn with 1 ply or more and a twist that is not 0");
  const std::array<int, 2> repeats = drawn_repeats(fabric, options.repeats);
  YarnScene scene;
  scene.look = options.look;
  scene.bounds = fabric_bounds(fabric, repeats);
  scene.centre = scene.bounds.centre();
  for (int n = 0; n < repeats[1]; ++n)
    for (int m = 0; m < repeats[0]; ++m) {
      const Vec3 o = fabric.lattice(m, n);
      scene.offsets.push_back({static_cast<float>(o.x), static_cast<float>(o.y), static_cast<float>(o.z)});
    }
  const Sky sky = options.look.occlusion ? Sky(fabric) : Sky();
  TubeBuilder builder(scene, sky, options.pixels_per_diameter);
  if (!options.colours.empty() && options.colours.size() != fabric.yarns.size())
    throw std::invalid_argument("colours are given for every yarn or for none");
  for (std::size_t y = 0; y < fabric.yarns.size(); ++y)
    builder.add(fabric, y,
                options.colours.empty() ? std::span<const std::array<std::uint8_t, 3>>()
                                        : std::span(options.colours[y]));
  return scene;
}

std::array<std::uint8_t, 3> parsed_colour(std::string_view text, std::array<std::uint8_t, 3> otherwise) {
  if (text.size() != 7 || text[0] != '#') return otherwise;
  std::array<std::uint8_t, 3> rgb{};
  for (std::size_t i = 0; i < 6; ++i) {
    const char c = text[i + 1];
    const int digit = c >= '0' && c <= '9'   ? c - '0'
                      : c >= 'a' && c <= 'f' ? c - 'a' + 10
                      : c >= 'A' && c <= 'F' ? c - 'A' + 10
                                             : -1;
    if (digit < 0) return otherwise;
    rgb[i / 2] = static_cast<std::uint8_t>(rgb[i / 2] * 16 + digit);
  }
  return rgb;
}

std::array<std::uint8_t, 3> drawn_colour(const Fabric& fabric, std::size_t yarn) {
  const CarrierId carrier = fabric.yarns[yarn].carrier;
  const std::size_t place = carrier.valid() ? carrier.position() : yarn;
  return parsed_colour(fabric.yarns[yarn].colour, palette[place % palette.size()]);
}

}  // namespace loopwright
