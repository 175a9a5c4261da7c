#include "mechanics/linear/lower_columns.hpp"

#include <algorithm>

namespace loopwright {
namespace {

std::size_t size(int i) { return static_cast<std::size_t>(i); }

}  // namespace

void LowerColumns::set_pattern(const BlockMatrix& m, const std::vector<int>& order) {
  const int rows = m.rows();
  std::vector<int> place_of(size(rows));
  for (int p = 0; p < rows; ++p) place_of[size(order.empty() ? p : order[size(p)])] = p;
  start.assign(1, 0);
  row.clear();
  block_start_.assign(1, 0);
  entry_.clear();
  for (int p = 0; p < rows; ++p) {
    const std::size_t i = size(order.empty() ? p : order[size(p)]), first = entry_.size();
    for (int k = m.row_start[i]; k < m.row_start[i + 1]; ++k)
      if (const int place = place_of[size(m.column[size(k)])]; place >= p) entry_.push_back({place, k});
    if (!order.empty())
      std::sort(entry_.begin() + static_cast<std::ptrdiff_t>(first), entry_.end(),
                [](const Entry& a, const Entry& b) { return a.place < b.place; });
    block_start_.push_back(entry_.size());
    for (int r = 0; r < 3; ++r) {
      for (std::size_t e = first; e < entry_.size(); ++e)
        for (int c = entry_[e].place == p ? r : 0; c < 3; ++c) row.push_back(3 * entry_[e].place + c);
      start.push_back(static_cast<int>(row.size()));
    }
  }
  value.resize(row.size());
}

void LowerColumns::set_values(const BlockMatrix& m, double shift) {
  std::size_t at = 0;
  for (std::size_t p = 0; p + 1 < block_start_.size(); ++p)
    for (std::size_t r = 0; r < 3; ++r)
      for (std::size_t e = block_start_[p]; e < block_start_[p + 1]; ++e) {
        const std::size_t k = size(entry_[e].source);
        const Block& b = m.block[k];
        for (std::size_t c = size(entry_[e].place) == p ? r : 0; c < 3; ++c)
          value[at++] = b[3 * r + c] + (c == r ? shift * m.metric[k] : 0);
      }
}

}  // namespace loopwright
