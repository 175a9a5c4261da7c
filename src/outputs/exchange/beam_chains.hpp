// Yarns as chains of nodes for beam elements. The yarns of a periodic cell are cut where they leave the cell
// and what leaves on one side comes in on the other, so that the chains lie in the cell and their ends on its
// faces.
#pragma once
#include <vector>

#include "outputs/export_options.hpp"

namespace loopwright {

struct BeamChain {
  std::size_t yarn = 0;
  std::vector<Vec3> places;  // in d; at equal steps of the parameter
  bool closed = false;       // the last element ends at the first node
};

enum class CellFace { left, right, bottom, top };

// A node on a face of the periodic cell.
struct FaceNode {
  CellFace face = CellFace::left;
  std::size_t chain = 0, node = 0;
};

struct BeamChains {
  std::vector<BeamChain> chains;
  // Two by two: what leaves through one face and where it comes in through the opposite one.
  std::vector<std::array<FaceNode, 2>> cuts;
};

// options.per_segment steps on a spline segment, or as many as divide what lies between two cuts evenly; even
// numbers of them for quadratic beams.
BeamChains beam_chains(const Fabric& fabric, const ExportOptions& options);

}  // namespace loopwright
