// Curves as files of other programs hold them, before they are yarns: points and what they mean.
#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "base/vec3.hpp"

namespace loopwright {

// How a curve runs by its points.
enum class CurveBasis {
  through_points,      // some smooth curve goes through them
  catmull_rom,         // uniform; of an open curve the first and last point only give the ends' direction
  bspline,             // uniform cubic; the points are control points
  bezier,              // cubic; every third point is on the curve
  midpoint_quadratic,  // quadratic Bezier pieces from midpoint to midpoint, straight to an open curve's ends
};

struct FileCurve {
  std::vector<Vec3> points;  // in the file's unit
  bool closed = false;       // the last point is not the first again
  double radius = 0;         // in the file's unit; 0: not said
  std::string colour;        // "#rrggbb"; empty: not said
};

struct CurveFile {
  CurveBasis basis = CurveBasis::through_points;
  std::vector<FileCurve> curves;
  bool z_up = false;         // the file says that z points up; else y, as in a fabric
  double diameter_mm = 0;    // the yarn diameter that a comment of the file states; 0: none
  bool millimetres = false;  // a comment says that the unit is the millimetre
};

// Whether the file's suffix is that of curves: .bcc, .yarns or .obj (any letter case).
bool names_curves(const std::filesystem::path& path);

// Reads any of them. Throws FileError that says where and why a file is not what it should be, and for files
// without a curve.
CurveFile read_curve_file(const std::filesystem::path& path);

// The readers of the formats, on text or bytes; `name` is what errors call the file.
CurveFile read_bcc(std::string_view bytes, const std::string& name);
CurveFile read_yarns(std::string_view bytes, const std::string& name);
CurveFile read_obj_curves(std::string_view text, const std::string& name);

}  // namespace loopwright
