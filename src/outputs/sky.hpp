// How much of the sky each point of a yarn's surface sees past the other yarn: the soft light of an overcast
// day, which is what makes a drawn knit read as one. It depends on the cloth alone, so it holds while the
// camera moves.
#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "geometry/fabric.hpp"

namespace loopwright {

// A short piece of yarn that hides sky.
struct SkySample {
  Vec3 centre, tangent;
  double radius = 0, length = 0;
};

class Sky {
 public:
  Sky() = default;
  // Pieces of half a diameter of all yarns, and of the lattice images within reach, in a uniform grid.
  explicit Sky(const Fabric& fabric);

  // The pieces within reach of a place on a centreline. Those of the same straight tube are among them and do
  // no harm: they lie below the horizon of every point of its surface.
  void gather(const Vec3& centre, std::vector<SkySample>& near) const;

  // Open share, 0 to 1, seen from a surface point with unit normal: exp(-sum of form factors), where a piece
  // of length h and radius r at distance D and angle b to its axis shows the area 2 r h sin b, so the share
  // cos a / (pi D^2) of it in the cosine-weighted hemisphere. The exponential stands for pieces that hide
  // each other.
  static double open_share(const Vec3& point, const Vec3& normal, const std::vector<SkySample>& near);

 private:
  std::size_t cell(const Vec3& p) const;

  std::vector<SkySample> samples_;     // sorted by cell
  std::vector<std::uint32_t> starts_;  // per cell, and one past the end
  Vec3 origin_;
  std::array<int, 3> cells_{0, 0, 0};
  double reach_ = 0;
};

}  // namespace loopwright
