#include "loop_scale/metric_start.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <queue>
#include <utility>

namespace loopwright {
namespace {

constexpr Eigen::Index most_pivots = 80;

struct Neighbour {
  std::size_t mass;
  double length;
};
using Neighbours = std::vector<std::vector<Neighbour>>;

Neighbours neighbours_of(const MassSpringNet& net) {
  Neighbours neighbours(net.mass.size());
  for (const Spring& spring : net.springs) {
    const std::size_t a = static_cast<std::size_t>(spring.a), b = static_cast<std::size_t>(spring.b);
    neighbours[a].push_back({b, norm(spring.rest)});
    neighbours[b].push_back({a, norm(spring.rest)});
  }
  return neighbours;
}

std::vector<double> distances_from(const Neighbours& neighbours, std::size_t pivot) {
  std::vector<double> distances(neighbours.size(), std::numeric_limits<double>::infinity());
  using Reached = std::pair<double, std::size_t>;
  std::priority_queue<Reached, std::vector<Reached>, std::greater<>> open;
  distances[pivot] = 0;
  open.push({0, pivot});
  while (!open.empty()) {
    const auto [far, mass] = open.top();
    open.pop();
    if (far > distances[mass]) continue;
    for (const Neighbour& next : neighbours[mass]) {
      if (far + next.length >= distances[next.mass]) continue;
      distances[next.mass] = far + next.length;
      open.push({far + next.length, next.mass});
    }
  }
  return distances;
}

// Ways along springs are longer than straight lines: the median spring gets its length.
void fit_scale(const MassSpringNet& net, std::vector<Vec3>& places) {
  std::vector<double> ratios;
  for (const Spring& spring : net.springs) {
    const double now =
        distance(places[static_cast<std::size_t>(spring.a)], places[static_cast<std::size_t>(spring.b)]);
    if (now > 0) ratios.push_back(norm(spring.rest) / now);
  }
  if (ratios.empty()) return;
  const auto middle = ratios.begin() + static_cast<std::ptrdiff_t>(ratios.size() / 2);
  std::nth_element(ratios.begin(), middle, ratios.end());
  for (Vec3& place : places) place *= *middle;
}

}  // namespace

std::vector<Vec3> metric_start(const MassSpringNet& net) {
  const Eigen::Index n = static_cast<Eigen::Index>(net.mass.size());
  const Eigen::Index pivots = std::min(n, most_pivots);
  if (n < 4) return {};
  const Neighbours neighbours = neighbours_of(net);
  // every pivot as far as can be from those before it
  Eigen::MatrixXd squares(n, pivots);
  std::vector<double> nearest(net.mass.size(), std::numeric_limits<double>::infinity());
  std::size_t pivot = 0;
  for (Eigen::Index k = 0; k < pivots; ++k) {
    const std::vector<double> distances = distances_from(neighbours, pivot);
    for (std::size_t i = 0; i < distances.size(); ++i) {
      if (!std::isfinite(distances[i])) return {};
      squares(static_cast<Eigen::Index>(i), k) = distances[i] * distances[i];
      nearest[i] = std::min(nearest[i], distances[i]);
    }
    pivot = static_cast<std::size_t>(std::max_element(nearest.begin(), nearest.end()) - nearest.begin());
  }
  const Eigen::VectorXd row_means = squares.rowwise().mean();
  const Eigen::RowVectorXd column_means = squares.colwise().mean();
  Eigen::MatrixXd centred = squares;
  centred.colwise() -= row_means;
  centred.rowwise() -= column_means;
  centred.array() += squares.mean();
  centred *= -0.5;
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(centred.transpose() * centred);
  std::vector<Vec3> places(net.mass.size());
  for (int axis = 0; axis < 3; ++axis) {
    const Eigen::Index which = pivots - 1 - axis;
    const double singular = std::sqrt(std::max(0.0, solver.eigenvalues()[which]));
    if (!(singular > 0)) {
      if (axis < 2) return {};
      break;
    }
    const double stretch =
        std::sqrt(singular * std::sqrt(static_cast<double>(n) / static_cast<double>(pivots))) / singular;
    const Eigen::VectorXd column = centred * solver.eigenvectors().col(which) * stretch;
    for (std::size_t i = 0; i < places.size(); ++i) places[i][axis] = column[static_cast<Eigen::Index>(i)];
  }
  fit_scale(net, places);
  return places;
}

}  // namespace loopwright
