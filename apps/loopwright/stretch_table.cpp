#include "stretch_table.hpp"

namespace loopwright {

Table table_of(const std::vector<StretchPoint>& points) {
  Table table;
  table.columns = {
      "course_strain",       "wale_strain",  "shear",         "course_force_N_m",  "wale_force_N_m",
      "shear_force_N_m",     "energy_J_m2",  "residual",      "newton_iterations", "pass_throughs",
      "interlacings_intact", "interlacings", "min_clearance", "converged"};
  for (const StretchPoint& p : points)
    table.rows.push_back({p.course_strain, p.wale_strain, p.shear, p.course_force, p.wale_force,
                          p.shear_force, p.energy, p.residual, static_cast<double>(p.newton_iterations),
                          static_cast<double>(p.pass_throughs), static_cast<double>(p.interlacings_intact),
                          static_cast<double>(p.interlacings), p.min_clearance, p.converged ? 1.0 : 0.0});
  return table;
}

}  // namespace loopwright
