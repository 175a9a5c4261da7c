#include "outputs/exchange/curves_to_fabric.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "geometry/fit_fabric.hpp"
#include "outputs/exchange/curve_distance.hpp"
#include "outputs/exchange/curve_pieces.hpp"

namespace loopwright {
namespace {

// The yarn's segments, in d: the first step that is tried, how close the yarn is to come to its curve, and
// where trying ends.
constexpr double first_step = 1.25, close_enough = 0.01, least_step = 0.5;

struct Placed {
  ArcLengthCurve curve;
  const FileCurve* of;
};

// Samples at equal steps of arc length, `segments` of them; the end too where the curve is open.
std::vector<Vec3> equal_steps(const ArcLengthCurve& curve, bool closed, int segments, double scale) {
  std::vector<Vec3> samples;
  for (int k = 0; k < segments + (closed ? 0 : 1); ++k)
    samples.push_back(curve.at(curve.length() * k / segments) * scale);
  return samples;
}

double departure(const Fabric& fabric, const FabricYarn& yarn, const ArcLengthCurve& curve, double scale) {
  double most = 0;
  constexpr int between = 4;
  const int n = yarn.segments();
  for (int k = 0; k < n * between; ++k) {
    const double t = static_cast<double>(k) / between;
    const Vec3 off = position(fabric, yarn, t) - curve.at(curve.length() * t / n) * scale;
    // only what is across the curve: a shift along it changes nothing
    const Vec3 along =
        position(fabric, yarn, std::min(t + 0.01, 1.0 * n)) - position(fabric, yarn, std::max(t - 0.01, 0.0));
    const double length = norm(along);
    most = std::max(most, length > 0 ? norm(cross(along, off)) / length : norm(off));
  }
  return most;
}

FabricYarn yarn_of(const Fabric& fabric, const Placed& placed, double scale, double diameter, double step,
                   double& departs) {
  FabricYarn yarn;
  yarn.diameter = diameter;
  yarn.periodic = placed.of->closed;
  const double length = placed.curve.length() * scale;
  for (;; step *= 0.75) {
    const int segments = std::max(yarn.periodic ? 6 : 4, static_cast<int>(std::lround(length / step)));
    yarn.segment_rest_length = length / segments;
    const std::vector<Vec3> samples = equal_steps(placed.curve, yarn.periodic, segments, scale);
    yarn.control_points = yarn.periodic ? periodic_control_points(samples, {}) : open_control_points(samples);
    departs = departure(fabric, yarn, placed.curve, scale);
    if (departs < close_enough * diameter || 0.75 * step < least_step * diameter) break;
  }
  yarn.held.assign(yarn.control_points.size(), 0);
  if (!yarn.periodic) {
    const std::size_t n = yarn.held.size();
    yarn.held[0] = yarn.held[1] = yarn.held[n - 2] = yarn.held[n - 1] = 1;
  }
  return yarn;
}

std::vector<Placed> placed_curves(const CurveFile& file) {
  std::vector<Placed> all;
  for (std::size_t k = 0; k < file.curves.size(); ++k) {
    const FileCurve& curve = file.curves[k];
    const std::string which = "curve " + std::to_string(k);
    constexpr double farthest = 1e12;  // in the file's unit
    for (const Vec3& p : curve.points)
      if (!(std::abs(p.x) < farthest && std::abs(p.y) < farthest && std::abs(p.z) < farthest))
        throw std::invalid_argument(which + " has a point beyond all measure");
    std::vector<BezierPiece> pieces = bezier_pieces(file.basis, curve);
    if (pieces.empty())
      throw std::invalid_argument(which + " has too few points (" + std::to_string(curve.points.size()) +
                                  ") to be a curve");
    if (file.z_up)
      for (BezierPiece& piece : pieces)
        for (Vec3& p : piece) p = {p.x, p.z, -p.y};
    all.push_back({ArcLengthCurve(std::move(pieces)), &curve});
    const double length = all.back().curve.length();
    if (!(length > 0) || !std::isfinite(length))
      throw std::invalid_argument(which + " has no length: all its points are in one place");
  }
  return all;
}

// Neighbouring points of the curves, in the file's unit: steps of a fraction of those of the file's own
// points.
std::vector<std::vector<Vec3>> close_points(const std::vector<Placed>& curves) {
  std::vector<std::vector<Vec3>> points;
  for (const Placed& placed : curves) {
    constexpr int steps_a_point = 4;
    const auto steps = static_cast<int>(placed.of->points.size()) * steps_a_point;
    points.push_back(equal_steps(placed.curve, placed.of->closed, steps, 1));
  }
  return points;
}

// Diameter of every yarn in mm.
std::vector<double> diameters(const CurveFile& file, const CurveOptions& options,
                              const std::vector<Placed>& curves, double unit_mm, bool& guessed) {
  std::vector<double> mm;
  for (const FileCurve& curve : file.curves)
    mm.push_back(options.diameter_mm ? *options.diameter_mm
                 : curve.radius > 0  ? 2 * curve.radius * unit_mm
                                     : file.diameter_mm);
  if (std::find(mm.begin(), mm.end(), 0.0) == mm.end()) return mm;
  const std::optional<double> found = usual_distance(close_points(curves));
  if (!found)
    throw std::invalid_argument(
        "the file does not say how thick its yarn is, and its curves do not show it: say it with --yarn "
        "diameter=0.5mm, or so");
  guessed = true;
  for (double& each : mm)
    if (each == 0) each = *found * unit_mm;
  return mm;
}

void set_size(Fabric& fabric) {
  constexpr double inf = std::numeric_limits<double>::infinity();
  Vec3 low{inf, inf, inf}, high = -low;
  for (const FabricYarn& yarn : fabric.yarns)
    for (const Vec3& p : polyline(fabric, yarn, 4))
      for (int c = 0; c < 3; ++c) {
        low[c] = std::min(low[c], p[c] - yarn.diameter / 2);
        high[c] = std::max(high[c], p[c] + yarn.diameter / 2);
      }
  fabric.width = high.x - low.x;
  fabric.height = high.y - low.y;
}

}  // namespace

CurveFabric fabric_of_curves(const CurveFile& file, const CurveOptions& options) {
  const auto positive = [](std::optional<double> value, const char* what) {
    if (value && !(std::isfinite(*value) && *value > 0))
      throw std::invalid_argument(std::string(what) + " must be a positive number");
  };
  positive(options.unit_mm, "the unit of a file of curves");
  positive(options.diameter_mm, "the yarn's diameter");
  const double unit_mm = options.unit_mm.value_or(1);
  const std::vector<Placed> curves = placed_curves(file);

  CurveFabric result;
  Fabric& fabric = result.fabric;
  const std::vector<double> mm = diameters(file, options, curves, unit_mm, result.diameter_guessed);
  fabric.diameter_mm = *std::max_element(mm.begin(), mm.end());
  const double scale = unit_mm / fabric.diameter_mm;
  constexpr double farthest = 1e9;  // d
  for (const FileCurve& curve : file.curves)
    for (const Vec3& p : curve.points)
      if (norm(p) * scale > farthest)
        throw std::invalid_argument("the curves are too far from the origin for yarn of " +
                                    std::to_string(fabric.diameter_mm) +
                                    " mm: say --yarn diameter=... or --unit MM");
  double segments = 0;
  for (std::size_t k = 0; k < curves.size(); ++k)
    segments += curves[k].curve.length() * unit_mm / mm[k] / least_step;
  if (!(segments < options.most_segments))
    throw std::invalid_argument("the curves are too long for yarn of " + std::to_string(fabric.diameter_mm) +
                                " mm: " + std::to_string(segments) +
                                " pieces; say --yarn diameter=... or --unit");
  for (std::size_t k = 0; k < curves.size(); ++k) {
    const double diameter = mm[k] / fabric.diameter_mm;
    double departs = 0;
    FabricYarn yarn = yarn_of(fabric, curves[k], scale, diameter, first_step * diameter, departs);
    yarn.yarn = YarnId(k);
    yarn.colour = curves[k].of->colour.empty() ? options.colour : curves[k].of->colour;
    yarn.linear_density_tex = options.linear_density_tex;
    result.departure = std::max(result.departure, departs);
    fabric.yarns.push_back(std::move(yarn));
  }
  set_size(fabric);
  return result;
}

}  // namespace loopwright
