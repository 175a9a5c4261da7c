#include "experiments/membrane_law.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace loopwright {
namespace {

// alpha times the largest strain: at 1 the law has its pole, near 0 g is its first term and alpha free.
constexpr double least_reach = 0.05, most_reach = 0.999;

double locking(double x) { return x > 0 ? 1 / ((1 - x) * (1 - x)) - 1 - 2 * x : 0; }

FitError error_of(const Eigen::VectorXd& difference, const Eigen::VectorXd& force) {
  FitError error;
  error.rms = std::sqrt(difference.squaredNorm() / static_cast<double>(force.size()));
  const double size = std::sqrt(force.squaredNorm() / static_cast<double>(force.size()));
  error.share = size > 0 ? error.rms / size : 0;
  error.worst = difference.lpNorm<Eigen::Infinity>();
  return error;
}

// Where a function is least in a range: a scan, then golden sections round its best place.
template <typename Function>
double best_place(const Function& f, double lowest, double highest, int scans) {
  const double step = (highest - lowest) / scans;
  double best = lowest, value = f(best);
  for (int k = 1; k <= scans; ++k) {
    const double here = f(lowest + k * step);
    if (here < value) value = here, best = lowest + k * step;
  }
  constexpr double golden = 0.6180339887498949;
  double low = std::max(lowest, best - step), high = std::min(highest, best + step);
  for (int k = 0; k < 60; ++k) {
    const double a = high - golden * (high - low), b = low + golden * (high - low);
    if (f(a) < f(b))
      high = b;
    else
      low = a;
  }
  return (low + high) / 2;
}

template <typename Function>
double best_reach(const Function& f) {
  return best_place(f, least_reach, most_reach, 200);
}

// A linear least squares problem whose constants from `first_positive` on must not be below 0: those that
// would be are left out.
Eigen::VectorXd solved(const Eigen::MatrixXd& columns, const Eigen::VectorXd& force,
                       Eigen::Index first_positive) {
  std::vector<Eigen::Index> used;
  for (Eigen::Index k = 0; k < columns.cols(); ++k) used.push_back(k);
  for (;;) {
    const Eigen::VectorXd some = columns(Eigen::all, used).colPivHouseholderQr().solve(force);
    const auto negative = std::find_if(used.begin(), used.end(), [&](const Eigen::Index& k) {
      return k >= first_positive && some(&k - used.data()) < 0;
    });
    if (negative != used.end()) {
      used.erase(negative);
      continue;
    }
    Eigen::VectorXd all = Eigen::VectorXd::Zero(columns.cols());
    for (std::size_t k = 0; k < used.size(); ++k) all(used[k]) = some(static_cast<Eigen::Index>(k));
    return all;
  }
}

Eigen::VectorXd locking_column(const Eigen::VectorXd& strain, double reach) {
  const double largest = std::max(strain.maxCoeff(), 1e-12);
  return strain.unaryExpr([&](double e) { return locking(reach * e / largest); });
}

void require_finite(const Eigen::VectorXd& values) {
  if (!values.allFinite()) throw std::invalid_argument("a strain or force to fit is not a finite number");
}

// Strains and forces of a grid's points. Forces: along the courses, then along the wales.
struct Grid {
  Eigen::Index count = 0;
  Eigen::VectorXd ec, ew, es, force, shear;

  explicit Grid(std::span<const StretchPoint> points)
      : count(static_cast<Eigen::Index>(points.size())),
        ec(count),
        ew(count),
        es(count),
        force(2 * count),
        shear(count) {
    if (count < 8) throw std::invalid_argument("a membrane law needs at least eight points of a grid");
    for (Eigen::Index k = 0; k < count; ++k) {
      const StretchPoint& p = points[static_cast<std::size_t>(k)];
      ec(k) = p.course_strain, ew(k) = p.wale_strain, es(k) = p.shear;
      force(k) = p.course_force, force(count + k) = p.wale_force, shear(k) = p.shear_force;
    }
    for (const Eigen::VectorXd* values : {&ec, &ew, &es, &force, &shear}) require_finite(*values);
  }
  // What Cxx, Cyy and Cxy are multiplied by, and room for more.
  Eigen::MatrixXd linear_columns(Eigen::Index all) const {
    Eigen::MatrixXd columns = Eigen::MatrixXd::Zero(2 * count, all);
    columns.col(0).head(count) = ec;
    columns.col(1).tail(count) = ew;
    columns.col(2).head(count) = ew;
    columns.col(2).tail(count) = ec;
    return columns;
  }
};

}  // namespace

double PullLaw::operator()(double strain) const { return Y * strain + beta * locking(alpha * strain); }

PullLaw fit_pull(std::span<const double> strain, std::span<const double> force) {
  if (strain.size() != force.size() || strain.size() < 4)
    throw std::invalid_argument(
        "a law of three constants needs at least four points, each a strain and a force");
  const auto count = static_cast<Eigen::Index>(strain.size());
  const Eigen::VectorXd e = Eigen::Map<const Eigen::VectorXd>(strain.data(), count),
                        f = Eigen::Map<const Eigen::VectorXd>(force.data(), count);
  require_finite(e);
  require_finite(f);
  if (e.minCoeff() < -1e-12 || !(e.maxCoeff() > 0))
    throw std::invalid_argument("the law of a pull is for strains above zero");
  Eigen::MatrixXd columns(count, 2);
  columns.col(0) = e;
  const auto constants = [&](double reach) {
    columns.col(1) = locking_column(e, reach);
    return solved(columns, f, 0);
  };
  const double reach = best_reach([&](double r) {
    const Eigen::VectorXd x = constants(r);
    return (columns * x - f).norm();
  });
  const Eigen::VectorXd x = constants(reach);
  return {x(0), x(1), reach / e.maxCoeff(), error_of(columns * x - f, f)};
}

MembraneLaw fit_membrane(std::span<const StretchPoint> points) {
  const Grid grid(points);
  const auto& [count, ec, ew, es, force, shear] = grid;
  // Constants in the order Cxx, Cyy, Cxy, beta_x, beta_y.
  Eigen::MatrixXd columns = grid.linear_columns(5);
  double reach_x = 0.5, reach_y = 0.5;
  const auto constants = [&](double x, double y) {
    columns.col(3).head(count) = locking_column(ec, x);
    columns.col(4).tail(count) = locking_column(ew, y);
    return solved(columns, force, 3);
  };
  const auto miss = [&](double x, double y) {
    const Eigen::VectorXd c = constants(x, y);
    return (columns * c - force).norm();
  };
  // The two alphas in turn: each has a say in its own direction only, but for the common coupling.
  for (int turn = 0; turn < 4; ++turn) {
    reach_x = best_reach([&](double r) { return miss(r, reach_y); });
    reach_y = best_reach([&](double r) { return miss(reach_x, r); });
  }
  const Eigen::VectorXd c = constants(reach_x, reach_y);
  const Eigen::VectorXd difference = columns * c - force;

  MembraneLaw law;
  law.Cxx = c(0), law.Cyy = c(1), law.Cxy = c(2), law.beta_x = c(3), law.beta_y = c(4);
  if (ec.maxCoeff() > 0) law.alpha_x = reach_x / ec.maxCoeff();
  if (ew.maxCoeff() > 0) law.alpha_y = reach_y / ew.maxCoeff();
  law.G = es.squaredNorm() > 0 ? es.dot(shear) / es.squaredNorm() : 0;
  law.course = error_of(difference.head(count), force.head(count));
  law.wale = error_of(difference.tail(count), force.tail(count));
  law.shear = error_of(law.G * es - shear, shear);
  return law;
}

SharedLockingLaw fit_shared_locking(std::span<const StretchPoint> points) {
  const Grid grid(points);
  const auto& [count, ec, ew, es, force, shear] = grid;
  Eigen::MatrixXd columns = grid.linear_columns(4);
  const auto constants = [&](double r, double reach) {
    const Eigen::VectorXd locks = locking_column(ec + r * ew, reach);
    columns.col(3).head(count) = locks;
    columns.col(3).tail(count) = r * locks;
    return solved(columns, force, 3);
  };
  const auto miss = [&](double r, double reach) {
    const Eigen::VectorXd c = constants(r, reach);
    return (columns * c - force).norm();
  };
  const auto reach_of = [&](double r) {
    return best_place([&](double reach) { return miss(r, reach); }, least_reach, most_reach, 40);
  };
  const double r =
      std::exp(best_place([&](double log_r) { return miss(std::exp(log_r), reach_of(std::exp(log_r))); },
                          std::log(0.05), std::log(20.0), 40));
  const double reach = reach_of(r);
  const Eigen::VectorXd c = constants(r, reach);
  const Eigen::VectorXd difference = columns * c - force;
  SharedLockingLaw law{c(0), c(1), c(2), c(3), 0, r, {}, {}};
  law.alpha = reach / std::max((ec + r * ew).maxCoeff(), 1e-12);
  law.course = error_of(difference.head(count), force.head(count));
  law.wale = error_of(difference.tail(count), force.tail(count));
  return law;
}

}  // namespace loopwright
