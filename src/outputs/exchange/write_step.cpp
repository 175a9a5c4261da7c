#include "outputs/exchange/write_step.hpp"

#include <array>
#include <charconv>
#include <map>
#include <ostream>
#include <string>

#include "geometry/linking.hpp"
#include "outputs/atomic_file.hpp"
#include "outputs/yarn_scene.hpp"

namespace loopwright {
namespace {

// ISO 10303-21 wants a point in every real and a capital E: "1." and "2.5E-7".
std::string real(double value) {
  std::array<char, 40> text{};
  const auto end = std::to_chars(text.data(), text.data() + text.size(), value + 0.0).ptr;
  std::string out(text.data(), end);
  const std::size_t exponent = out.find('e');
  const bool point = out.find('.') != std::string::npos;
  if (exponent != std::string::npos) out[exponent] = 'E';
  if (!point) out.insert(exponent == std::string::npos ? out.size() : exponent, ".");
  return out;
}

// A text of the file: quotes doubled, what is not plain ASCII left out.
std::string quoted(const std::string& text) {
  std::string out = "'";
  for (const char c : text) {
    if (c < ' ' || c > '~' || c == '\\') continue;
    out += c;
    if (c == '\'') out += c;
  }
  return out + "'";
}

// The yarn's control points with clamped ends, in mm. Segment e of the yarn lies between the knots e and e +
// 1; the outer control points become the curve's end and the one that its end derivative asks for.
std::vector<Vec3> clamped_control_points(const Fabric& fabric, const FabricYarn& yarn) {
  std::vector<Vec3> q;
  for (int k = 0; k < yarn.segments() + 3; ++k) q.push_back(control_point(fabric, yarn, k));
  const std::size_t n = q.size();
  std::vector<Vec3> p = q;
  p[0] = (q[0] + q[1] * 4 + q[2]) / 6;
  p[1] = (q[1] * 2 + q[2]) / 3;
  p[n - 2] = (q[n - 3] + q[n - 2] * 2) / 3;
  p[n - 1] = (q[n - 3] + q[n - 2] * 4 + q[n - 1]) / 6;
  if (n == 4) p[1] = (q[1] * 2 + q[2]) / 3, p[2] = (q[1] + q[2] * 2) / 3;  // one segment
  for (Vec3& each : p) each *= fabric.diameter_mm;
  return p;
}

class StepWriter {
 public:
  explicit StepWriter(std::ostream& out) : out_(out) {}

  // Writes one instance and returns its number.
  int put(const std::string& entity) {
    out_ << '#' << ++last_ << '=' << entity << ";\n";
    return last_;
  }

  int point(const Vec3& p) {
    return put("CARTESIAN_POINT('',(" + real(p.x) + ',' + real(p.y) + ',' + real(p.z) + "))");
  }

  int curve(const std::string& name, const std::vector<Vec3>& points, bool closed, const Vec3& moved) {
    const int first = last_ + 1;
    for (const Vec3& p : points) point(p + moved);
    const std::size_t segments = points.size() - 3;
    std::string text = "B_SPLINE_CURVE_WITH_KNOTS(" + quoted(name) + ",3,(";
    for (std::size_t k = 0; k < points.size(); ++k)
      text += (k > 0 ? ",#" : "#") + std::to_string(first + static_cast<int>(k));
    text += std::string("),.UNSPECIFIED.,") + (closed ? ".T." : ".F.") + ",.F.,(";
    for (std::size_t k = 0; k <= segments; ++k)
      text += std::string(k > 0 ? "," : "") + (k == 0 || k == segments ? "4" : "1");
    text += "),(";
    for (std::size_t k = 0; k <= segments; ++k) text += (k > 0 ? "," : "") + std::to_string(k) + '.';
    return put(text + "),.UNSPECIFIED.)");
  }

  // The presentation of a curve in a colour.
  int styled(int curve, const std::array<std::uint8_t, 3>& rgb) {
    if (!styles_.contains(rgb)) {
      const int colour = put("COLOUR_RGB(''," + real(rgb[0] / 255.0) + ',' + real(rgb[1] / 255.0) + ',' +
                             real(rgb[2] / 255.0) + ')');
      const int font = put("DRAUGHTING_PRE_DEFINED_CURVE_FONT('continuous')");
      const int style = put("CURVE_STYLE('',#" + std::to_string(font) + ",POSITIVE_LENGTH_MEASURE(0.1),#" +
                            std::to_string(colour) + ')');
      styles_[rgb] = put("PRESENTATION_STYLE_ASSIGNMENT((#" + std::to_string(style) + "))");
    }
    return put("STYLED_ITEM('',(#" + std::to_string(styles_[rgb]) + "),#" + std::to_string(curve) + ')');
  }

  std::string list(const std::vector<int>& numbers) const {
    std::string text = "(";
    for (const int number : numbers) text += (text.size() > 1 ? ",#" : "#") + std::to_string(number);
    return text + ")";
  }

 private:
  std::ostream& out_;
  int last_ = 0;
  std::map<std::array<std::uint8_t, 3>, int> styles_;
};

void put_header(std::ostream& out, const Fabric& fabric) {
  out << "ISO-10303-21;\nHEADER;\nFILE_DESCRIPTION(('yarn centrelines; yarn diameter "
      << number_text(fabric.diameter_mm) << " mm'),'2;1');\nFILE_NAME(" << quoted(fabric.name)
      << ",'',(''),(''),'Loopwright','Loopwright','');\n"
      << "FILE_SCHEMA(('AUTOMOTIVE_DESIGN { 1 0 10303 214 1 1 1 1 }'));\nENDSEC;\nDATA;\n";
}

// The part that the curves belong to, and the units: what every STEP part begins with. Returns the context of
// the geometry and the part's definition.
struct Part {
  int context = 0, definition_shape = 0;
};

Part put_part(StepWriter& step, const std::string& name) {
  const auto ref = [](int number) { return '#' + std::to_string(number); };
  const int application =
      step.put("APPLICATION_CONTEXT('core data for automotive mechanical design processes')");
  step.put("APPLICATION_PROTOCOL_DEFINITION('international standard','automotive_design',2000," +
           ref(application) + ')');
  const int product_context = step.put("PRODUCT_CONTEXT(''," + ref(application) + ",'mechanical')");
  const std::string title = quoted(name.empty() ? "fabric" : name);
  const int product = step.put("PRODUCT(" + title + ',' + title + ",'',(" + ref(product_context) + "))");
  step.put("PRODUCT_RELATED_PRODUCT_CATEGORY('part',$,(" + ref(product) + "))");
  const int formation = step.put("PRODUCT_DEFINITION_FORMATION('',''," + ref(product) + ')');
  const int context =
      step.put("PRODUCT_DEFINITION_CONTEXT('part definition'," + ref(application) + ",'design')");
  const int definition =
      step.put("PRODUCT_DEFINITION('design',''," + ref(formation) + ',' + ref(context) + ')');
  Part part;
  part.definition_shape = step.put("PRODUCT_DEFINITION_SHAPE('',''," + ref(definition) + ')');
  const int length = step.put("(LENGTH_UNIT()NAMED_UNIT(*)SI_UNIT(.MILLI.,.METRE.))");
  const int angle = step.put("(NAMED_UNIT(*)PLANE_ANGLE_UNIT()SI_UNIT($,.RADIAN.))");
  const int solid = step.put("(NAMED_UNIT(*)SI_UNIT($,.STERADIAN.)SOLID_ANGLE_UNIT())");
  const int near = step.put("UNCERTAINTY_MEASURE_WITH_UNIT(LENGTH_MEASURE(1.E-7)," + ref(length) +
                            ",'distance_accuracy_value','')");
  part.context = step.put("(GEOMETRIC_REPRESENTATION_CONTEXT(3)GLOBAL_UNCERTAINTY_ASSIGNED_CONTEXT((" +
                          ref(near) + "))GLOBAL_UNIT_ASSIGNED_CONTEXT((" + ref(length) + ',' + ref(angle) +
                          ',' + ref(solid) + "))REPRESENTATION_CONTEXT('','3D'))");
  return part;
}

}  // namespace

void write_step(const std::filesystem::path& path, const Fabric& fabric, const ExportOptions& options) {
  AtomicFile file(path);
  std::ostream& out = file.stream();
  put_header(out, fabric);
  StepWriter step(out);
  const Part part = put_part(step, fabric.name);
  std::vector<int> curves;
  std::vector<std::array<std::uint8_t, 3>> colours;
  for (std::size_t y = 0; y < fabric.yarns.size(); ++y) {
    const FabricYarn& yarn = fabric.yarns[y];
    const std::vector<Vec3> points = clamped_control_points(fabric, yarn);
    const bool closed = is_closed(yarn);
    for_each_cell(fabric, options, [&](int m, int n, const Vec3& moved) {
      std::string name = "yarn_" + std::to_string(y);
      if (cell_count(fabric, options) > 1) name += "_cell_" + std::to_string(m) + '_' + std::to_string(n);
      curves.push_back(step.curve(name, points, closed, moved * fabric.diameter_mm));
      colours.push_back(drawn_colour(fabric, y));
    });
  }
  const auto ref = [](int number) { return '#' + std::to_string(number); };
  const int set = step.put("GEOMETRIC_CURVE_SET('yarns'," + step.list(curves) + ')');
  const int shape = step.put("GEOMETRICALLY_BOUNDED_WIREFRAME_SHAPE_REPRESENTATION('yarns',(" + ref(set) +
                             ")," + ref(part.context) + ')');
  step.put("SHAPE_DEFINITION_REPRESENTATION(" + ref(part.definition_shape) + ',' + ref(shape) + ')');
  std::vector<int> styled;
  for (std::size_t k = 0; k < curves.size(); ++k) styled.push_back(step.styled(curves[k], colours[k]));
  step.put("MECHANICAL_DESIGN_GEOMETRIC_PRESENTATION_REPRESENTATION(''," + step.list(styled) + ',' +
           ref(part.context) + ')');
  out << "ENDSEC;\nEND-ISO-10303-21;\n";
  file.commit();
}

}  // namespace loopwright
