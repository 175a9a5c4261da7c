// VTK XML file for ParaView of a fabric's yarns at one moment.
#pragma once
#include <filesystem>

#include "outputs/export_options.hpp"
#include "outputs/state.hpp"

namespace loopwright {

// .vtp: a polyline a yarn (a yarn and cell of a periodic fabric), in mm. Point data: `arc_mm`,
// `curvature_per_mm`; `loop` and what is known of it (loop_columns) where the fabric has loops; tension and
// contact force where the state has them (told_forces). Cell data: `yarn`, `carrier`, `diameter` in mm, so
// that a tube filter draws yarns as thick as they are. Binary (appended, raw). Throws FileError.
void write_vtp(const std::filesystem::path& path, const State& state, const ExportOptions& options = {});

}  // namespace loopwright
