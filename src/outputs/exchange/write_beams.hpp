// Yarns as beams for finite element programs: Abaqus and CalculiX.
#pragma once
#include <filesystem>

#include "outputs/export_options.hpp"
#include "outputs/state.hpp"

namespace loopwright {

enum class BeamDialect { abaqus, calculix };

// The model without a step, to be included by the file that loads it. Units: mm, N, t (MPa, t/mm^3).
//   elements   B31, or B32 with options.quadratic_beams and for CalculiX; ELSET YARN_0, YARN_1, ... and YARNS
//   sections   circular, one material a yarn. E is such that the beam bends like the yarn, E pi r^4/4 = B; so
//              it stretches more easily than the yarn, which a comment says in figures
//   node sets  EDGE_LEFT, EDGE_RIGHT, EDGE_BOTTOM, EDGE_TOP; YARN_ENDS; HELD
//   surfaces   (Abaqus) SURFACE_YARN_0, ...: of beam elements, for contact
// The cell of a periodic fabric is cut at its faces: the edges are then the cut nodes, the k-th of one edge
// and of the opposite one the same yarn. Nodes CELL_X and CELL_Y carry the change of the lattice vectors;
// equations tie opposite cuts to them. A finite piece's edges are bands half a wale or course wide. Throws
// FileError.
void write_beams(const std::filesystem::path& path, const State& state, BeamDialect dialect,
                 const ExportOptions& options = {});

}  // namespace loopwright
