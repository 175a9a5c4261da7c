// Cloth that lies there already as the start of the next relaxation: after a change of the yarn's data or of
// loop lengths the loops are the same, and the way to the new rest is short.
#pragma once
#include <memory>
#include <optional>

#include "pipeline.hpp"

namespace loopwright {

struct ClothAtHand {
  std::shared_ptr<const Knitting> knitting;
  std::shared_ptr<const RelaxResult> relaxed;  // at rest and whole
  std::shared_ptr<const RelaxOptions> options;
};

// Whether both are the same loops in the same order, drawn through each other and layered alike; where they
// are written does not count.
bool same_topology(const YarnGraph& a, const YarnGraph& b);

// `first` with the yarn where the cloth at hand has it, and `options` made ready: plates where they stood,
// and yarn grown in only where it became too thick for its place or its length changed much. Nothing where
// the loops are others, or where an interlacing would not be whole.
std::optional<Fabric> start_from_cloth_at_hand(const ClothAtHand& hand, const Knitting& knitting,
                                               const Fabric& first, RelaxOptions& options);

}  // namespace loopwright
