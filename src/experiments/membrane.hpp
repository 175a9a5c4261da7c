// What a periodic cell is as a membrane: its stiffness at rest, and the forces over a grid of strains.
//
// Strains are those of the lattice: course, width over its rest - 1; wale, height over its rest - 1; shear,
// the skew that is added over the height. Forces are energies per area of the relaxed cloth by strain (first
// Piola-Kirchhoff), N/m.
#pragma once
#include <array>
#include <functional>
#include <vector>

#include "experiments/rest_hessian.hpp"
#include "experiments/stretch.hpp"

namespace loopwright {

// d(force)/d(strain) at rest over (course, wale, shear), N/m; symmetric.
struct MembraneStiffness {
  std::array<std::array<double, 3>, 3> C{};
  std::array<double, 3> lowest_first{};  // eigenvalues of C; below zero: the cloth changes size by itself

  // Pulled along the courses, free to narrow and shear: force over strain, and by how much of that strain the
  // height falls. Along the wales likewise. From the inverse of C.
  double course_modulus = 0, wale_modulus = 0, shear_modulus = 0;  // N/m
  double course_poisson = 0, wale_poisson = 0;
};

// Exact at the cell's rest: the Hessian of the stored energy with the yarn's motion condensed out (no strain
// is applied). `rest`: of sharp_rest(). Throws std::invalid_argument for a fabric that is not periodic or a
// material without reference_bend_N_m2, std::runtime_error as condensed_stiffness().
MembraneStiffness membrane_stiffness(const RelaxResult& rest, const RelaxOptions& options);

// The same from a Hessian over all three measures, the cell pinned; B of the reference yarn.
MembraneStiffness membrane_stiffness(const Fabric& fabric, const RestHessian& at, double bend_N_m2);

struct StrainGrid {
  // Strains, ascending, each list with 0 among them; every combination is a point.
  std::vector<double> course{0}, wale{0}, shear{0};
  double largest_step = 0.02;
};

// Every combination, shear outermost, course innermost. Without friction, so that the way does not matter:
// each point is reached from its neighbour nearer to rest, in steps of at most largest_step. `on_point` false
// stops; what was reached is returned. Throws std::invalid_argument as stretch(), and for lists that are not
// such.
std::vector<StretchPoint> strain_grid(const RelaxResult& rest, const RelaxOptions& options,
                                      const StrainGrid& grid,
                                      const std::function<bool(const StretchPoint&)>& on_point = {});

}  // namespace loopwright
