#include "mechanics/linear/conjugate_gradient.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace loopwright {
namespace {

// Whether the residual falls too slowly: `squares`, one for every iteration, to come down to `wanted`. The
// pace is that of the later half; before that there is nothing to go by.
bool too_slow(const std::vector<double>& squares, double wanted, int patience) {
  constexpr std::size_t least = 8;
  if (patience < 0 || squares.size() < least) return false;
  const std::size_t half = squares.size() / 2;
  const double pace =
      std::log(squares[squares.size() - 1 - half] / squares.back()) / static_cast<double>(half);
  return !(std::log(squares.back() / wanted) <= patience * pace);
}

// The control points that make p' A p negative, from the worst on, until nine tenths of what is negative are
// there.
std::vector<std::int32_t> most_negative(const Unknowns& p, const Unknowns& Ap) {
  std::vector<std::pair<double, std::int32_t>> parts;
  double sum = 0;
  for (std::size_t i = 0; i < p.u.size(); ++i)
    if (const double part = dot(p.u[i], Ap.u[i]); part < 0) {
      parts.emplace_back(part, static_cast<std::int32_t>(i));
      sum += part;
    }
  std::sort(parts.begin(), parts.end());
  std::vector<std::int32_t> nodes;
  double taken = 0;
  for (const auto& [part, node] : parts) {
    if (taken < 0.9 * sum) break;
    nodes.push_back(node);
    taken += part;
  }
  return nodes;
}

}  // namespace

ConjugateGradientResult conjugate_gradient(const BlockMatrix& matrix, double shift,
                                           const Preconditioner& preconditioner, const Unknowns& b,
                                           double tolerance, const ConjugateGradientLimits& limits,
                                           Unknowns& x) {
  ConjugateGradientResult result;
  Unknowns r = b, z, p, Ap;
  preconditioner(r, z);
  double rz = dot(r, z);
  const double wanted = tolerance * tolerance * rz;
  if (limits.go_on) {
    multiply(matrix, shift, x, Ap);
    axpy(-1, Ap, r);
    preconditioner(r, z);
    rz = dot(r, z);
  } else {
    x.u.assign(b.u.size(), Vec3{});
    x.g = {};
  }
  p = z;
  const double start = rz;
  std::vector<double> squares;
  while (rz > wanted && result.iterations < limits.most && !too_slow(squares, wanted, limits.patience)) {
    multiply(matrix, shift, p, Ap);
    ++result.iterations;
    const double curvature = dot(p, Ap);
    if (!(curvature > 0)) {
      result.indefinite = true;
      result.bent = most_negative(p, Ap);
      break;
    }
    const double a = rz / curvature;
    axpy(a, p, x);
    axpy(-a, Ap, r);
    preconditioner(r, z);
    const double next = dot(r, z), beta = next / rz;
    rz = next;
    squares.push_back(rz);
    for (std::size_t i = 0; i < p.u.size(); ++i) p.u[i] = z.u[i] + beta * p.u[i];
    for (std::size_t k = 0; k < 3; ++k) p.g[k] = z.g[k] + beta * p.g[k];
  }
  if (start > 0) result.reduction = std::sqrt(std::max(0.0, rz / start));
  result.converged = !result.indefinite && !(rz > wanted);
  return result;
}

}  // namespace loopwright
