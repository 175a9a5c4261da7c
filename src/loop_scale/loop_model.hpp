// The first paper's whole model of a piece: binding points of a yarn graph as masses, weft and warp springs,
// loads, and the curves that follow the masses. Plain, 1 x 1 rib and 1 x 1 purl come out as in figures 6 to
// 9; any other graph is treated by the same rules.
//
//   weft spring  from the lower binding point of a loop to that of the next in its course (figure 6)
//   warp spring  from the lower to the upper binding point of a loop
//   start        the paper's structure model before deformation: wales 8 r, courses 7 r apart (r = l / 34),
//                front loops at z = +2.5 r, rear loops at -2.5 r if there are both
//   rest length  that of the stable state (spring_constants.hpp), never that of the start
#pragma once
#include <optional>
#include <string_view>
#include <vector>

#include "loop_scale/correlation.hpp"
#include "loop_scale/mass_spring_net.hpp"
#include "loop_scale/spring_constants.hpp"

namespace loopwright {

// Where something pulls or holds: a border of the piece, its last corner at the top right, the top of the
// middle wale, the right end of the middle course.
enum class PiecePlace : std::uint8_t { top, bottom, left, right, corner, wale, course };
std::optional<PiecePlace> place_named(std::string_view name);
Vec3 outward(PiecePlace place);  // direction of a pull there, unit vector

struct Pull {
  PiecePlace place = PiecePlace::top;
  double force_cN = 1;  // in all, shared by the masses there
  Vec3 direction;       // zero: outward
  TimeCourse factor;    // over seconds
};

struct LoopModelOptions {
  SpringLaw law = SpringLaw::along;
  // What the paper leaves out, each off unless asked for:
  bool coupling = false;  // the yarn of a loop serves its width and height: Poisson's ratio
  double shear = 0;       // diagonal springs, as a share of the stiffness of the weft spring beside them
  // Springs between second neighbours, as a share of the softer of the two springs that they span. `fold`:
  // over odd connections, whose fold nothing else keeps; at 1/4 a rib is as stiff to its width as was
  // measured. `bend`: over even ones, which lets a tube open.
  double fold = 0, bend = 0;
  // Springs from a float's ends to the held loops that it passes, as a share of the float's own: wales that
  // are knitted in different courses (interlock) hold each other in no other way.
  double passing = 0;
  double damping = 1;  // over settling_damping
  std::vector<PiecePlace> clamps;
  std::vector<Pull> pulls;
  bool gravity = false;  // along -y, 9.81 m/s^2
};

struct LoopModel {
  GeometryOptions geometry;  // of the start
  LoopYarn yarn;
  BindingPoints points;
  MassSpringNet net;
  std::vector<Vec3> start;  // by binding point, in d
  YarnCurves curves;        // at the start
  CorrelationMap map;
  std::vector<StitchSide> side;     // by loop
  std::vector<std::int8_t> wall{};  // by binding point: 1 and -1 in the front and rear wall of a tube, else 0
};

// Throws std::invalid_argument for a graph without loops and for options out of range.
LoopModel build_loop_model(const YarnGraph& graph, const Program& program,
                           const LoopModelOptions& options = {});

// The lengths of the paper's structure model for a program's yarn.
GeometryOptions paper_start(const Program& program);

// Masses at a place of a piece.
std::vector<std::int32_t> masses_at(const YarnGraph& graph, const BindingPoints& points,
                                    const std::vector<Vec3>& start, PiecePlace place);

// Curves whose type value points follow the masses.
YarnCurves curves_at(const LoopModel& model, const NetState& state);

// The traditional net of figure 5 over a rectangle of masses: structural springs between neighbours, shear
// springs on the diagonals, bending springs between second neighbours. Stiffness of each kind; at rest as
// placed, `wide` and `high` apart.
struct TraditionalStiffness {
  double structural = 1, shear = 1, bending = 1;
};
MassSpringNet traditional_net(int wales, int courses, double wide, double high, double mass,
                              const TraditionalStiffness& stiffness);
// Row by row from the bottom left, in the plane z = 0.
std::vector<Vec3> grid_places(int wales, int courses, double wide, double high);

}  // namespace loopwright
