// VTK XML file for ParaView of a fabric's yarns at one moment.
#pragma once
#include <filesystem>

#include "geometry/fabric.hpp"

namespace loopwright {

// .vtp: centrelines as polylines, in mm. Cell data: `yarn` (its number) and `diameter` in mm, so that a tube
// filter draws them as thick as they are. Throws FileError.
void write_vtp(const std::filesystem::path& path, const Fabric& fabric, int points_per_segment = 4);

}  // namespace loopwright
