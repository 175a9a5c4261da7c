// A periodic cell as a membrane, all of it in one call: brought to rest without friction, its stiffness
// there, pulled both ways with the law of each pull, and strained over a grid. docs/homogenise.md.
#pragma once
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "experiments/curl.hpp"
#include "experiments/membrane.hpp"
#include "experiments/membrane_law.hpp"
#include "experiments/sensitivity.hpp"
#include "piece.hpp"

namespace loopwright {

struct HomogeniseRequest {
  StrainGrid grid{{-0.05, 0, 0.05, 0.1, 0.15, 0.2}, {-0.1, -0.05, 0, 0.05, 0.1}, {-0.1, 0, 0.1}, 0.02};
  bool with_grid = true;
  double course_pull = 0.3, wale_pull = 0.15;  // strains to which the cell is pulled
};

// Strains of a grid in any order, with 0 among them.
std::vector<double> with_zero(std::vector<double> strains);

// One way, free across.
struct Pull {
  std::vector<double> strain, force, across;  // 1, N/m, 1
  PullLaw law;
  bool whole = true, stopped = false;
};

struct Homogenised {
  MembraneStiffness stiffness;
  Pull course, wale;
  std::vector<StretchPoint> points;  // of the grid, in its order; fewer where it was stopped
  std::optional<CurlMoment> curl;    // N; nothing where the yarns do not close along their courses
  // Over the grid, where it has eight points: each direction with a locking of its own, and one for both.
  std::optional<MembraneLaw> law;
  std::optional<SharedLockingLaw> shared_law;
  bool stopped = false, whole = true;  // whole: no interlacing was lost under strain
};

// What is said while it lasts: "relaxing", "pulling" or "straining", and how much of that is done. False
// stops it.
using HomogeniseProgress = std::function<bool(const char* what, double share, const std::string& note)>;

// `piece`: of elastic_piece(). Throws as elastic_rest() does.
RelaxResult elastic_rest_of(const Piece& piece, const HomogeniseProgress& on_progress = {});

// `rest`: what elastic_rest_of() gave for the piece. Throws as membrane_stiffness(), stretch(),
// strain_grid().
Homogenised homogenise(const RelaxResult& rest, const Piece& piece, const HomogeniseRequest& request,
                       const HomogeniseProgress& on_progress = {});

// Keys with their units, as docs/homogenise.md lists them, to be put behind those of results().
JsonObject results(const Homogenised& homogenised);

// By the names of the quantities, per cent of change by one per cent more.
JsonObject results(const std::vector<Sensitivity>& sensitivities);

// "loop-length" and so on. Throws std::invalid_argument that lists the names.
YarnQuantity yarn_quantity_named(std::string_view name);

}  // namespace loopwright
