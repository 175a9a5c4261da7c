// NeedleReplay: runs a KnittingRecord once more and knows at every instruction which loops each needle holds.
#pragma once
#include <utility>
#include <vector>

#include "machine/knitting_record.hpp"
#include "machine/needle_table.hpp"
#include "machine/racking.hpp"

namespace loopwright {

class NeedleReplay {
 public:
  NeedleReplay(const Program& program, const KnittingRecord& record);

  // State just before `instruction` moves loops, at the racking at which it acts; must not go back in time.
  void advance_to(int instruction);
  const NeedleTable& needles() const { return needles_; }
  const std::vector<LoopId>& held(int position) const { return held_[static_cast<std::size_t>(position)]; }
  const Racking& racking() const { return racking_; }
  // Needle that holds a loop now, or the last one that did.
  Needle needle_of(LoopId loop) const { return needle_of_[loop.position()]; }

 private:
  struct Move {
    LoopId loop;
    int placement = 0;  // index into its placements; past the end: it leaves the needles
  };

  const KnittingRecord& record_;
  NeedleTable needles_;
  std::vector<std::vector<LoopId>> held_;  // by needle position
  std::vector<Needle> needle_of_;          // by loop
  std::vector<int> first_move_;            // by instruction, then one past the end: ranges of moves_
  std::vector<Move> moves_;
  int now_ = 0;  // instructions before this one are done
  std::size_t next_racking_ = 0;
  Racking racking_;
};

}  // namespace loopwright
