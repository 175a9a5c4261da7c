#include "mechanics/linear/upper_blocks.hpp"

namespace loopwright {
namespace {

// copy(from, to) for the places of every entry above the diagonal and of its mirror image.
template <class Copy>
void mirror(const BlockMatrix& matrix, const std::vector<std::int32_t>& diagonal, const Copy& copy) {
  // Rows in order meet the columns of every earlier row in order too: a cursor in each row is enough.
  std::vector<std::int32_t> next(diagonal);
  const auto rows = static_cast<std::size_t>(matrix.rows());
  for (std::size_t j = 0; j < rows; ++j)
    for (auto k = static_cast<std::size_t>(matrix.row_start[j]); k < static_cast<std::size_t>(diagonal[j]);
         ++k)
      copy(static_cast<std::size_t>(++next[static_cast<std::size_t>(matrix.column[k])]), k);
}

}  // namespace

void mirror_upper(BlockMatrix& matrix, const std::vector<std::int32_t>& diagonal) {
  mirror(matrix, diagonal, [&](std::size_t from, std::size_t to) {
    const Block& b = matrix.block[from];
    matrix.block[to] = {b[0], b[3], b[6], b[1], b[4], b[7], b[2], b[5], b[8]};
  });
}

void mirror_upper_metric(BlockMatrix& matrix, const std::vector<std::int32_t>& diagonal) {
  mirror(matrix, diagonal,
         [&](std::size_t from, std::size_t to) { matrix.metric[to] = matrix.metric[from]; });
}

}  // namespace loopwright
