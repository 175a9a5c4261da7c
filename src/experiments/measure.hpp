// What a textile laboratory would say about a piece or cell: sizes, densities, yarn and mass.
#pragma once
#include <optional>
#include <vector>

#include "geometry/fabric.hpp"

namespace loopwright {

struct YarnMeasurement {
  YarnId yarn;                   // in the graph; pieces of one yarn, as a window cuts them, count together
  double length_m = 0;           // unloaded, in the loops that are measured: without tails and frame
  std::optional<double> mass_g;  // absent: its linear density is unknown
};

// Lengths in mm. A periodic fabric is measured over one cell, whose wales and courses tile the plane. A
// finite piece has a width between its outermost loops plus one wale, and a height between them plus one
// course, so that a spacing is in both cases width / wales or height / courses.
struct Measurements {
  int loops = 0, yarns = 0;
  double wales = 0, courses = 0;
  double width_mm = 0, height_mm = 0;
  double thickness_mm = 0;  // from the lowest to the highest point of the yarns' surfaces along z
  double wale_spacing_mm = 0, course_spacing_mm = 0;
  double wales_per_cm = 0, courses_per_cm = 0;
  double loop_length_mm = 0;  // mean arc length of the spans of knitted loops; NaN without any
  // Munden's constants (Journal of the Textile Institute 50, T448, 1959): loop length over course spacing,
  // over wale spacing, and their product.
  double Kc = 0, Kw = 0, Ks = 0;
  // By which wales lean to the right as one looks at the front (spirality): of the mean way from the head of
  // a loop to the heads of those drawn through it; NaN without any.
  double wale_lean_degrees = 0;
  double cover_factor = 0;            // share of the area that is covered by yarn, seen along z
  std::vector<YarnMeasurement> yarn;  // in the order of their first pieces
  double yarn_m = 0;                  // of all yarns, likewise
  std::optional<double> mass_g, areal_density_g_m2;  // absent: a linear density is unknown
  std::optional<double> tightness_factor;            // sqrt(tex) / loop length in cm; absent as above
};

// A fabric without loops (curves that another program made): whole yarns are measured, width and height are
// the fabric's own, and what belongs to wales, courses and loops is NaN or absent.
// Throws std::invalid_argument if the fabric has no yarn or a point that is not finite.
Measurements measure(const Fabric& fabric);

}  // namespace loopwright
