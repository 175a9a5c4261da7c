#include "outputs/exchange/write_step.hpp"

#include <array>
#include <map>
#include <string>

#include "geometry/linking.hpp"
#include "outputs/atomic_file.hpp"
#include "outputs/exchange/step_file.hpp"
#include "outputs/yarn_scene.hpp"

namespace loopwright {
namespace {

// The yarn's control points with clamped ends, in mm. Segment e of the yarn lies between the knots e and e +
// 1.
std::vector<Vec3> clamped_control_points(const Fabric& fabric, const FabricYarn& yarn) {
  std::vector<Vec3> q;
  for (int k = 0; k < yarn.segments() + 3; ++k) q.push_back(control_point(fabric, yarn, k));
  std::vector<Vec3> p = clamped(q);
  for (Vec3& each : p) each *= fabric.diameter_mm;
  return p;
}

// How a curve in a colour is presented.
int curve_style(StepWriter& step, const std::array<std::uint8_t, 3>& rgb) {
  const int colour = step.colour(rgb);
  const int font = step.put("DRAUGHTING_PRE_DEFINED_CURVE_FONT('continuous')");
  const int style = step.put("CURVE_STYLE(''," + step_ref(font) + ",POSITIVE_LENGTH_MEASURE(0.1)," +
                             step_ref(colour) + ')');
  return step.put("PRESENTATION_STYLE_ASSIGNMENT((" + step_ref(style) + "))");
}

}  // namespace

void write_step(const std::filesystem::path& path, const Fabric& fabric, const ExportOptions& options) {
  AtomicFile file(path);
  std::ostream& out = file.stream();
  put_step_header(out, fabric, "yarn centrelines");
  StepWriter step(out);
  const StepPart part = put_step_part(step, fabric.name);
  std::vector<int> curves;
  std::vector<std::array<std::uint8_t, 3>> colours;
  for (std::size_t y = 0; y < fabric.yarns.size(); ++y) {
    const FabricYarn& yarn = fabric.yarns[y];
    const std::vector<Vec3> points = clamped_control_points(fabric, yarn);
    for_each_cell(fabric, options, [&](int m, int n, const Vec3& moved) {
      curves.push_back(step.curve(step_name(fabric, options, y, m, n), points, is_closed(yarn),
                                  moved * fabric.diameter_mm));
      colours.push_back(drawn_colour(fabric, y));
    });
  }
  const int set = step.put("GEOMETRIC_CURVE_SET('yarns'," + step_list(curves) + ')');
  const int shape = step.put("GEOMETRICALLY_BOUNDED_WIREFRAME_SHAPE_REPRESENTATION('yarns',(" +
                             step_ref(set) + ")," + step_ref(part.context) + ')');
  step.put("SHAPE_DEFINITION_REPRESENTATION(" + step_ref(part.definition_shape) + ',' + step_ref(shape) +
           ')');
  std::map<std::array<std::uint8_t, 3>, int> styles;
  std::vector<int> styled;
  for (std::size_t k = 0; k < curves.size(); ++k) {
    if (!styles.contains(colours[k])) styles[colours[k]] = curve_style(step, colours[k]);
    styled.push_back(
        step.put("STYLED_ITEM('',(" + step_ref(styles[colours[k]]) + ")," + step_ref(curves[k]) + ')'));
  }
  step.put("MECHANICAL_DESIGN_GEOMETRIC_PRESENTATION_REPRESENTATION(''," + step_list(styled) + ',' +
           step_ref(part.context) + ')');
  put_step_end(out);
  file.commit();
}

}  // namespace loopwright
