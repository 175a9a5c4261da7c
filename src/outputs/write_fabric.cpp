#include "outputs/write_fabric.hpp"

#include <stdexcept>

#include "outputs/write_obj.hpp"

namespace loopwright {

FabricFormat fabric_format(const std::filesystem::path& path) {
  std::string name = path.filename().string();
  for (char& c : name)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  if (name.ends_with(".tubes.obj")) return FabricFormat::obj_tubes;
  if (name.ends_with(".obj")) return FabricFormat::obj_lines;
  if (name.ends_with(".h5") || name.ends_with(".hdf5") || name.ends_with(".loop")) return FabricFormat::state;
  throw std::invalid_argument(
      "cannot tell the format of '" + path.string() +
      "' by its suffix; known are .obj (centrelines), .tubes.obj (tubes), .h5, .hdf5 and .loop "
      "(saved state)");
}

void write_fabric(const std::filesystem::path& path, const State& state) {
  switch (fabric_format(path)) {
    case FabricFormat::obj_lines:
      write_obj_lines(path, state.fabric);
      break;
    case FabricFormat::obj_tubes:
      write_obj_tubes(path, state.fabric);
      break;
    case FabricFormat::state:
      write_state(path, state);
      break;
  }
}

void write_fabric(const std::filesystem::path& path, const Fabric& fabric) {
  write_fabric(path, State{fabric, {}, {}});
}

}  // namespace loopwright
