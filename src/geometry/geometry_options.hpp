// Lengths that the geometry needs, all in d (the reference yarn's diameter), with defaults from a Program.
#pragma once
#include <string>
#include <vector>

#include "notation/program.hpp"

namespace loopwright {

struct GeometryOptions {
  double diameter_mm = 1;      // d, the unit of length
  double loop_length = 17;     // yarn in one knitted loop, from mid sinker to mid sinker
  double tuck_length = 12.75;  // yarn in one tuck loop
  double bed_change = 0;       // extra yarn where the yarn passes from one bed to the other
  double needle_pitch = 4.2;   // yarn that a float needs per needle passed, before slack
  double float_slack = 0;      // share by which a float is longer than the needles it spans
  double wale_pitch = 17 / 4.05;
  double course_pitch = 17 / 5.3;
  // z of the binding points of loops formed on the front bed (rear bed: minus that). The first paper starts
  // rib and purl at twice the thickness of plain, 2.5 r; where front and rear loops lie over each other at
  // the same slot (tubes, interlock, full rib) the sinkers between the beds need room as well. Single-bed
  // pieces lie at 0. In units of shape_radius.
  double two_bed_offset = 2.5;
  double overlap_offset = 3.5;
  std::vector<double> yarn_diameters;     // per carrier, in d
  std::vector<std::string> yarn_colours;  // per carrier, "#rrggbb" or empty
  std::vector<double> yarn_tex;           // per carrier, 0 if unknown
  std::vector<double> yarn_liveliness;    // per carrier, rad/d, as FabricYarn has it

  // The template's yarn radius r: the template's loop takes 34 of them, so that it has the loop length
  // whatever the yarn's thickness is. Equal to 1/2 (true radius) for loop_length = 17.
  double shape_radius() const { return loop_length / 34; }
};

// FabricYarn::liveliness of yarn with these data, for this unit of length.
double liveliness_of(const YarnData& yarn, double diameter_mm);  // rad/d

// Defaults where the programme is silent:
//   loop length  4.2 needle pitches if the gauge is known (7.1 mm at 15 needles per inch, DESIGN section 9),
//                17 diameters if a diameter is known, else 7.1 mm
//   d            the thickest yarn's outer diameter, else its core diameter, else loop length / 17
//   tuck length  0.75 loop lengths;  bed change 0;  float slack 0
//   needle pitch 25.4 mm / gauge, else loop length / 4.05
//   pitches      loop length / 4.05 (wale) and / 5.3 (course): Munden's plain fabric
GeometryOptions make_geometry_options(const Program& program);

}  // namespace loopwright
