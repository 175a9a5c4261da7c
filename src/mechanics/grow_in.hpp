// Growing yarn in: from a first geometry, in which yarns are closer than their diameter in places, to yarn
// whose hard core is whole and whose lengths are its own.
#pragma once
#include <functional>

#include "mechanics/yarn_model.hpp"

namespace loopwright {

enum class GrownIn {
  yes,
  stopped,   // by `run`
  touching,  // yarns touch in the first geometry
  jammed     // the hard core does not fit
};

// One run of Newton's method with yarn that is still growing: `share` of its full radius, at most so many
// iterations. False: there are no more iterations, or it was stopped.
using GrowingRun =
    std::function<bool(const YarnModel& model, double share, double tolerance, int iterations)>;

// Usual yarn grows with its whole shell: the outer diameter is there from the start and the core grows. A
// soft shell (less than a hundred B/d^5) would let yarns be pressed together until nothing tells them apart,
// and made as stiff as that it may not fit into its loops: soft yarn grows as thin yarn of that hardness, as
// thick as its own law is hard; then its own law comes.
//
// `state` is where the fabric is drawn, and is moved by `run`; `full` is the model of the grown yarn.
GrownIn grow_in(const Fabric& fabric, const ModelOptions& options, const YarnModel& full, YarnState& state,
                const GrowingRun& run);

}  // namespace loopwright
