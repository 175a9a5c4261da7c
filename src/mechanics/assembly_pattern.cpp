// Which blocks the Hessian has.
#include <algorithm>

#include "base/parallel.hpp"
#include "mechanics/assembly_sums.hpp"

namespace loopwright {
namespace {

constexpr int few_nodes = 400;  // for which a table of all places in the matrix is cheap (640 kB)

// Few control points: a table of all blocks says where each one is, and nothing need be sorted.
template <class EachPair>
void table_pattern(std::size_t nodes, const EachPair& each_pair, BlockMatrix& matrix) {
  matrix.places.assign(nodes * nodes, -1);
  each_pair([&](const FourNodes& a, const FourNodes& b) {
    for (const std::int32_t i : a)
      for (const std::int32_t j : b) {
        matrix.places[static_cast<std::size_t>(i) * nodes + static_cast<std::size_t>(j)] = 0;
        matrix.places[static_cast<std::size_t>(j) * nodes + static_cast<std::size_t>(i)] = 0;
      }
  });
  matrix.column.clear();
  for (std::size_t i = 0; i < nodes; ++i) {
    for (std::size_t j = 0; j < nodes; ++j)
      if (std::int32_t& at = matrix.places[i * nodes + j]; at == 0) {
        at = static_cast<std::int32_t>(matrix.column.size());
        matrix.column.push_back(static_cast<std::int32_t>(j));
      }
    matrix.row_start[i + 1] = static_cast<std::int32_t>(matrix.column.size());
  }
}

}  // namespace

// Many: a row has the control points of the segments that its own control point carries, and of their
// partners. Segments are few and short lists of them quickly sorted; then their runs of four follow in order.
void Assembly::listed_pattern(BlockMatrix& matrix) const {
  matrix.places.clear();
  const auto segments = static_cast<std::size_t>(model_.segments);
  std::vector<std::int32_t> start(segments + 1, 0);
  for (const std::int32_t at : active_) {
    const SegmentPair& p = pairs_[static_cast<std::size_t>(at)];
    ++start[static_cast<std::size_t>(p.a) + 1];
    ++start[static_cast<std::size_t>(p.b) + 1];
  }
  for (std::size_t e = 0; e < segments; ++e) start[e + 1] += start[e];
  std::vector<std::int32_t> partner(static_cast<std::size_t>(start[segments])),
      fill(start.begin(), start.end() - 1);
  for (const std::int32_t at : active_) {
    const SegmentPair& p = pairs_[static_cast<std::size_t>(at)];
    partner[static_cast<std::size_t>(fill[static_cast<std::size_t>(p.a)]++)] = p.b;
    partner[static_cast<std::size_t>(fill[static_cast<std::size_t>(p.b)]++)] = p.a;
  }

  std::vector<std::vector<std::int32_t>> parts(static_cast<std::size_t>(chunk_count()));
  parallel_chunks(chunk_count(), [&](int c) {
    std::vector<std::int32_t>& columns = parts[static_cast<std::size_t>(c)];
    std::vector<std::int32_t> last_row(segments, -1), near;
    const std::int32_t low = first_of_chunk(c), high = first_of_chunk(c + 1);
    columns.reserve(7 * static_cast<std::size_t>(high - low) + 10 * active_.size() / parts.size());  // about
    for (const YarnModel::Yarn& yarn : model_.yarns)
      for (int row = std::max(yarn.first_node, low); row < std::min(yarn.first_node + yarn.nodes, high);
           ++row) {
        near.clear();
        const auto add_segment = [&](std::int32_t e) {
          if (last_row[static_cast<std::size_t>(e)] == row) return;
          last_row[static_cast<std::size_t>(e)] = row;
          near.push_back(e);
        };
        for (int back = 3; back >= 0; --back) {
          int e = row - yarn.first_node - back;
          if (yarn.periodic) e = (e + yarn.segments) % yarn.segments;
          if (e < 0 || e >= yarn.segments) continue;
          e += yarn.first_segment;
          add_segment(e);
          for (auto k = start[static_cast<std::size_t>(e)]; k < start[static_cast<std::size_t>(e) + 1]; ++k)
            add_segment(partner[static_cast<std::size_t>(k)]);
        }
        std::sort(near.begin(), near.end());
        const auto begin = static_cast<std::ptrdiff_t>(columns.size());
        bool in_order = true;  // not where an endless yarn closes
        for (const std::int32_t e : near) {
          const FourNodes n = nodes_of(e);
          in_order = in_order && UpperBlocks::is_run(n);
          for (const std::int32_t j : n)
            if (!in_order || static_cast<std::ptrdiff_t>(columns.size()) == begin || j > columns.back())
              columns.push_back(j);
        }
        if (!in_order) {
          std::sort(columns.begin() + begin, columns.end());
          columns.erase(std::unique(columns.begin() + begin, columns.end()), columns.end());
        }
        matrix.row_start[static_cast<std::size_t>(row) + 1] =
            static_cast<std::int32_t>(static_cast<std::ptrdiff_t>(columns.size()) - begin);
      }
  });
  for (std::size_t i = 0; i + 1 < matrix.row_start.size(); ++i)
    matrix.row_start[i + 1] += matrix.row_start[i];
  matrix.column.clear();
  matrix.column.reserve(static_cast<std::size_t>(matrix.row_start.back()));
  for (const std::vector<std::int32_t>& part : parts)
    matrix.column.insert(matrix.column.end(), part.begin(), part.end());
}

void Assembly::build_pattern(BlockMatrix& matrix) {
  const auto nodes = static_cast<std::size_t>(model_.nodes);
  matrix.row_start.assign(nodes + 1, 0);
  if (model_.nodes <= few_nodes)
    table_pattern(
        nodes,
        [&](const auto& visit) {
          for (int e = 0; e < model_.segments; ++e) visit(nodes_of(e), nodes_of(e));
          for (const std::int32_t at : active_) {
            const SegmentPair& p = pairs_[static_cast<std::size_t>(at)];
            visit(nodes_of(p.a), nodes_of(p.b));
          }
        },
        matrix);
  else
    listed_pattern(matrix);
  diagonal_.resize(nodes);
  for (std::size_t i = 0; i < nodes; ++i) {
    const auto begin = matrix.column.begin() + matrix.row_start[i];
    const auto end = matrix.column.begin() + matrix.row_start[i + 1];
    diagonal_[i] = static_cast<std::int32_t>(std::lower_bound(begin, end, static_cast<std::int32_t>(i)) -
                                             matrix.column.begin());
  }
  matrix.block.assign(matrix.column.size(), Block{});
  matrix.border.assign(nodes, Block{});
  matrix.corner = {};
}

}  // namespace loopwright
