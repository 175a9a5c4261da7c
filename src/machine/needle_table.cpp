#include "machine/needle_table.hpp"

#include <algorithm>

namespace loopwright {
namespace {

bool left_of(const Needle& a, const Needle& b) { return a.index < b.index; }

}  // namespace

bool names_needle(const Instruction& instruction) { return instruction.op >= Op::knit; }

bool names_target(const Instruction& instruction) {
  return instruction.op == Op::split || instruction.op == Op::xfer;
}

NeedleTable::NeedleTable(const Program& program) {
  // A bed with few distinct needles that lie close together gets a direct table of its indices.
  std::array<std::vector<Needle>, 4> named;
  for (const Instruction& instruction : program.instructions) {
    if (names_needle(instruction))
      named[static_cast<std::size_t>(instruction.needle.bed)].push_back(instruction.needle);
    if (names_target(instruction))
      named[static_cast<std::size_t>(instruction.target.bed)].push_back(instruction.target);
  }
  for (std::size_t bed = 0; bed < named.size(); ++bed) {
    std::vector<Needle>& bed_needles = named[bed];
    BedPart& part = parts_[bed];
    part.begin = part.end = size();
    if (bed_needles.empty()) continue;
    const auto [leftmost, rightmost] = std::minmax_element(bed_needles.begin(), bed_needles.end(), left_of);
    const int first_index = leftmost->index;
    const long long width = 1LL + rightmost->index - first_index;
    part.first_index = first_index;
    if (width <= 4 * static_cast<long long>(bed_needles.size()) + 4096) {
      // Mark, then number from left to right.
      part.by_index.assign(static_cast<std::size_t>(width), -1);
      for (const Needle& n : bed_needles) part.by_index[static_cast<std::size_t>(n.index - first_index)] = 0;
      for (std::size_t k = 0; k < part.by_index.size(); ++k) {
        if (part.by_index[k] < 0) continue;
        part.by_index[k] = size();
        needles_.push_back({static_cast<Bed>(bed), first_index + static_cast<int>(k)});
      }
    } else {
      std::sort(bed_needles.begin(), bed_needles.end());
      bed_needles.erase(std::unique(bed_needles.begin(), bed_needles.end()), bed_needles.end());
      needles_.insert(needles_.end(), bed_needles.begin(), bed_needles.end());
    }
    part.end = size();
  }
}

int NeedleTable::position(Needle needle) const {
  const BedPart& bed = part(needle.bed);
  if (!bed.by_index.empty()) return bed.by_index[static_cast<std::size_t>(needle.index - bed.first_index)];
  return range(needle.bed, needle.index, needle.index).first;
}

std::pair<int, int> NeedleTable::range(Bed bed, long long lowest, long long highest) const {
  const BedPart& bed_part = part(bed);
  const auto begin = needles_.begin() + bed_part.begin, end = needles_.begin() + bed_part.end;
  const auto first =
      std::lower_bound(begin, end, lowest, [](const Needle& n, long long i) { return n.index < i; });
  const auto last =
      std::upper_bound(first, end, highest, [](long long i, const Needle& n) { return i < n.index; });
  return {static_cast<int>(first - needles_.begin()), static_cast<int>(last - needles_.begin())};
}

}  // namespace loopwright
