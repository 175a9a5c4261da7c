#include "cloth_at_hand.hpp"

#include <algorithm>
#include <cmath>

namespace loopwright {
namespace {

bool same_loop(const Loop& a, const Loop& b) {
  return a.yarn == b.yarn && a.order == b.order && a.kind == b.kind && a.side == b.side &&
         a.direction == b.direction && a.slot == b.slot && a.head_slot == b.head_slot && a.bed == b.bed &&
         a.head_bed == b.head_bed && a.head_rank == b.head_rank && a.head_count == b.head_count &&
         a.parents == b.parents && a.children == b.children && a.fate == b.fate;
}

bool same_float(const Float& a, const Float& b) {
  return std::equal(
      a.passed.begin(), a.passed.end(), b.passed.begin(), b.passed.end(),
      [](const PassedLoop& p, const PassedLoop& q) { return p.loop == q.loop && p.bed == q.bed; });
}

bool same_yarn(const GraphYarn& a, const GraphYarn& b) {
  return a.loops == b.loops &&
         std::equal(a.floats.begin(), a.floats.end(), b.floats.begin(), b.floats.end(), same_float);
}

bool same_shape(const FabricYarn& a, const FabricYarn& b) {
  return a.yarn == b.yarn && a.periodic == b.periodic && a.shift == b.shift && a.held == b.held &&
         a.control_points.size() == b.control_points.size();
}

bool same_part(const Fabric& a, const Fabric& b) {
  return a.periodic == b.periodic &&
         std::equal(a.yarns.begin(), a.yarns.end(), b.yarns.begin(), b.yarns.end(), same_shape) &&
         std::equal(
             a.loops.begin(), a.loops.end(), b.loops.begin(), b.loops.end(),
             [](const LoopSpan& p, const LoopSpan& q) { return p.loop == q.loop && p.yarn == q.yarn; }) &&
         std::equal(a.interlacings.begin(), a.interlacings.end(), b.interlacings.begin(),
                    b.interlacings.end(), [](const PlacedInterlacing& p, const PlacedInterlacing& q) {
                      return p.parent == q.parent && p.child == q.child && p.sign == q.sign &&
                             p.shift == q.shift;
                    });
}

// Largest change of a yarn's length, as a share.
double most_change_of_length(const Fabric& from, const Fabric& to, double scale) {
  double most = 0;
  for (std::size_t y = 0; y < from.yarns.size(); ++y)
    most = std::max(
        most, std::abs(to.yarns[y].segment_rest_length / (from.yarns[y].segment_rest_length * scale) - 1));
  return most;
}

// Whether every piece of yarn has its place without growing in: cores must stay out of each other.
bool has_room(const ClothAtHand& hand, const Fabric& started, double scale, const RelaxOptions& options) {
  double thickest = 0;
  bool thinner = scale >= 1;
  for (std::size_t y = 0; y < started.yarns.size(); ++y) {
    thickest = std::max(thickest, started.yarns[y].diameter);
    thinner = thinner && started.yarns[y].diameter <= hand.relaxed->fabric.yarns[y].diameter * scale;
  }
  const double core = options.model.material.contact.core;
  if (thinner && core <= hand.options->model.material.contact.core) return true;
  constexpr double gap = 1.05;
  return min_clearance(started).distance > gap * core * thickest;
}

}  // namespace

bool same_topology(const YarnGraph& a, const YarnGraph& b) {
  return std::equal(a.loops.begin(), a.loops.end(), b.loops.begin(), b.loops.end(), same_loop) &&
         std::equal(a.yarns.begin(), a.yarns.end(), b.yarns.begin(), b.yarns.end(), same_yarn) &&
         std::equal(a.leg_crossings.begin(), a.leg_crossings.end(), b.leg_crossings.begin(),
                    b.leg_crossings.end(), [](const LegCrossing& p, const LegCrossing& q) {
                      return p.front == q.front && p.back == q.back;
                    });
}

std::optional<Fabric> start_from_cloth_at_hand(const ClothAtHand& hand, const Knitting& knitting,
                                               const Fabric& first, RelaxOptions& options) {
  const Fabric& rest = hand.relaxed->fabric;
  if (!same_part(first, rest) || !same_topology(knitting.graph, hand.knitting->graph)) return std::nullopt;
  // the same places in millimetres, in the unit of the new yarn
  const double scale = rest.diameter_mm / first.diameter_mm;
  Fabric started = first;
  for (std::size_t y = 0; y < started.yarns.size(); ++y)
    for (std::size_t i = 0; i < started.yarns[y].control_points.size(); ++i)
      started.yarns[y].control_points[i] = rest.yarns[y].control_points[i] * scale;
  started.width = rest.width * scale, started.height = rest.height * scale, started.skew = rest.skew * scale;
  const InterlacingCheck check = check_interlacings(started);
  if (check.intact < check.expected) return std::nullopt;
  constexpr double little = 0.15;  // relax() takes larger changes of length in stages as yarn grows in
  options.grow_in =
      most_change_of_length(rest, first, scale) > little || !has_room(hand, started, scale, options);
  const FlatPlates& plates = hand.relaxed->plates;
  if (plates.stiffness > 0)
    options.model.plates = {plates.stiffness, plates.low * scale, plates.high * scale};
  return started;
}

}  // namespace loopwright
