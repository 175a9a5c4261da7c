#include "outputs/exchange/write_points_csv.hpp"

#include <array>
#include <charconv>
#include <cmath>
#include <ostream>
#include <string>

#include "outputs/atomic_file.hpp"
#include "outputs/exchange/yarn_points.hpp"

namespace loopwright {
namespace {

// Nine digits, as in OBJ; what is not a number is an empty field.
void put_field(std::string& line, double value) {
  line += ',';
  if (std::isnan(value)) return;
  std::array<char, 32> text{};
  line.append(
      text.data(),
      std::to_chars(text.data(), text.data() + text.size(), value + 0.0, std::chars_format::general, 9).ptr);
}

std::string header(const Fabric& fabric, const PointSource& source) {
  std::string line = "yarn,x_mm,y_mm,z_mm,arc_mm,curvature_per_mm";
  if (!fabric.loops.empty()) {
    line += ",loop";
    for (const LoopColumn& column : loop_columns) (line += ',') += column.name;
  }
  if (source.forces()) line += ',' + source.forces()->tension_name + ',' + source.forces()->contact_name;
  return line + '\n';
}

}  // namespace

void write_points_csv(const std::filesystem::path& path, const State& state, const ExportOptions& options) {
  const Fabric& fabric = state.fabric;
  const PointSource source(state, options.per_segment);
  AtomicFile file(path);
  std::ostream& out = file.stream();
  out << header(fabric, source);
  for (std::size_t yarn = 0; yarn < fabric.yarns.size(); ++yarn) {
    const YarnPoints points = source.of(yarn);
    for_each_cell(fabric, options, [&](int, int, const Vec3& moved) {
      std::string lines;
      for (std::size_t k = 0; k < points.arc_mm.size(); ++k) {
        lines += std::to_string(yarn);
        const Vec3 place = points.place_mm[k] + moved * fabric.diameter_mm;
        for (int c = 0; c < 3; ++c) put_field(lines, place[c]);
        put_field(lines, points.arc_mm[k]);
        put_field(lines, points.curvature_per_mm[k]);
        if (!fabric.loops.empty()) {
          constexpr double none = std::numeric_limits<double>::quiet_NaN();
          put_field(lines, points.loop[k] < 0 ? none : points.loop[k]);
          for (const LoopColumn& column : loop_columns)
            put_field(lines, points.loop[k] < 0 ? none : loop_value(fabric, column, points.loop[k]));
        }
        if (source.forces()) {
          put_field(lines, points.tension[k]);
          put_field(lines, points.contact[k]);
        }
        lines += '\n';
      }
      out << lines;
    });
  }
  file.commit();
}

}  // namespace loopwright
