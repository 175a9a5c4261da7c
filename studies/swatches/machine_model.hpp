// What is assumed of the machine and the yarn of KnitDB's swatches (15-gauge flat-bed machine, Tamm Petit
// 2/30 acrylic, one stitch cam for all). Set from the yarn's count and from two swatches alone,
// 2_1_004Stockinette and 3_3_009k1p1rib; docs/swatches.md says how.
#pragma once
#include "notation/program.hpp"

namespace loopwright {

struct MachineModel {
  double gauge_npi = 15;
  // Yarn in a loop: what the stitch cam draws, and what it takes to go from one bed to the other (half of it
  // at either end of a loop). A loop that is moved has no more yarn than others, a loop on an empty needle no
  // less.
  double loop_length_mm = 6.53, bed_change_mm = 1.33;
  double take_down_N = 0.02;  // of a wale
  // Laid flat: room for the centrelines of jersey (one layer of stitches, and a diameter for yarn that
  // crosses it) and of cloth whose stitches show both faces.
  double one_layer_mm = 1.0, two_layers_mm = 1.60;
  double hand_pull_N_m = 10;  // cloth is pulled straight both ways before it is laid: 100 g on a width of 10 cm
  // Yarn. Its hairs touch at `diameter_mm`; pressed together it is as thick as `core_diameter_mm`, fibres packed
  // to 0.8; in between it is pressed as acrylic yarn is (Singal et al., Nature Communications 15, 2622 (2024)):
  // shell_kW_N_mm2 / p (y^-p - 1), y the share of the shell that is left.
  double diameter_mm = 0.80, core_diameter_mm = 0.31, shell_kW_N_mm2 = 4.98e-4, shell_exponent = 2.4;
  double bend_stiffness_mN_mm2 = 12.7, friction = 0.25, linear_density_tex = 73.0;
  double set = 0.5;  // of the curvature that it has on the needles: what bent acrylic yarn loses in time
  // Of the stretched swatches, 608 g: once along the courses, borne by all of them, which gives the width, and
  // once along the wales, borne by all of these, which gives the height.
  double stretch_load_N = 5.96;
};

// The programme with the machine's gauge and loops, and with this yarn on every carrier.
inline void apply(const MachineModel& machine, Program& program) {
  program.settings.gauge_npi = machine.gauge_npi;
  program.settings.loop_length_mm = machine.loop_length_mm;
  program.settings.bed_change_mm = machine.bed_change_mm;
  program.settings.set = machine.set;
  for (YarnData& yarn : program.yarns) {
    yarn = {};
    yarn.material = "Tamm Petit 2/30";
    yarn.diameter_mm = machine.diameter_mm;
    yarn.core_diameter_mm = machine.core_diameter_mm;
    yarn.shell_stiffness = machine.shell_kW_N_mm2 / (machine.diameter_mm - machine.core_diameter_mm);
    yarn.shell_exponent = machine.shell_exponent;
    yarn.bend_stiffness_mN_mm2 = machine.bend_stiffness_mN_mm2;
    yarn.friction_coefficient = machine.friction;
    yarn.linear_density_tex = machine.linear_density_tex;
  }
}

}  // namespace loopwright
