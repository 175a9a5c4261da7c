// One call for all files of a fabric: the suffix of the name, or the name of a format, says which is meant.
#pragma once
#include <filesystem>
#include <span>
#include <string>
#include <string_view>

#include "outputs/export_options.hpp"
#include "outputs/state.hpp"

namespace loopwright {

enum class FabricFormat {
  obj_lines,
  obj_tubes,
  ply,
  glb,
  gltf,
  vtp,
  bcc,
  bcc_bspline,
  yarns,
  step,
  step_tubes,
  abaqus,
  calculix,
  points_csv,
  state
};

struct FormatEntry {
  FabricFormat format;
  std::string_view name;      // as --format takes it
  std::string_view suffixes;  // that mean it, parted by blanks; empty: only by name
  std::string_view what;      // a line for people
};

// All of them, in the order in which they are told.
std::span<const FormatEntry> fabric_formats();

// What the name's suffix means; letters may be upper or lower case. Throws std::invalid_argument that lists
// the known suffixes.
FabricFormat fabric_format(const std::filesystem::path& path);
// The format of that name. Throws std::invalid_argument that lists the names.
FabricFormat format_named(std::string_view name);

// `state`: a plain Fabric goes in as State{fabric, {}, {}}. Throws FileError; std::invalid_argument where a
// format cannot hold the fabric, and for repeats that are not from 1 to 1000 or of a fabric that is no cell.
void write_fabric(const std::filesystem::path& path, const State& state, FabricFormat format,
                  const ExportOptions& options = {});
// In the format that the name's suffix means.
void write_fabric(const std::filesystem::path& path, const State& state);
void write_fabric(const std::filesystem::path& path, const Fabric& fabric);

}  // namespace loopwright
