// Loops as stretches of sampled yarn, with their neighbours along it: what readings of a fabric's curves ask.
#pragma once
#include <unordered_map>
#include <vector>

#include "geometry/fabric.hpp"

namespace loopwright {

// One yarn as a polyline that can be asked beyond its ends where it is periodic.
class SampledYarn {
 public:
  static constexpr int per_segment = 4;
  SampledYarn(const Fabric& fabric, const FabricYarn& yarn);
  int size() const { return static_cast<int>(points_.size()); }
  Vec3 at(int i) const;
  double per_length() const { return per_length_; }  // samples in a d of rest length

 private:
  std::vector<Vec3> points_;
  bool periodic_;
  Vec3 shift_;
  double per_length_;
};

// A loop at a lattice image of the cell.
struct LoopImage {
  LoopId loop;
  std::array<int, 2> shift{0, 0};
  friend bool operator==(const LoopImage&, const LoopImage&) = default;
};

struct LoopArc {
  const SampledYarn* yarn = nullptr;
  int order = 0;                     // place in Fabric::loops
  int begin = 0, apex = 0, end = 0;  // in samples
  // Tops of the loops before and after it in its course; where there is none, its own ends.
  int apex_before = 0, apex_after = 0;
  LoopImage before, after;
  Direction direction = Direction::right;
  bool is_tuck = false;
  std::vector<LoopImage> children;
};

class LoopArcs {
 public:
  explicit LoopArcs(const Fabric& fabric);
  LoopArcs(const LoopArcs&) = delete;
  LoopArcs& operator=(const LoopArcs&) = delete;
  const LoopArc* find(LoopId loop) const;
  // Half the length of the median loop, in d, the shorter half of each, so that floats do not count.
  double usual_half() const { return usual_half_; }
  // Up the wale, not of unit length: from loops to their children, averaged along the yarn of the loop, so
  // that a single leaning loop (lace, cable) does not mislead, with a little of the whole piece's where there
  // are few neighbours.
  const Vec3& wale_at(const LoopArc& arc) const { return wales_[static_cast<std::size_t>(arc.order)]; }

 private:
  void add_yarn(const Fabric& fabric, std::size_t first, std::size_t past);
  void find_wales(const Fabric& fabric);
  std::vector<SampledYarn> yarns_;
  std::unordered_map<LoopId, LoopArc> arcs_;
  std::vector<Vec3> wales_;
  double usual_half_ = 1;
};

// Middle of the yarn of a loop.
Vec3 centroid(const LoopArc& arc);

}  // namespace loopwright
