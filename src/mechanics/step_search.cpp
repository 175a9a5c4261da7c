#include "mechanics/step_search.hpp"

#include <algorithm>
#include <cmath>

#include "mechanics/piece_size.hpp"

namespace loopwright {
namespace {

constexpr double gap_share = 0.7;         // of the gap of two pieces of yarn that one step may use up
constexpr double enough_decrease = 1e-4;  // Armijo's constant
constexpr int most_cuts = 40;
// A large piece's step that would be cut to less than this by some yarn is solved for again, so often.
constexpr double enough_scale = 0.5;
constexpr int most_again = 3;

}  // namespace

bool StepSearch::is_large() const { return model_.nodes > many_nodes; }
bool StepSearch::counts_memory() const { return model_.nodes > very_many_nodes; }

bool StepSearch::lowers(const StepPlace& at, const TakenStep& taken, double scale, double energy) const {
  return energy <= at.energy + enough_decrease * scale * taken.slope + 1e-13 * std::abs(at.energy);
}

bool StepSearch::raise_where_energy_rises(const StepPlace& at, const TakenStep& taken, double shift) {
  if (of_segments_here_.empty()) assembly_.energy(at.state, of_segments_here_);
  return local_.raise(of_segments_here_, of_segments_there_, -taken.safe.scale * taken.slope, shift);
}

bool StepSearch::solve(const StepPlace& at, BlockMatrix& hessian, double& shift, TakenStep& taken) {
  const bool local = shifts_locally();
  const double accuracy = std::clamp(0.3 * at.residual, 1e-3, 0.05);
  const auto weigh = [&](double at_shift) { assembly_.metric(hessian, local_.weights(at_shift)); };
  StepSolver::RaiseAt raise_at;
  if (local)
    raise_at = [&](const std::vector<std::int32_t>& nodes, double at_shift) {
      local_.raise(nodes, at_shift);
      weigh(at_shift);
    };
  if (counts_memory()) assembly_.drop_places();
  weigh(shift);
  hessian.measure_metric = {1, 1, 1};
  for (int again = 0;; ++again) {
    const StepSolver::Report report =
        solver_.solve(hessian, at.state, at.gradient, accuracy, shift, step_, raise_at, local_.take_raised());
    if (!report.solved) return false;
    taken.raised += report.raised;
    taken.slope = dot(at.gradient, step_);
    taken.safe = safe_step(model_, assembly_, at.state, assembly_.moved(at.state, step_, 1), at.range,
                           model_.contact.outer, gap_share, local);
    if (!local || again == most_again) return true;
    if (taken.safe.scale < enough_scale) {
      local_.raise(taken.safe, shift, gap_share);
    } else {
      taken.state = assembly_.moved(at.state, step_, taken.safe.scale);
      taken.energy = assembly_.energy(taken.state, of_segments_there_).total();
      if (lowers(at, taken, taken.safe.scale, taken.energy)) {
        taken.scale = taken.safe.scale;
        return true;
      }
      if (!raise_where_energy_rises(at, taken, shift)) return true;
    }
    weigh(shift);
  }
}

bool StepSearch::take(const StepPlace& at, BlockMatrix& hessian, double& shift, TakenStep& taken) {
  taken = {};
  of_segments_here_.clear();
  if (!solve(at, hessian, shift, taken)) return false;
  if (counts_memory()) hessian = BlockMatrix{};  // much of what is held, and not needed until the next step
  local_.fade();
  double scale = taken.safe.scale;
  for (int cuts = 0; taken.scale == 0 && cuts < most_cuts; ++cuts, scale *= 0.5) {
    taken.state = assembly_.moved(at.state, step_, scale);
    taken.energy = assembly_.energy(taken.state).total();
    if (lowers(at, taken, scale, taken.energy)) taken.scale = scale;
  }
  return true;
}

}  // namespace loopwright
