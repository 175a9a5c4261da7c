// What the files of a fabric for other programs have in common.
#pragma once
#include <array>

#include "geometry/fabric.hpp"

namespace loopwright {

struct ExportOptions {
  int per_segment = 4;               // polyline steps on a spline segment
  int sides = 8;                     // corners of a tube's cross-section
  std::array<int, 2> repeats{1, 1};  // periodic fabrics: cells along each lattice vector; 1 x 1 otherwise
  bool quadratic_beams = false;      // beam elements of three nodes (B32), not of two (B31)
};

// Calls visit(cell m, cell n, offset in d) for every copy of the cell that is wanted, row by row; once for a
// fabric that is not periodic.
template <class Visit>
void for_each_cell(const Fabric& fabric, const ExportOptions& options, Visit visit) {
  const int columns = fabric.periodic ? options.repeats[0] : 1,
            rows = fabric.periodic ? options.repeats[1] : 1;
  for (int n = 0; n < rows; ++n)
    for (int m = 0; m < columns; ++m) visit(m, n, fabric.lattice(m, n));
}

// How many copies for_each_cell() visits.
inline std::size_t cell_count(const Fabric& fabric, const ExportOptions& options) {
  if (!fabric.periodic) return 1;
  return static_cast<std::size_t>(options.repeats[0]) * static_cast<std::size_t>(options.repeats[1]);
}

}  // namespace loopwright
