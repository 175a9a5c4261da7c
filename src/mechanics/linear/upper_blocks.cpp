#include "mechanics/linear/upper_blocks.hpp"

namespace loopwright {

void mirror_upper(BlockMatrix& matrix, const std::vector<std::int32_t>& diagonal) {
  // Rows in order meet the columns of every earlier row in order too: a cursor in each row is enough.
  std::vector<std::int32_t> next(diagonal);
  const auto rows = static_cast<std::size_t>(matrix.rows());
  for (std::size_t j = 0; j < rows; ++j)
    for (auto k = static_cast<std::size_t>(matrix.row_start[j]); k < static_cast<std::size_t>(diagonal[j]);
         ++k) {
      const auto i = static_cast<std::size_t>(matrix.column[k]);
      const Block& b = matrix.block[static_cast<std::size_t>(++next[i])];
      matrix.block[k] = {b[0], b[3], b[6], b[1], b[4], b[7], b[2], b[5], b[8]};
    }
}

}  // namespace loopwright
