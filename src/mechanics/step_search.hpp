// One step of Newton's method: solved for, made safe, and cut until it lowers the energy. In a large piece a
// step that yarn somewhere would hold back is solved for again, with a larger shift there (local_shift.hpp).
#pragma once
#include "mechanics/linear/step_solver.hpp"
#include "mechanics/local_shift.hpp"
#include "mechanics/safe_step.hpp"

namespace loopwright {

// Where a step is looked for. `range`: as far as the assembly has pairs.
struct StepPlace {
  const YarnState& state;
  const Unknowns& gradient;
  double energy = 0, residual = 0, range = 0;
};

// The step as it may be taken: its safe part, cut further by `scale`. scale 0: none lowers the energy.
struct TakenStep {
  YarnState state;
  SafeStep safe;
  double scale = 0, energy = 0;
  double slope = 0;  // dE along the whole step
  int raised = 0;    // how often the shift had to be raised everywhere
};

class StepSearch {
 public:
  StepSearch(const YarnModel& model, Assembly& assembly)
      : model_(model), assembly_(assembly), solver_(model), local_(model) {}

  // False if no step could be solved for. The Hessian gets its metric and, in a very large piece, is given
  // back. `shift` is raised where that is needed to make it positive definite.
  bool take(const StepPlace& at, BlockMatrix& hessian, double& shift, TakenStep& taken);

  const StepSolver& solver() const { return solver_; }
  bool is_large() const;  // so that costly steps count

 private:
  bool counts_memory() const;
  bool shifts_locally() const { return is_large() && !model_.periodic; }
  // What it finds to lower the energy is taken whole.
  bool solve(const StepPlace& at, BlockMatrix& hessian, double& shift, TakenStep& taken);
  bool lowers(const StepPlace& at, const TakenStep& taken, double scale, double energy) const;
  bool raise_where_energy_rises(const StepPlace& at, const TakenStep& taken, double shift);

  const YarnModel& model_;
  Assembly& assembly_;
  StepSolver solver_;
  LocalShift local_;
  Unknowns step_;
  std::vector<double> of_segments_here_, of_segments_there_;  // energies, of the state and of the step's end
};

}  // namespace loopwright
