// VTK XML files for ParaView: a state of the loop model as polygonal data, and a time series of them.
#pragma once
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "loop_scale/loop_model.hpp"

namespace loopwright {

// .vtp: masses as vertices, springs as lines, centrelines as polylines, in mm. Cell data: `kind` (0 mass, 1
// weft, 2 warp, 3 shear, 4 bend, 5 centreline) and `extension` of springs over their rest length; point data:
// `velocity` in mm/s (zero on centrelines). Throws FileError.
void write_vtp(const std::filesystem::path& path, const LoopModel& model, const NetState& state);

// .pvd: the files of a sequence with their times in seconds; names are relative to the .pvd's folder.
void write_pvd(const std::filesystem::path& path, const std::vector<std::pair<double, std::string>>& frames);

}  // namespace loopwright
