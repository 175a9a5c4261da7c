#include "topology/needle_replay.hpp"

#include <algorithm>

namespace loopwright {

NeedleReplay::NeedleReplay(const Program& program, const KnittingRecord& record)
    : record_(record),
      needles_(program),
      held_(static_cast<std::size_t>(needles_.size())),
      needle_of_(record.loops.size()),
      first_move_(program.instructions.size() + 1) {
  // Moves in order of their instruction, by counting.
  const auto for_each_move = [&](auto&& act) {
    for (std::size_t k = 0; k < record_.loops.size(); ++k) {
      const LoopRecord& loop = record_.loops[k];
      const int placements = static_cast<int>(loop.placements.size());
      for (int p = 0; p < placements; ++p)
        act(loop.placements[static_cast<std::size_t>(p)].instruction, Move{LoopId(k), p});
      if (loop.fate_instruction >= 0) act(loop.fate_instruction, Move{LoopId(k), placements});
    }
  };
  for_each_move([&](int instruction, Move) { ++first_move_[static_cast<std::size_t>(instruction) + 1]; });
  for (std::size_t k = 1; k < first_move_.size(); ++k) first_move_[k] += first_move_[k - 1];
  moves_.resize(static_cast<std::size_t>(first_move_.back()));
  std::vector<int> next(first_move_.begin(), first_move_.end() - 1);
  for_each_move([&](int instruction, Move move) {
    moves_[static_cast<std::size_t>(next[static_cast<std::size_t>(instruction)]++)] = move;
  });
}

void NeedleReplay::advance_to(int instruction) {
  for (; now_ < instruction; ++now_) {
    // Loops by rising id: the older ones leave before the loop that this instruction forms is there.
    for (int m = first_move_[static_cast<std::size_t>(now_)];
         m < first_move_[static_cast<std::size_t>(now_) + 1]; ++m) {
      const Move move = moves_[static_cast<std::size_t>(m)];
      const LoopRecord& loop = record_.loops[move.loop.position()];
      if (move.placement > 0) {
        std::vector<LoopId>& old =
            held_[static_cast<std::size_t>(needles_.position(needle_of_[move.loop.position()]))];
        old.erase(std::find(old.begin(), old.end(), move.loop));
      }
      if (move.placement < static_cast<int>(loop.placements.size())) {
        const Needle needle = loop.placements[static_cast<std::size_t>(move.placement)].needle;
        held_[static_cast<std::size_t>(needles_.position(needle))].push_back(move.loop);
        needle_of_[move.loop.position()] = needle;
      }
    }
  }
  while (next_racking_ < record_.rackings.size() &&
         record_.rackings[next_racking_].instruction <= instruction)
    racking_ = Racking(record_.rackings[next_racking_++].racking);
}

}  // namespace loopwright
