#include "mechanics/linear/schwarz.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdlib>
#ifdef __GLIBC__
#include <malloc.h>
#endif

#include "base/parallel.hpp"
#include "mechanics/linear/conjugate_gradient.hpp"
#include "mechanics/piece_size.hpp"

namespace loopwright {
namespace {

constexpr int patch_nodes = 120;  // wanted in a patch, its overlap not counted
constexpr int fresh_iterations =
    5;  // for the fabric's answers to its measures, and when they are known nearly
constexpr int known_iterations = 2;
constexpr double ridge = 1e-7;  // of the plate's diagonal: splines that carry little all but repeat others

constexpr std::size_t nodes_per_chunk = 4096;

std::size_t place(std::int64_t i) { return static_cast<std::size_t>(i); }

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

// Adds the neighbours along the yarn: a quarter of a loop wherever a yarn leaves the patch. (The next one
// alone would make factors smaller by a third and iterations more by the same.) `in` is all zero before and
// after.
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

// Coarse spaces only help on; where theirs is not definite, its diagonal is raised until it is, and conjugate
// gradients find where the matrix bends.
bool factor_raised(BlockMatrix& seen, Cholesky& factor) {
  constexpr int most_raises = 6;
  for (int k = 0; k <= most_raises; ++k) {
    if (factor.factor(seen, 0)) return true;
    for (std::int32_t r = 0; r < seen.rows(); ++r) {
      Block& own = seen.block[seen.place(r, r)];
      for (const std::size_t d : {0, 4, 8}) own[d] += std::ldexp(0.01, 2 * k) * std::abs(own[d]) + 1e-6;
    }
  }
  return false;
}

}  // namespace

void Schwarz::set_patches(const std::vector<Vec3>& places, const std::vector<std::uint8_t>& held,
                          const BlockMatrix& matrix, const CoarseSpace& coarse) {
  const PatchGrid grid(places);
  control_points_ = places.size();
  std::vector<std::vector<std::int32_t>> own(place(grid.nx * grid.ny));
  for (std::size_t i = 0; i < places.size(); ++i)
    own[grid.cell(places[i])].push_back(static_cast<std::int32_t>(i));
  levels_.clear();
  plate_ = plate_space(places, held, grid.nx, grid.ny);
  for (const CoarseSpace* space : {&coarse, static_cast<const CoarseSpace*>(&plate_)}) {
    if (space->points == 0) continue;
    levels_.push_back(std::make_unique<Level>());
    levels_.back()->space = space;
  }
  answers_.clear();

  patches_.clear();
  std::vector<std::uint8_t> in(places.size(), 0);
  for (auto& nodes : own) {
    if (nodes.empty()) continue;
    add_overlap(matrix, in, nodes);
    patches_.push_back(std::make_unique<Patch>());
    patches_.back()->nodes = std::move(nodes);
  }
  number_results();
}

// Where each control point finds its results among those of all patches, patch after patch.
void Schwarz::number_results() {
  std::size_t total = 0;
  result_start_.assign(control_points_ + 1, 0);
  for (const auto& patch : patches_) {
    patch->first_result = total;
    total += patch->nodes.size();
    for (const std::int32_t i : patch->nodes) ++result_start_[place(i) + 1];
  }
  for (std::size_t i = 0; i < control_points_; ++i) result_start_[i + 1] += result_start_[i];
  result_at_.resize(total);
  results_.resize(total);
  std::vector<std::int32_t> fill(result_start_.begin(), result_start_.end() - 1);
  for (const auto& patch : patches_)
    for (std::size_t k = 0; k < patch->nodes.size(); ++k)
      result_at_[place(fill[place(patch->nodes[k])]++)] = static_cast<std::int32_t>(patch->first_result + k);
}

bool Schwarz::factor(const BlockMatrix& matrix, double shift) {
  // Coarse spaces first: the binding points' factor is the largest and needs the most room while it is made.
  for (const auto& patch : patches_) patch->factor.clear(), patch->definite = true;
#ifdef __GLIBC__
  // The heap keeps what thousands of small factors leave behind; the coarse factors are too large for it.
  if (!answers_.empty() && control_points_ > very_many_nodes) malloc_trim(0);
#endif
  coarse_ready_ = true;
  for (const auto& level : levels_) {
    BlockMatrix seen;
    level->space->project(matrix, shift, seen);
    if (level->space->rows.empty())
      for (std::int32_t r = 0; r < seen.rows(); ++r) {
        Block& own = seen.block[seen.place(r, r)];
        for (const std::size_t d : {0, 4, 8}) own[d] *= 1 + ridge;
      }
    coarse_ready_ = factor_raised(seen, level->factor);
    if (!coarse_ready_) break;
    level->factor.compact();
  }
  return factor_patches(matrix, shift, true) && coarse_ready_ && answer_measures(matrix, shift);
}

bool Schwarz::factor_patches(const BlockMatrix& matrix, double shift, bool all) {
  std::atomic<bool> definite{true};
  parallel_chunks(static_cast<int>(patches_.size()), [&](int p) {
    Patch& patch = *patches_[place(p)];
    if (!all && patch.definite) return;
    patch.definite = patch.factor.factor(patch_matrix(matrix, patch.nodes), shift);
    if (!patch.definite) definite = false;
    patch.factor.compact();
  });
  return definite;
}

bool Schwarz::factor_again(const BlockMatrix& matrix, double shift) {
  if (!coarse_ready_) return factor(matrix, shift);
  return factor_patches(matrix, shift, false) && answer_measures(matrix, shift);
}

bool Schwarz::factor_round(const std::vector<std::int32_t>& nodes, const BlockMatrix& matrix, double shift) {
  std::vector<std::uint8_t> in(control_points_, 0);
  for (const std::int32_t i : nodes) in[place(i)] = 1;
  for (const auto& patch : patches_)
    if (std::any_of(patch->nodes.begin(), patch->nodes.end(),
                    [&](std::int32_t i) { return in[place(i)] != 0; }))
      patch->definite = false;
  return factor_again(matrix, shift);
}

std::vector<std::int32_t> Schwarz::indefinite() const {
  std::vector<std::int32_t> nodes;
  for (const auto& patch : patches_)
    if (!patch->definite) nodes.insert(nodes.end(), patch->nodes.begin(), patch->nodes.end());
  return nodes;
}

bool Schwarz::answer_measures(const BlockMatrix& matrix, double shift) {
  answers_.resize(3);
  Unknowns product;
  for (std::size_t k = 0; k < 3; ++k) {
    Unknowns& answer = answers_[k];
    // Not known yet, also where an earlier matrix bent before it came to this one.
    const bool known = answer.u.size() == control_points_;
    if (!known) answer.u.assign(control_points_, Vec3{});
    answer.g = {};
    answer.g[k] = 1;
    multiply(matrix, shift, answer, product);  // what is not yet at rest when the measure changes by one
    product.g = {};
    if (!(dot(product, product) > 0)) continue;
    Unknowns change;
    const ConjugateGradientResult solved = conjugate_gradient(
        matrix, shift, [this](const Unknowns& r, Unknowns& z) { solve_points(r, z); }, product, 1e-3,
        {.most = known ? known_iterations : fresh_iterations}, change);
    iterations += solved.iterations;
    if (solved.indefinite) return false;
    for (std::size_t i = 0; i < control_points_; ++i) answer.u[i] -= change.u[i];
  }
  Block seen;
  for (std::size_t l = 0; l < 3; ++l) {
    multiply(matrix, shift, answers_[l], product);
    for (std::size_t k = 0; k < 3; ++k) seen[3 * k + l] = dot(answers_[k], product);
  }
  return invert3(seen, measures_inverse_);
}

void Schwarz::solve_points(const Unknowns& b, Unknowns& x) {
  // The coarse spaces first: each takes as long as many patches, which go on beside it.
  const int coarse = static_cast<int>(levels_.size());
  parallel_chunks(coarse + static_cast<int>(patches_.size()), [&](int task) {
    if (task < coarse) {
      Level& level = *levels_[place(task)];
      level.space->restricted(b.u, level.right.u);
      level.factor.solve(level.right, level.result);
      return;
    }
    Patch& patch = *patches_[place(task - coarse)];
    Unknowns right, result;
    right.u.resize(patch.nodes.size());
    for (std::size_t k = 0; k < patch.nodes.size(); ++k) right.u[k] = b.u[place(patch.nodes[k])];
    patch.factor.solve(right, result);
    for (std::size_t k = 0; k < patch.nodes.size(); ++k)
      results_[patch.first_result + k] = {static_cast<float>(result.u[k].x),
                                          static_cast<float>(result.u[k].y),
                                          static_cast<float>(result.u[k].z)};
  });
  x.g = {};
  x.u.resize(control_points_);
  const int chunks = static_cast<int>((control_points_ + nodes_per_chunk - 1) / nodes_per_chunk);
  parallel_chunks(chunks, [&](int c) {
    const std::size_t begin = place(c) * nodes_per_chunk;
    for (std::size_t i = begin; i < std::min(control_points_, begin + nodes_per_chunk); ++i) {
      Vec3 sum;
      for (auto at = place(result_start_[i]); at < place(result_start_[i + 1]); ++at) {
        const auto& part = results_[place(result_at_[at])];
        sum += Vec3{part[0], part[1], part[2]};
      }
      x.u[i] = sum;
    }
  });
  for (const auto& level : levels_) level->space->add_prolonged(level->result.u, x.u);
}

void Schwarz::solve(const Unknowns& b, Unknowns& x) {
  solve_points(b, x);
  Measures force{};
  for (std::size_t k = 0; k < 3; ++k) force[k] = dot(answers_[k], b);
  for (std::size_t k = 0; k < 3; ++k) {
    double change = 0;
    for (std::size_t l = 0; l < 3; ++l) change += measures_inverse_[3 * k + l] * force[l];
    axpy(change, answers_[k], x);
  }
}

}  // namespace loopwright
