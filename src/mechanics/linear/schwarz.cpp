#include "mechanics/linear/schwarz.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdlib>

#include "base/parallel.hpp"

namespace loopwright {
namespace {

constexpr int patch_nodes = 250;  // wanted in a patch, its overlap not counted

std::size_t place(std::int32_t i) { return static_cast<std::size_t>(i); }

// Cells of a grid over the places' bounding box, nearly square, with about `patch_nodes` points each.
struct PatchGrid {
  Vec3 low, high;
  int nx = 1, ny = 1;

  explicit PatchGrid(const std::vector<Vec3>& places) : low(places.front()), high(places.front()) {
    for (const Vec3& p : places)
      for (int k = 0; k < 3; ++k) {
        low[k] = std::min(low[k], p[k]);
        high[k] = std::max(high[k], p[k]);
      }
    const double area = (high.x - low.x) * (high.y - low.y);
    const double side = std::sqrt(std::max(1e-12, area * patch_nodes / static_cast<double>(places.size())));
    nx = std::max(1, static_cast<int>(std::lround((high.x - low.x) / side)));
    ny = std::max(1, static_cast<int>(std::lround((high.y - low.y) / side)));
  }
  std::size_t cell(const Vec3& p) const {
    const auto along = [](double v, double least, double most, int cells) {
      return std::clamp(static_cast<int>((v - least) / std::max(1e-12, most - least) * cells), 0, cells - 1);
    };
    return static_cast<std::size_t>(along(p.y, low.y, high.y, ny)) * static_cast<std::size_t>(nx) +
           static_cast<std::size_t>(along(p.x, low.x, high.x, nx));
  }
};

// Adds the neighbours along the yarn: a quarter of a loop wherever a yarn leaves the patch. (Neighbours in
// contact as well would save a tenth of the iterations and cost a third more memory.) `in` is all zero before
// and after.
void add_overlap(const BlockMatrix& matrix, std::vector<std::uint8_t>& in, std::vector<std::int32_t>& nodes) {
  constexpr int reach = 3;  // control points of one segment
  for (const std::int32_t i : nodes) in[place(i)] = 1;
  const std::size_t count = nodes.size();
  for (std::size_t k = 0; k < count; ++k)
    for (auto e = matrix.row_start[place(nodes[k])]; e < matrix.row_start[place(nodes[k]) + 1]; ++e) {
      const std::int32_t j = matrix.column[place(e)];
      if (in[place(j)] != 0 || std::abs(j - nodes[k]) > reach) continue;
      in[place(j)] = 1;
      nodes.push_back(j);
    }
  for (const std::int32_t i : nodes) in[place(i)] = 0;
  std::sort(nodes.begin(), nodes.end());
}

// R (A, D) R' for the sorted nodes of a patch, without border.
BlockMatrix patch_matrix(const BlockMatrix& matrix, const std::vector<std::int32_t>& nodes) {
  BlockMatrix m;
  m.row_start.assign(1, 0);
  for (const std::int32_t i : nodes) {
    auto at = nodes.begin();  // columns of a row are sorted, and so are the nodes
    for (auto e = matrix.row_start[place(i)]; e < matrix.row_start[place(i) + 1]; ++e) {
      const std::int32_t column = matrix.column[place(e)];
      at = std::lower_bound(at, nodes.end(), column);
      if (at == nodes.end()) break;
      if (*at != column) continue;
      m.column.push_back(static_cast<std::int32_t>(at - nodes.begin()));
      m.block.push_back(matrix.block[place(e)]);
      m.metric.push_back(matrix.metric[place(e)]);
    }
    m.row_start.push_back(static_cast<std::int32_t>(m.column.size()));
  }
  m.border.assign(nodes.size(), Block{});
  m.corner = {1, 0, 0, 0, 1, 0, 0, 0, 1};
  return m;
}

}  // namespace

void Schwarz::set_patches(const std::vector<Vec3>& places, const std::vector<std::uint8_t>& held,
                          const BlockMatrix& matrix, const CoarseSpace& coarse) {
  const PatchGrid grid(places);
  std::vector<std::vector<std::int32_t>> own(place(grid.nx * grid.ny));
  for (std::size_t i = 0; i < places.size(); ++i)
    own[grid.cell(places[i])].push_back(static_cast<std::int32_t>(i));
  coarse_ = coarse.points > 0 ? coarse : hat_space(places, held, grid.nx, grid.ny);

  patches_.clear();
  std::vector<std::uint8_t> in(places.size(), 0);
  for (auto& nodes : own) {
    if (nodes.empty()) continue;
    add_overlap(matrix, in, nodes);
    patches_.push_back(std::make_unique<Patch>());
    patches_.back()->nodes = std::move(nodes);
  }
}

bool Schwarz::factor(const BlockMatrix& matrix, double shift) {
  std::atomic<bool> definite{true};
  parallel_chunks(static_cast<int>(patches_.size()), [&](int p) {
    if (!definite) return;  // the answer is known; patches are left as they are
    Patch& patch = *patches_[place(p)];
    if (!patch.factor.factor(patch_matrix(matrix, patch.nodes), shift)) definite = false;
    patch.factor.compact();
  });
  if (!definite) return false;
  BlockMatrix seen_by_coarse;
  coarse_.project(matrix, shift, seen_by_coarse);
  if (!coarse_factor_.factor(seen_by_coarse, 0)) return false;
  coarse_factor_.compact();
  return true;
}

void Schwarz::solve(const Unknowns& b, Unknowns& x) {
  parallel_chunks(static_cast<int>(patches_.size()), [&](int p) {
    Patch& patch = *patches_[place(p)];
    patch.right.u.resize(patch.nodes.size());
    for (std::size_t k = 0; k < patch.nodes.size(); ++k) patch.right.u[k] = b.u[place(patch.nodes[k])];
    patch.factor.solve(patch.right, patch.result);
  });
  x.u.assign(b.u.size(), Vec3{});
  for (const auto& patch : patches_)
    for (std::size_t k = 0; k < patch->nodes.size(); ++k) x.u[place(patch->nodes[k])] += patch->result.u[k];

  coarse_.restricted(b.u, coarse_right_.u);
  coarse_right_.g = b.g;
  coarse_factor_.solve(coarse_right_, coarse_result_);
  coarse_.add_prolonged(coarse_result_.u, x.u);
  x.g = coarse_result_.g;
}

}  // namespace loopwright
