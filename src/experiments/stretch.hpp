// Stretch test of a periodic cell or of a held piece: its width, its height, both or its shear are prescribed
// step by step, or the forces on them are; the cloth comes to rest at each, and sizes and the forces that the
// frame carries are read off.
#pragma once
#include <functional>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "mechanics/relax.hpp"

namespace loopwright {

enum class StretchDirection { course, wale, both, shear };
enum class StretchControl { strain, load };
// "course", "wale", "both", "shear"; nothing for anything else.
std::optional<StretchDirection> stretch_direction_named(std::string_view name);

struct StretchTest {
  StretchDirection direction = StretchDirection::course;  // course: the width grows, wale: the height
  StretchControl control = StretchControl::strain;
  // Where to go, in order; each is reached in steps of at most `largest_step`, and every step is a point of
  // the result. Strains: shares of the size at the start (shear: skew over height). Loads: forces per length
  // of the relaxed cloth, N/m, that stay as they are while the cloth yields to them.
  std::vector<double> turning_points;
  double largest_step = 0.02;
  bool free_across = true;  // course and wale: the other size follows, so that its force is zero
};

struct StretchPoint {
  double course_strain = 0, wale_strain = 0, shear = 0;
  // Membrane force in the frame's directions per length of the relaxed cloth, N/m (first Piola-Kirchhoff): on
  // a width of cloth for wale_force and shear_force, on a height for course_force.
  double course_force = 0, wale_force = 0, shear_force = 0;
  double energy = 0;  // stored in the cloth per area of the relaxed cloth, J/m^2
  double residual = 0;
  int newton_iterations = 0, pass_throughs = 0, interlacings_intact = 0, interlacings = 0;
  double min_clearance = 0;  // d
  bool converged = false;
};

// What the run to a point came to: its residual, counts and interlacings.
void set_run(StretchPoint& point, const RelaxResult& run);

struct StretchResult {
  std::vector<StretchPoint> points;  // the first: the cloth at rest before the test
  Fabric fabric;                     // as it is at the last point
  bool stopped = false;
};

// How many points the test has, the one at rest included.
std::size_t point_count(const StretchTest& test);
// The step of a test under loads, if none is stated: a twentieth of the largest.
double usual_load_step(std::span<const double> loads);

// `relaxed`: at rest with `options`, with the history of friction there, which is kept through the test, so
// that loading and unloading differ. `on_point` is called after every point; false stops the test. Throws
// std::invalid_argument if the material does not say its reference_bend_N_m2 (forces have no unit then), and
// for strains that cannot be (not finite, -0.9 or less, above 5), loads that are not finite, no turning
// point.
StretchResult stretch(const RelaxResult& relaxed, const RelaxOptions& options, const StretchTest& test,
                      const std::function<bool(const StretchPoint&)>& on_point = {});

}  // namespace loopwright
