// What a programme does to needles, told so that two programmes can be compared.
#pragma once
#include <string>
#include <vector>

#include "notation/program.hpp"

namespace loopwright {

/// A needle instruction that does something, under its racking.
struct NeedleAct {
  Op op;
  Direction direction;
  Needle needle, target;
  double racking;
  std::vector<std::string> carriers;
  SourceLocation at;
  friend bool operator==(const NeedleAct& a, const NeedleAct& b) {
    return a.op == b.op && a.direction == b.direction && a.needle == b.needle && a.target == b.target &&
           a.racking == b.racking && a.carriers == b.carriers;
  }
};

/// In order, needle `first` counted as 0. Left out: misses, and drops and transfers of empty needles;
/// transfers that may come in any order stand in that of their needles.
std::vector<NeedleAct> needle_acts(const Program& program, int first);

}  // namespace loopwright
