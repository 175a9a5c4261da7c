// CrossingTracker: which loops racking carried past each other, and which of the two was in front.
//
// Only racking moves loops sideways, and only a front and a back loop move relative to each other. While both
// stay on their needles, racking there and back cancels, so a pair's passing depends on two rackings alone:
// when the later of the two came onto its needle, and when the first of them leaves. So nothing is done when
// the bed is racked; when a loop leaves its needle, it is compared with the few loops of the opposite bed
// that the racking can have carried past.
//
// What a pair has met is one whole number, like the exponent of a two-strand braid: each passing counts +1 if
// the loop in front went to the right, -1 if to the left, in halves when one ends up facing the other (on one
// needle, say). Passings that undo each other cancel; two that wind the loops round each other add up.
#pragma once
#include <vector>

#include "machine/knitting_record.hpp"
#include "machine/needle_table.hpp"
#include "machine/racking.hpp"

namespace loopwright {

class CrossingTracker {
 public:
  // `stacks` by position in `needles`; both must outlive the tracker.
  CrossingTracker(const NeedleTable& needles, const std::vector<std::vector<LoopId>>& stacks)
      : needles_(needles), stacks_(stacks) {}

  void reserve(std::size_t loops) { arrived_.reserve(loops); }
  void rack(const Racking& racking);
  void arrive(LoopId loop);                                 // a loop came onto a needle, formed or moved
  void leave(LoopId loop, Needle needle, int instruction);  // it is about to leave; stacks still as they were
  std::vector<LoopCrossing> net_crossings(int instruction);  // at the end: loops still held count as leaving

 private:
  struct Passing {
    LoopId low, high;    // the pair, by id
    int order = 0;       // of `low` to `high` before: -1 left of it, 0 facing it, +1 right of it
    int half_turns = 0;  // how far the loop in front went: +2 right past the other, -2 left
    bool low_in_front = false;
    int instruction = -1;
  };

  const NeedleTable& needles_;
  const std::vector<std::vector<LoopId>>& stacks_;
  std::vector<Racking> rackings_{Racking()};  // every racking there was
  std::vector<std::int32_t> arrived_;         // by loop: index into rackings_ when it came onto its needle
  long long lowest_ = 0, highest_ = 0;        // floors of the rackings so far
  std::vector<Passing> passings_;
};

}  // namespace loopwright
