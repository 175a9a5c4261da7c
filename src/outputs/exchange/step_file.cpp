#include "outputs/exchange/step_file.hpp"

#include <charconv>

#include "outputs/atomic_file.hpp"

namespace loopwright {

std::string step_real(double value) {
  std::array<char, 40> text{};
  const auto end = std::to_chars(text.data(), text.data() + text.size(), value + 0.0).ptr;
  std::string out(text.data(), end);
  const std::size_t exponent = out.find('e');
  const bool point = out.find('.') != std::string::npos;
  if (exponent != std::string::npos) out[exponent] = 'E';
  if (!point) out.insert(exponent == std::string::npos ? out.size() : exponent, ".");
  return out;
}

std::string step_text(const std::string& text) {
  std::string out = "'";
  for (const char c : text) {
    if (c < ' ' || c > '~' || c == '\\') continue;
    out += c;
    if (c == '\'') out += c;
  }
  return out + "'";
}

std::string step_list(const std::vector<int>& numbers) {
  std::string text = "(";
  for (const int number : numbers) text += (text.size() > 1 ? ",#" : "#") + std::to_string(number);
  return text + ")";
}

std::string clamped_knots(std::size_t segments) {
  std::string text = "(";
  for (std::size_t k = 0; k <= segments; ++k)
    text += std::string(k > 0 ? "," : "") + (k == 0 || k == segments ? "4" : "1");
  text += "),(";
  for (std::size_t k = 0; k <= segments; ++k) text += (k > 0 ? "," : "") + std::to_string(k) + '.';
  return text + ")";
}

int StepWriter::colour(const std::array<std::uint8_t, 3>& rgb) {
  if (!colours_.contains(rgb))
    colours_[rgb] = put("COLOUR_RGB(''," + step_real(rgb[0] / 255.0) + ',' + step_real(rgb[1] / 255.0) + ',' +
                        step_real(rgb[2] / 255.0) + ')');
  return colours_[rgb];
}

int StepWriter::curve(const std::string& name, const std::vector<int>& points, bool closed) {
  return put("B_SPLINE_CURVE_WITH_KNOTS(" + step_text(name) + ",3," + step_list(points) + ",.UNSPECIFIED.," +
             (closed ? ".T." : ".F.") + ",.F.," + clamped_knots(points.size() - 3) + ",.UNSPECIFIED.)");
}

int StepWriter::curve(const std::string& name, const std::vector<Vec3>& points, bool closed,
                      const Vec3& moved) {
  std::vector<int> numbers;
  numbers.reserve(points.size());
  for (const Vec3& p : points) numbers.push_back(point(p + moved));
  return curve(name, numbers, closed);
}

std::string step_name(const Fabric& fabric, const ExportOptions& options, std::size_t yarn, int m, int n) {
  std::string name = "yarn_" + std::to_string(yarn);
  if (cell_count(fabric, options) > 1) name += "_cell_" + std::to_string(m) + '_' + std::to_string(n);
  return name;
}

void put_step_header(std::ostream& out, const Fabric& fabric, const std::string& what) {
  out << "ISO-10303-21;\nHEADER;\nFILE_DESCRIPTION(('" << what << "; yarn diameter "
      << number_text(fabric.diameter_mm) << " mm'),'2;1');\nFILE_NAME(" << step_text(fabric.name)
      << ",'',(''),(''),'Loopwright','Loopwright','');\n"
      << "FILE_SCHEMA(('AUTOMOTIVE_DESIGN { 1 0 10303 214 1 1 1 1 }'));\nENDSEC;\nDATA;\n";
}

void put_step_end(std::ostream& out) { out << "ENDSEC;\nEND-ISO-10303-21;\n"; }

StepPart put_step_part(StepWriter& step, const std::string& name) {
  const int application =
      step.put("APPLICATION_CONTEXT('core data for automotive mechanical design processes')");
  step.put("APPLICATION_PROTOCOL_DEFINITION('international standard','automotive_design',2000," +
           step_ref(application) + ')');
  const int product_context = step.put("PRODUCT_CONTEXT(''," + step_ref(application) + ",'mechanical')");
  const std::string title = step_text(name.empty() ? "fabric" : name);
  const int product = step.put("PRODUCT(" + title + ',' + title + ",'',(" + step_ref(product_context) + "))");
  step.put("PRODUCT_RELATED_PRODUCT_CATEGORY('part',$,(" + step_ref(product) + "))");
  const int formation = step.put("PRODUCT_DEFINITION_FORMATION('',''," + step_ref(product) + ')');
  const int context =
      step.put("PRODUCT_DEFINITION_CONTEXT('part definition'," + step_ref(application) + ",'design')");
  const int definition =
      step.put("PRODUCT_DEFINITION('design',''," + step_ref(formation) + ',' + step_ref(context) + ')');
  StepPart part;
  part.definition_shape = step.put("PRODUCT_DEFINITION_SHAPE('',''," + step_ref(definition) + ')');
  const int length = step.put("(LENGTH_UNIT()NAMED_UNIT(*)SI_UNIT(.MILLI.,.METRE.))");
  const int angle = step.put("(NAMED_UNIT(*)PLANE_ANGLE_UNIT()SI_UNIT($,.RADIAN.))");
  const int solid = step.put("(NAMED_UNIT(*)SI_UNIT($,.STERADIAN.)SOLID_ANGLE_UNIT())");
  const int near = step.put("UNCERTAINTY_MEASURE_WITH_UNIT(LENGTH_MEASURE(1.E-7)," + step_ref(length) +
                            ",'distance_accuracy_value','')");
  part.context = step.put("(GEOMETRIC_REPRESENTATION_CONTEXT(3)GLOBAL_UNCERTAINTY_ASSIGNED_CONTEXT((" +
                          step_ref(near) + "))GLOBAL_UNIT_ASSIGNED_CONTEXT((" + step_ref(length) + ',' +
                          step_ref(angle) + ',' + step_ref(solid) + "))REPRESENTATION_CONTEXT('','3D'))");
  return part;
}

std::vector<Vec3> clamped(const std::vector<Vec3>& q) {
  const std::size_t n = q.size();
  std::vector<Vec3> p = q;
  p[0] = (q[0] + q[1] * 4 + q[2]) / 6;
  p[1] = (q[1] * 2 + q[2]) / 3;
  p[n - 2] = (q[n - 3] + q[n - 2] * 2) / 3;
  p[n - 1] = (q[n - 3] + q[n - 2] * 4 + q[n - 1]) / 6;
  if (n == 4) p[1] = (q[1] * 2 + q[2]) / 3, p[2] = (q[1] + q[2] * 2) / 3;  // one segment
  return p;
}

}  // namespace loopwright
