// glTF 2.0: yarns as tubes, each a mesh with its own material. For Blender, web viewers, game engines.
#pragma once
#include <filesystem>

#include "outputs/export_options.hpp"

namespace loopwright {

// Lengths in metres, as glTF has them; y up, z toward the viewer, as the cloth lies. A node a yarn (a yarn
// and cell of a periodic fabric; cells share their mesh), a material a yarn of that name and colour.
// Vertices: POSITION, NORMAL, TEXCOORD_0 (yarn_skin's u and v), and the application's own _LOOP (number in
// the fabric, -1: none) and _LINE (of the source, 0: none). `extras` of a mesh: yarn, carrier, diameter,
// linear density, rest length; of the asset: unit, reference diameter, lattice. Throws FileError;
// std::invalid_argument for options that make no tube and for what is larger than the 4 GiB of a .glb.
void write_glb(const std::filesystem::path& path, const Fabric& fabric, const ExportOptions& options = {});

// The same as text, with the numbers as base64 inside. A third larger, and built in memory: for small things.
void write_gltf(const std::filesystem::path& path, const Fabric& fabric, const ExportOptions& options = {});

}  // namespace loopwright
