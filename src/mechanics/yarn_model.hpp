// YarnModel: what never changes while a fabric moves (stiffnesses, rest lengths, index lists);
// YarnState: what moves (control points and lattice). Lengths in d, energies in B/d of the reference yarn.
#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "geometry/fabric.hpp"
#include "mechanics/energies/contact.hpp"
#include "mechanics/laws/contact_law.hpp"
#include "mechanics/linear/coarse_space.hpp"
#include "mechanics/measures.hpp"

namespace loopwright {

// Which of the fabric's outer measures are unknowns. Periodic cells: the lattice; held pieces: the stretch of
// the frame.
struct FreeMeasures {
  bool width = true, height = true, skew = false;
};

// Two plates that keep a piece flat (energies/plates.hpp); stiffness 0: none. Places of centrelines, in d.
struct FlatPlates {
  double stiffness = 0, low = 0, high = 0;
};

// Yarn data in the model's units: lengths in d, stiffness B = 1.
struct YarnMaterial {
  double stretch_stiffness = 3000;  // EA d^2 / B
  double bend_stiffness = 1;        // B of this yarn over B of the reference yarn
  ContactLaw contact;               // outer diameter 1 for the reference yarn
  double friction = 0;              // coefficient of yarn on yarn; 0: frictionless
  // B of the reference yarn in N m^2, by which the model's forces become newtons; 0: not known.
  double reference_bend_N_m2 = 0;
  double twist_stiffness = 0;  // C / B; 0: turns about itself without resistance
};

// The model's unit of force, B/d^2, in N; 0 if B is not known.
inline double force_unit_N(const YarnMaterial& material, double diameter_mm) {
  return material.reference_bend_N_m2 / (diameter_mm * diameter_mm * 1e-6);
}

struct YarnModel {
  struct Yarn {
    int first_node = 0, nodes = 0;  // control points
    int first_segment = 0, segments = 0;
    int first_extended = 0;  // see `base`
    bool periodic = false;
    std::array<int, 2> shift{0, 0};
    double rest_length = 1;  // of a segment
    double diameter = 1;
    double stretch_stiffness = 3000, bend_stiffness = 1, twist_stiffness = 0;
    double liveliness = 0;      // rad/d, as in FabricYarn
    int segments_per_loop = 0;  // about; 0: it has no loops
  };
  std::vector<Yarn> yarns;
  int nodes = 0, segments = 0, extended = 0;

  // Extended control points: per yarn its control points and, if periodic, the first three again, shifted. So
  // the four control points of any segment lie at extended places first[e] .. first[e] + 3.
  std::vector<std::int32_t> base;                 // [extended] control point
  std::vector<std::array<std::int8_t, 2>> image;  // [extended] lattice shift
  std::vector<std::int32_t> first;                // [segment] first extended control point
  std::vector<std::int32_t> yarn_of_segment;      // [segment]
  std::vector<std::uint8_t> held;                 // [node]
  // [segment] length at which it is not stretched, in d: the yarn's rest length, except while yarn grows in.
  std::vector<double> natural_length;
  // [segment] curvature of set yarn when unloaded, 1/d, at the Gauss points; empty: all yarn is straight.
  std::vector<std::array<double, 4>> natural_curvature;
  // [node] constant force on a control point, B/d^2 (dead: it keeps its direction); empty: none. A force f at
  // a place of a segment is f times the spline weights there, on its four control points. Minus f times the
  // place counts in EnergyParts::load.
  std::vector<Vec3> point_loads;

  const Yarn& yarn_of(int segment) const {
    return yarns[static_cast<std::size_t>(yarn_of_segment[static_cast<std::size_t>(segment)])];
  }

  // Which binding points carry which control points: the solver's coarse space.
  CoarseSpace binding_points;

  ContactLaw contact;
  double friction = 0;
  int samples = 8;          // contact samples per segment
  SampleWeights weights{};  // spline weights of the samples
  double excluded =
      1.9634954084936207;  // same-yarn pairs closer than this (1.25 pi/2 d) along the yarn do not touch
  bool periodic = false;
  FreeMeasures free;
  FlatPlates plates;
  Measures load{};  // dE/d(width, height, skew) that the cloth is to bear, B/d^2; counts where these are free
};

struct YarnState {
  std::vector<Vec3> nodes;  // [node] control points
  double width = 0, height = 0, skew = 0;

  Vec3 lattice(int m, int n) const { return {m * width + n * skew, n * height, 0}; }
};

struct ModelOptions {
  YarnMaterial material;
  double sample_spacing = 0.12;   // wanted distance of contact samples along a yarn, in d
  std::vector<Vec3> point_loads;  // as in YarnModel: none, or one for every control point of every yarn
  FreeMeasures free;
  FlatPlates plates;
  Measures load{};  // as in YarnModel
};

// Throws std::invalid_argument on non-finite input or data out of range, saying which and what is allowed.
YarnModel build_yarn_model(const Fabric& fabric, const ModelOptions& options);
YarnState build_yarn_state(const Fabric& fabric);
// The fabric with the state's places.
Fabric with_state(const Fabric& fabric, const YarnState& state);

}  // namespace loopwright
