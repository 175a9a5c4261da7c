// The second derivative of the stored energy of cloth at rest, over its control points and its measures: what
// stiffness, stability and sensitivities are read off. Friction is left out: it has no energy.
#pragma once
#include "mechanics/relax.hpp"

namespace loopwright {

struct RestHessian {
  YarnModel model;
  YarnState state;
  Unknowns gradient;    // B/d^2
  BlockMatrix hessian;  // B/d^3
};

// All measures are unknowns for a periodic cell, those of `options` for a piece. `pinned`: the first control
// point of a cell moves with the measures only, which takes away the cell's translations and nothing else.
RestHessian rest_hessian(const Fabric& fabric, const ModelOptions& options, bool pinned);

// Rest without friction, sharp enough for derivatives: from `relaxed`, with the measures that `options`
// leaves free, to forces below `tolerance` (B/d^2). Where that ends at a saddle (a cell whose symmetry hides
// a way down) the yarn is moved a little along its lowest mode and brought to rest again, until it is at a
// minimum or five such ways have been gone. Counts are added to those of `relaxed`.
RelaxResult sharp_rest(const RelaxResult& relaxed, const RelaxOptions& options, double tolerance = 1e-8);

// The same from a first geometry, or from a state that has its whole yarn (options.grow_in false). A cell
// grows in at the sizes of the first geometry and is let go then: a frictionless yarn may else slide into a
// poor minimum (docs/mechanics.md).
RelaxResult elastic_rest(const Fabric& first, const RelaxOptions& options, double tolerance = 1e-8);

// A symmetric matrix over (width, height, skew): d(measure forces)/d(measures) with the yarn at
// rest at any measures, G - C' A^-1 C of the bordered Hessian (static condensation), B/d^3. Throws
// std::runtime_error if the yarn is not at a minimum (A not positive definite).
Block condensed_stiffness(const RestHessian& at);

}  // namespace loopwright
