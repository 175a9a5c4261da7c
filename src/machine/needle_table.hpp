// NeedleTable: the needles that a programme names, numbered without gaps, so that machine state lies in plain
// arrays whatever indices the programme uses (negative ones are common, and a slip may write a very large
// one).
#pragma once
#include <array>
#include <utility>
#include <vector>

#include "notation/program.hpp"

namespace loopwright {

class NeedleTable {
 public:
  explicit NeedleTable(const Program& program);

  int size() const { return static_cast<int>(needles_.size()); }
  const Needle& needle(int position) const { return needles_[static_cast<std::size_t>(position)]; }
  // Place of a needle in the table; it must be one that the programme names. O(1) unless the indices are far
  // apart.
  int position(Needle needle) const;
  // Positions [first, second) of the needles of a bed with an index in [lowest, highest], by rising index.
  std::pair<int, int> range(Bed bed, long long lowest, long long highest) const;

 private:
  struct BedPart {
    int begin = 0, end = 0;     // positions of this bed's needles
    int first_index = 0;        // of its leftmost needle
    std::vector<int> by_index;  // position by index - first_index; empty if the indices are too far apart
  };
  const BedPart& part(Bed bed) const { return parts_[static_cast<std::size_t>(bed)]; }

  std::vector<Needle> needles_;  // by bed, then index
  std::array<BedPart, 4> parts_;
};

// Whether an instruction names a needle, and a second one.
bool names_needle(const Instruction& instruction);
bool names_target(const Instruction& instruction);

}  // namespace loopwright
