#include "experiments/membrane.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "experiments/deformed.hpp"
#include "experiments/rest_hessian.hpp"
#include "geometry/interlacing.hpp"

namespace loopwright {
namespace {

void require_cell(const Fabric& fabric, const RelaxOptions& options) {
  if (!fabric.periodic)
    throw std::invalid_argument("membrane constants are those of a periodic cell: take --periodic");
  if (!(options.model.material.reference_bend_N_m2 > 0))
    throw std::invalid_argument(
        "forces need the yarn's bend stiffness: name a material or give the yarn its data");
}

// d(measures)/d(strains) at the rest measures: width and skew grow with the course strain.
Eigen::Matrix3d measures_by_strains(const Fabric& rest) {
  Eigen::Matrix3d j = Eigen::Matrix3d::Zero();
  j(0, 0) = rest.width;
  j(1, 1) = rest.height;
  j(2, 0) = rest.skew;
  j(2, 2) = rest.height;
  return j;
}

void check_strains(const std::vector<double>& strains, const char* name) {
  const bool good = std::is_sorted(strains.begin(), strains.end(), std::less_equal<>()) &&
                    std::count(strains.begin(), strains.end(), 0.0) == 1 &&
                    std::all_of(strains.begin(), strains.end(), [](double e) { return e > -0.9 && e <= 5; });
  if (!good)
    throw std::invalid_argument(std::string("the grid's ") + name +
                                " strains must ascend from above -0.9 to at most 5, with 0 among them");
}

// Cloth that is taken from one prescribed strain to the next.
class StrainedCell {
 public:
  StrainedCell(const RelaxResult& rest, const RelaxOptions& options, double largest_step)
      : rest_(rest.fabric), options_(options), largest_step_(largest_step) {
    options_.model.material.friction = 0;
    options_.model.free = {false, false, false};
    options_.grow_in = false;
    options_.history.clear();
    at_.result = relax(rest_, options_);
    stored_at_rest_ = at_.result.energy.stored();
  }

  struct Place {
    std::array<double, 3> strain{};
    RelaxResult result;
  };
  const Place& at() const { return at_; }
  void go_back(const Place& place) { at_ = place; }

  void go(const std::array<double, 3>& strain) {
    double way = 0;
    for (std::size_t k = 0; k < 3; ++k) way = std::max(way, std::abs(strain[k] - at_.strain[k]));
    const int steps = std::max(1, static_cast<int>(std::ceil(way / largest_step_ - 1e-9)));
    const std::array<double, 3> from = at_.strain;
    int passed = 0;
    for (int step = 1; step <= steps && !at_.result.stopped; ++step) {
      for (std::size_t k = 0; k < 3; ++k)
        at_.strain[k] = step == steps ? strain[k] : from[k] + (strain[k] - from[k]) * step / steps;
      const double width = rest_.width * (1 + at_.strain[0]);
      at_.result = relax(deformed(at_.result.fabric, width, rest_.height * (1 + at_.strain[1]),
                                  rest_.skew * (1 + at_.strain[0]) + rest_.height * at_.strain[2]),
                         options_);
      passed += at_.result.pass_throughs;
    }
    at_.result.pass_throughs = passed;
  }

  StretchPoint point() const {
    const RelaxResult& r = at_.result;
    const double bend = options_.model.material.reference_bend_N_m2, d = rest_.diameter_mm * 1e-3;
    const double area = rest_.width * rest_.height;  // d^2
    const Eigen::Vector3d measures(r.measure_forces[0], r.measure_forces[1], r.measure_forces[2]);
    const Eigen::Vector3d force =
        measures_by_strains(rest_).transpose() * measures * (bend / (d * d * d) / area);
    StretchPoint p;
    p.course_strain = at_.strain[0], p.wale_strain = at_.strain[1], p.shear = at_.strain[2];
    p.course_force = force(0), p.wale_force = force(1), p.shear_force = force(2);
    p.energy = (r.energy.stored() - stored_at_rest_) * bend / (d * d * d) / area;
    set_run(p, r);
    p.min_clearance = min_clearance(r.fabric).distance;
    return p;
  }

 private:
  Fabric rest_;
  RelaxOptions options_;
  double largest_step_ = 0, stored_at_rest_ = 0;
  Place at_;
};

// Places in an ascending list in the order 0, up from 0, then down from 0.
std::vector<std::size_t> outward(const std::vector<double>& strains) {
  const auto zero =
      static_cast<std::size_t>(std::find(strains.begin(), strains.end(), 0.0) - strains.begin());
  std::vector<std::size_t> order;
  for (std::size_t k = zero; k < strains.size(); ++k) order.push_back(k);
  for (std::size_t k = zero; k-- > 0;) order.push_back(k);
  return order;
}

}  // namespace

MembraneStiffness membrane_stiffness(const RelaxResult& rest, const RelaxOptions& options) {
  require_cell(rest.fabric, options);
  return membrane_stiffness(rest.fabric, rest_hessian(rest.fabric, options.model, true),
                            options.model.material.reference_bend_N_m2);
}

MembraneStiffness membrane_stiffness(const Fabric& fabric, const RestHessian& at, double bend_N_m2) {
  const Block s = condensed_stiffness(at);
  const Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>> measures(s.data());
  const Eigen::Matrix3d j = measures_by_strains(fabric);
  const double d = fabric.diameter_mm * 1e-3;
  const double unit = bend_N_m2 / (d * d * d) / (fabric.width * fabric.height);  // B/d^3 over the cell's area
  const Eigen::Matrix3d C = unit * j.transpose() * measures * j;

  MembraneStiffness stiffness;
  for (Eigen::Index k = 0; k < 3; ++k)
    for (Eigen::Index l = 0; l < 3; ++l)
      stiffness.C[static_cast<std::size_t>(k)][static_cast<std::size_t>(l)] = C(k, l);
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(C);
  const Eigen::Matrix3d give = C.inverse();  // strain by force
  for (Eigen::Index k = 0; k < 3; ++k)
    stiffness.lowest_first[static_cast<std::size_t>(k)] = solver.eigenvalues()(k);
  stiffness.course_modulus = 1 / give(0, 0);
  stiffness.wale_modulus = 1 / give(1, 1);
  stiffness.shear_modulus = 1 / give(2, 2);
  stiffness.course_poisson = -give(1, 0) / give(0, 0);
  stiffness.wale_poisson = -give(0, 1) / give(1, 1);
  return stiffness;
}

std::vector<StretchPoint> strain_grid(const RelaxResult& rest, const RelaxOptions& options,
                                      const StrainGrid& grid,
                                      const std::function<bool(const StretchPoint&)>& on_point) {
  require_cell(rest.fabric, options);
  check_strains(grid.course, "course");
  check_strains(grid.wale, "wale");
  check_strains(grid.shear, "shear");
  if (!(grid.largest_step > 0)) throw std::invalid_argument("the step must be a positive number");

  const std::size_t wales = grid.wale.size(), courses = grid.course.size();
  std::vector<StretchPoint> points(grid.shear.size() * wales * courses);
  std::vector<std::uint8_t> reached(points.size(), 0);
  StrainedCell cell(rest, options, grid.largest_step);
  using Place = StrainedCell::Place;
  bool stopped = false;
  // One list after the other, outward from 0 and back to where that list's 0 was.
  const auto walk = [&](const std::vector<double>& strains, const auto& at_each) {
    const Place origin = cell.at();
    for (const std::size_t k : outward(strains)) {
      if (stopped) return;
      if (k + 1 < strains.size() && strains[k + 1] == 0) cell.go_back(origin);
      at_each(k);
    }
    cell.go_back(origin);
  };
  walk(grid.shear, [&](std::size_t s) {
    cell.go({0, 0, grid.shear[s]});
    walk(grid.wale, [&](std::size_t w) {
      cell.go({0, grid.wale[w], grid.shear[s]});
      walk(grid.course, [&](std::size_t c) {
        cell.go({grid.course[c], grid.wale[w], grid.shear[s]});
        const std::size_t at = (s * wales + w) * courses + c;
        points[at] = cell.point();
        reached[at] = 1;
        if ((on_point && !on_point(points[at])) || cell.at().result.stopped) stopped = true;
      });
    });
  });
  std::size_t kept = 0;
  for (std::size_t k = 0; k < points.size(); ++k)
    if (reached[k]) points[kept++] = points[k];
  points.resize(kept);
  return points;
}

}  // namespace loopwright
