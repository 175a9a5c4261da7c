// A file's curve as cubic Bezier pieces, whatever its basis is, and places on it by arc length.
#pragma once
#include <array>
#include <vector>

#include "outputs/exchange/curve_file.hpp"

namespace loopwright {

using BezierPiece = std::array<Vec3, 4>;

// Exact for all bases but through_points, which is the C2 cubic through the points (chord-length knots).
// Empty where there are too few points for a piece.
std::vector<BezierPiece> bezier_pieces(CurveBasis basis, const FileCurve& curve);

// Arc length along pieces, by chords of an eighth of a piece.
class ArcLengthCurve {
 public:
  explicit ArcLengthCurve(std::vector<BezierPiece> pieces);
  double length() const { return arc_.back(); }
  Vec3 at(double arc) const;  // on the curve; arc from 0 to length()

 private:
  static constexpr std::size_t parts = 8;
  std::vector<BezierPiece> pieces_;
  std::vector<double> arc_;  // at every part's ends
};

}  // namespace loopwright
