// The correlation model of the first paper (section 4.1): type value points from binding points.
//
//   q = A b + q0(R)
//
// b: places of the binding points (masses), q: type value points, A: sparse, rows that sum to 1: a point of
// head or foot follows one binding point (T1, T3, T4, T5, T7), one of the middle of a leg both of its loop
// (T2, T6), one of a sinker the lower ones of the two loops that it joins (T0, T8), as equations (3) to (5)
// say. The offsets q0 are kept in each loop's own frame (course, wale and normal direction from its
// neighbours), else the far side of a tube would face the wrong way; with the frames R frozen, as over one
// step, the map is linear in b and its derivative is A.
#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "base/rotation.hpp"
#include "base/vec3.hpp"
#include "geometry/yarn_curves.hpp"
#include "topology/binding_points.hpp"

namespace loopwright {

class CorrelationMap {
 public:
  // Rows: the points of all yarns of `curves` in their order, as they are when the binding points are at
  // `places` (one for each of points.points). The curves must be whole yarns of the graph.
  CorrelationMap(const YarnGraph& graph, const BindingPoints& points, const std::vector<Vec3>& places,
                 const YarnCurves& curves);

  std::size_t rows() const { return first_.size() - 1; }
  std::size_t masses() const { return masses_; }

  // One rotation a loop: from its frame at the start to its frame now. A loop whose neighbours lie in a line
  // or at one place keeps its attitude; `known`, if wanted, is 0 for it and 1 for all others.
  std::vector<Rotation> frames(std::span<const Vec3> places,
                               std::vector<std::uint8_t>* known = nullptr) const;
  // q for given frames; `q` gets rows() points.
  void map(std::span<const Vec3> places, std::span<const Rotation> frames, std::vector<Vec3>& q) const;
  // A b alone, and its transpose: forces on points to forces on masses.
  void linear(std::span<const Vec3> b, std::vector<Vec3>& out) const;
  void transposed(std::span<const Vec3> q, std::vector<Vec3>& out) const;

  struct Entry {
    std::int32_t column;  // mass
    double weight;
    std::int32_t loop;  // whose frame turns this share of the offset
  };
  std::span<const Entry> row(std::size_t r) const {
    return {entries_.data() + first_[r], static_cast<std::size_t>(first_[r + 1] - first_[r])};
  }

 private:
  struct Stencil {
    std::int32_t left = 0, right = 0, below = 0, above = 0;  // masses
  };
  std::size_t masses_ = 0;
  std::vector<std::int32_t> first_;  // [row + 1]
  std::vector<Entry> entries_;
  std::vector<Vec3> offset_;           // [row] in the frame of the start
  std::vector<Stencil> stencils_;      // [loop]
  std::vector<Rotation> start_frame_;  // [loop]
};

// Curves with the same points at other places; rows in the order of the yarns.
YarnCurves moved_curves(const YarnCurves& curves, const std::vector<Vec3>& q);

// Whether the yarn goes on from one loop to the next as to a neighbour in the course: not where it turns at
// an edge and the second is drawn through the first or lies right above it.
bool joined_by_weft(const BindingPoints& points, LoopId from, LoopId to);

}  // namespace loopwright
