// The frame of a STEP file (ISO 10303-21, schema AP214): instances one by one, the part and its units.
#pragma once
#include <array>
#include <cstdint>
#include <map>
#include <ostream>
#include <string>
#include <vector>

#include "outputs/export_options.hpp"

namespace loopwright {

// ISO 10303-21 wants a point in every real and a capital E: "1." and "2.5E-7".
std::string step_real(double value);
// A text of the file: quotes doubled, what is not plain ASCII left out.
std::string step_text(const std::string& text);
inline std::string step_ref(int number) { return '#' + std::to_string(number); }
// "(#1,#2)".
std::string step_list(const std::vector<int>& numbers);
// Multiplicities and knots of a clamped cubic with so many equal segments: "(4,1,4),(0.,1.,2.)".
std::string clamped_knots(std::size_t segments);

class StepWriter {
 public:
  explicit StepWriter(std::ostream& out) : out_(out) {}

  // Writes one instance and returns its number.
  int put(const std::string& entity) {
    out_ << '#' << ++last_ << '=' << entity << ";\n";
    return last_;
  }
  int point(const Vec3& p) { return put("CARTESIAN_POINT(''," + triple(p) + ')'); }
  int direction(const Vec3& unit) { return put("DIRECTION(''," + triple(unit) + ')'); }
  int colour(const std::array<std::uint8_t, 3>& rgb);
  // A clamped cubic B-spline curve by its control points, or by their numbers.
  int curve(const std::string& name, const std::vector<int>& points, bool closed);
  int curve(const std::string& name, const std::vector<Vec3>& points, bool closed, const Vec3& moved);

 private:
  static std::string triple(const Vec3& p) {
    return '(' + step_real(p.x) + ',' + step_real(p.y) + ',' + step_real(p.z) + ')';
  }
  std::ostream& out_;
  int last_ = 0;
  std::map<std::array<std::uint8_t, 3>, int> colours_;
};

// "yarn_0", or "yarn_0_cell_2_1" where several cells are written.
std::string step_name(const Fabric& fabric, const ExportOptions& options, std::size_t yarn, int m, int n);

void put_step_header(std::ostream& out, const Fabric& fabric, const std::string& what);
void put_step_end(std::ostream& out);

// The part that the geometry belongs to, and the units (mm, radian): what every STEP part begins with.
struct StepPart {
  int context = 0, definition_shape = 0;
};
StepPart put_step_part(StepWriter& step, const std::string& name);

// The control points of a spline's ends as a clamped spline has them: the outer two at either end move, the
// curve does not. `q`: uniform cubic, at least 4.
std::vector<Vec3> clamped(const std::vector<Vec3>& q);

}  // namespace loopwright
