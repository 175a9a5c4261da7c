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

// Two ways for a yarn to grow. The whole shell first: its outer diameter is there from the start, at least as
// stiff as a hundred B/d^5, and the core grows. Thin yarn first: soft yarn in loops too short for a shell as
// stiff grows as yarn of usual hardness that is as thick as its own law is hard; then the soft law comes.
enum class Growth { whole_shell, thin_yarn };
// Whether growing thin is another way at all: the law is softer than the shell of growing yarn.
bool may_grow_thin(const ContactLaw& law);

// `state` is where the fabric is drawn, and is moved by `run`; `full` is the model of the grown yarn.
GrownIn grow_in(const Fabric& fabric, const ModelOptions& options, const YarnModel& full, YarnState& state,
                Growth growth, const GrowingRun& run);

}  // namespace loopwright
