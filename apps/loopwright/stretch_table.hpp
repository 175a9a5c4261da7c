// Points of stretch tests and of strain grids as a table.
#pragma once
#include <vector>

#include "experiments/stretch.hpp"
#include "outputs/write_csv.hpp"

namespace loopwright {

Table table_of(const std::vector<StretchPoint>& points);

}  // namespace loopwright
