// One call for all files of a fabric: the suffix of the name says which format is meant.
#pragma once
#include <filesystem>
#include <string>

#include "outputs/state.hpp"

namespace loopwright {

enum class FabricFormat { obj_lines, obj_tubes, state };

// .tubes.obj: tubes; .obj: centrelines; .h5, .hdf5 and .loop: saved state. Letters may be upper or lower
// case. Throws std::invalid_argument that lists the known suffixes.
FabricFormat fabric_format(const std::filesystem::path& path);

// Writes with each format's default options. `state`: a plain Fabric goes in as State{fabric, {}, {}}.
void write_fabric(const std::filesystem::path& path, const State& state);
void write_fabric(const std::filesystem::path& path, const Fabric& fabric);

}  // namespace loopwright
