// Curves of a file -> Fabric: yarns that can be drawn, measured and relaxed.
#pragma once
#include <optional>
#include <string>

#include "geometry/fabric.hpp"
#include "outputs/exchange/curve_file.hpp"

namespace loopwright {

// What the file need not say. What is given here counts more than what the file says.
struct CurveOptions {
  std::optional<double> unit_mm{};      // length of the file's unit; else 1
  std::optional<double> diameter_mm{};  // of every yarn; else the file's, else usual_distance()
  double linear_density_tex = 0;        // 0: unknown
  std::string colour{};                 // for curves without one
  double most_segments = 2e7;           // of all yarns; more is refused: it would be gigabytes
};

struct CurveFabric {
  Fabric fabric;
  bool diameter_guessed = false;  // taken from the distance of the curves
  double departure = 0;           // largest distance of a yarn from its curve, in d of the thickest yarn
};

// Each curve becomes one yarn, sampled at equal steps of arc length and interpolated; a closed one a periodic
// yarn without shift. Steps are small enough that the yarn departs from its curve by less than 1 % of a
// diameter, where half a diameter suffices for that. Loops and interlacings are not known. Ends of open yarns
// are held. The unloaded length is the curve's length. Where z points up in the file, it is turned so that y
// does. Throws std::invalid_argument where a curve is none, or where the diameter is neither said nor to be
// found.
CurveFabric fabric_of_curves(const CurveFile& file, const CurveOptions& options = {});

}  // namespace loopwright
