#include "experiments/modes.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "mechanics/energies/energy.hpp"
#include "mechanics/linear/cholesky.hpp"

namespace loopwright {
namespace {

using Vectors = std::vector<Unknowns>;

constexpr int block_size = 4;  // finds eigenvalues that occur twice, as those of a straight yarn do

// M as the Hessian's metric: rest length times int h_a h_b du; nothing for held points.
void set_mass(RestHessian& at) {
  const YarnModel& model = at.model;
  at.hessian.metric.assign(at.hessian.column.size(), 0);
  for (int e = 0; e < model.segments; ++e) {
    const auto first = static_cast<std::size_t>(model.first[static_cast<std::size_t>(e)]);
    for (std::size_t k = 0; k < 4; ++k)
      for (std::size_t l = 0; l < 4; ++l) {
        const std::int32_t i = model.base[first + k], j = model.base[first + l];
        if (model.held[static_cast<std::size_t>(i)] || model.held[static_cast<std::size_t>(j)]) continue;
        double mass = 0;
        for (std::size_t g = 0; g < 4; ++g)
          mass += gauss_weight[g] * gauss_spline[g].value[k] * gauss_spline[g].value[l];
        at.hessian.metric[at.hessian.place(i, j)] += mass * model.yarn_of(e).rest_length;
      }
  }
}

Unknowns mass_times(const BlockMatrix& h, const Unknowns& x) {
  Unknowns y;
  y.u.resize(x.u.size());
  for (std::size_t i = 0; i < y.u.size(); ++i)
    for (auto k = static_cast<std::size_t>(h.row_start[i]); k < static_cast<std::size_t>(h.row_start[i + 1]);
         ++k)
      if (h.metric[k] != 0) y.u[i] += h.metric[k] * x.u[static_cast<std::size_t>(h.column[k])];
  return y;
}

// A basis that is orthonormal in M. Each vector is kept with M times itself.
struct Basis {
  const BlockMatrix& h;
  Vectors v, mass_v;

  void project_out(Unknowns& x) const {
    for (int pass = 0; pass < 2; ++pass)  // twice is enough (Kahan)
      for (std::size_t k = 0; k < v.size(); ++k) axpy(-dot(mass_v[k], x), v[k], x);
  }
  // False if x lies in the span already.
  bool add(Unknowns x) {
    const double before = std::sqrt(dot(x, mass_times(h, x)));
    project_out(x);
    Unknowns mass_x = mass_times(h, x);
    const double length = std::sqrt(std::max(0.0, dot(x, mass_x)));
    if (!(length > 1e-10 * before)) return false;
    for (Vec3& u : x.u) u = u / length;
    for (Vec3& u : mass_x.u) u = u / length;
    v.push_back(std::move(x));
    mass_v.push_back(std::move(mass_x));
    return true;
  }
};

// Motions that cost nothing: translations of what is not held, rotations of what is not periodic either.
// Plates leave those along them; loads fix directions.
void add_rigid_motions(const RestHessian& at, Basis& basis) {
  const YarnModel& model = at.model;
  if (std::any_of(model.held.begin(), model.held.end(), [](std::uint8_t held) { return held != 0; })) return;
  const bool plates = model.plates.stiffness > 0;
  const auto add = [&](const auto& motion) {
    Unknowns x;
    for (const Vec3& p : at.state.nodes) x.u.push_back(motion(p));
    basis.add(std::move(x));
  };
  add([](const Vec3&) { return Vec3{1, 0, 0}; });
  add([](const Vec3&) { return Vec3{0, 1, 0}; });
  if (!plates) add([](const Vec3&) { return Vec3{0, 0, 1}; });
  if (model.periodic || !model.point_loads.empty()) return;
  add([](const Vec3& p) { return Vec3{-p.y, p.x, 0}; });
  if (plates) return;
  add([](const Vec3& p) { return Vec3{0, -p.z, p.y}; });
  add([](const Vec3& p) { return Vec3{p.z, 0, -p.x}; });
}

// A direction that is the same on every machine and has a share of every mode.
Unknowns scattered(std::size_t nodes, const std::vector<std::uint8_t>& held, int seed) {
  Unknowns x;
  x.u.resize(nodes);
  std::uint64_t s = 0x9e3779b97f4a7c15ULL * static_cast<std::uint64_t>(seed + 1);
  for (std::size_t i = 0; i < nodes; ++i)
    for (int d = 0; d < 3; ++d) {
      s = s * 6364136223846793005ULL + 1442695040888963407ULL;
      x.u[i][d] = held[i] ? 0 : static_cast<double>(s >> 11) * 0x1p-53 - 0.5;
    }
  return x;
}

// Share of the motion that runs along the yarn.
double share_along(const RestHessian& at, const std::vector<Vec3>& shape) {
  std::vector<Vec3> place;
  expand(at.model, at.state, place);
  double along = 0, all = 0;
  for (int e = 0; e < at.model.segments; ++e) {
    const auto first = static_cast<std::size_t>(at.model.first[static_cast<std::size_t>(e)]);
    for (std::size_t g = 0; g < 4; ++g) {
      Vec3 u, t;
      for (std::size_t k = 0; k < 4; ++k) {
        u += gauss_spline[g].value[k] * shape[static_cast<std::size_t>(at.model.base[first + k])];
        t += gauss_spline[g].slope[k] * place[first + k];
      }
      const double weight = gauss_weight[g] * at.model.yarn_of(e).rest_length;
      const double s = dot(u, normalized(t));
      along += weight * s * s;
      all += weight * squared_norm(u);
    }
  }
  return along / all;
}

// Factors H + s M with an s that makes it positive definite: small, or little more than must be, so that the
// inverse tells the lowest modes apart from the next.
double factor_shifted(const BlockMatrix& h, Cholesky& factor) {
  double good = 1e-7, bad = 0;
  for (; !factor.factor(h, good); bad = good, good *= 10)
    if (good > 1e12)
      throw std::runtime_error("the Hessian has no lowest eigenvalue: are all control points finite?");
  for (int k = 0; k < 5 && bad > 0; ++k) {
    const double middle = std::sqrt(good * bad);
    (factor.factor(h, middle) ? good : bad) = middle;
  }
  if (bad > 0) factor.factor(h, good);
  return good;
}

}  // namespace

std::vector<Mode> lowest_modes(const Fabric& fabric, const ModelOptions& options, const ModeOptions& wish) {
  if (wish.wanted < 1) throw std::invalid_argument("at least one mode must be wanted");
  RestHessian at = rest_hessian(fabric, options, false);
  BlockMatrix& h = at.hessian;
  h.border.assign(h.border.size(), Block{});  // sizes stay
  h.corner = {1, 0, 0, 0, 1, 0, 0, 0, 1};
  set_mass(at);
  Cholesky factor;
  const double shift = factor_shifted(h, factor);

  const auto nodes = static_cast<std::size_t>(at.model.nodes);
  Basis basis{h, {}, {}};
  add_rigid_motions(at, basis);
  const std::size_t rigid = basis.v.size();
  Vectors image;  // (H + s M)^-1 M of every vector after the rigid ones
  std::size_t block_begin = rigid;
  for (int k = 0; k < block_size; ++k) basis.add(scattered(nodes, at.model.held, k));

  Eigen::MatrixXd ritz;
  for (;;) {
    const std::size_t block_end = basis.v.size();
    for (std::size_t k = block_begin; k < block_end; ++k) {
      Unknowns x;
      factor.solve(basis.mass_v[k], x);
      image.push_back(std::move(x));
    }
    const auto size = static_cast<Eigen::Index>(image.size());
    Eigen::MatrixXd t(size, size);
    t.topLeftCorner(ritz.rows(), ritz.cols()) = ritz;
    for (Eigen::Index i = 0; i < size; ++i)
      for (Eigen::Index j = std::max(i, ritz.rows()); j < size; ++j)
        t(i, j) = t(j, i) =
            dot(basis.mass_v[rigid + static_cast<std::size_t>(i)], image[static_cast<std::size_t>(j)]);
    ritz = t;
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(t);

    // Lowest modes are the largest eigenvalues of the inverse.
    const auto wanted = static_cast<Eigen::Index>(wish.wanted);
    std::vector<Mode> modes;
    double worst = 0;
    for (Eigen::Index m = 0; m < std::min(wanted, size); ++m) {
      const double theta = solver.eigenvalues()(size - 1 - m);
      Unknowns x, rest;
      x.u.resize(nodes);
      rest.u.resize(nodes);
      for (Eigen::Index k = 0; k < size; ++k) {
        const double share = solver.eigenvectors()(k, size - 1 - m);
        axpy(share, basis.v[rigid + static_cast<std::size_t>(k)], x);
        axpy(share, image[static_cast<std::size_t>(k)], rest);
      }
      axpy(-theta, x, rest);
      basis.project_out(rest);
      worst = std::max(worst, std::sqrt(std::max(0.0, dot(rest, mass_times(h, rest)))) / theta);
      modes.push_back({1 / theta - shift, share_along(at, x.u), std::move(x.u)});
    }
    const bool good = size >= wanted && worst < wish.tolerance;

    const std::size_t last_block = block_begin - rigid;
    block_begin = basis.v.size();
    if (!good && size < wish.most_vectors)
      for (std::size_t k = last_block; k < image.size(); ++k) basis.add(image[k]);
    const bool whole = basis.v.size() == block_begin;  // nothing new: the subspace holds all there is
    if (good || (whole && size >= wanted && size < wish.most_vectors)) return modes;
    if (whole && size < wish.most_vectors)
      throw std::invalid_argument("the cloth has fewer modes than are wanted");
    if (whole) throw std::runtime_error("the lowest modes were not found in the largest subspace allowed");
  }
}

Stability stability(const Fabric& fabric, const ModelOptions& options, int modes_wanted) {
  Stability result;
  result.modes = lowest_modes(fabric, options, {.wanted = modes_wanted, .tolerance = 1e-5});
  result.stable = result.modes.front().lambda > 0;
  if (!fabric.periodic || !result.stable) return result;
  const Block s = condensed_stiffness(rest_hessian(fabric, options, true));
  const Eigen::Map<const Eigen::Matrix3d> sizes(s.data());
  const Eigen::Vector3d values = Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(sizes).eigenvalues();
  result.sizes = {values(0), values(1), values(2)};
  result.stable = values(0) > 0;
  return result;
}

}  // namespace loopwright
