#include "outputs/write_fabric.hpp"

#include <array>
#include <stdexcept>

#include "outputs/exchange/write_beams.hpp"
#include "outputs/exchange/write_curves.hpp"
#include "outputs/exchange/write_gltf.hpp"
#include "outputs/exchange/write_ply.hpp"
#include "outputs/exchange/write_points_csv.hpp"
#include "outputs/exchange/write_step.hpp"
#include "outputs/exchange/write_step_tubes.hpp"
#include "outputs/exchange/write_vtp.hpp"
#include "outputs/write_obj.hpp"

namespace loopwright {
namespace {

// A longer suffix stands before one that it ends in.
constexpr std::array<FormatEntry, 15> entries{{
    {FabricFormat::obj_tubes, "obj-tubes", ".tubes.obj", "Wavefront OBJ, tubes"},
    {FabricFormat::obj_lines, "obj", ".obj", "Wavefront OBJ, centrelines"},
    {FabricFormat::ply, "ply", ".ply", "PLY, tubes with colours and source lines"},
    {FabricFormat::glb, "glb", ".glb", "glTF 2.0 in one file, tubes"},
    {FabricFormat::gltf, "gltf", ".gltf", "glTF 2.0 as text, tubes"},
    {FabricFormat::vtp, "vtp", ".vtp", "VTK XML for ParaView, centrelines with data"},
    {FabricFormat::bcc, "bcc", ".bcc", "BCC, Catmull-Rom curves"},
    {FabricFormat::bcc_bspline, "bcc-bspline", "", "BCC, the yarns' own control points"},
    {FabricFormat::yarns, "yarns", ".yarns", "yarns of the .smobj tools"},
    {FabricFormat::step, "step", ".step .stp", "STEP AP214, exact B-spline curves"},
    {FabricFormat::step_tubes, "step-tubes", ".tubes.step .tubes.stp", "STEP AP214, yarns as solids"},
    {FabricFormat::abaqus, "abaqus", ".inp", "Abaqus beam model"},
    {FabricFormat::calculix, "calculix", ".ccx.inp", "CalculiX beam model"},
    {FabricFormat::points_csv, "csv", ".csv", "a line a point"},
    {FabricFormat::state, "state", ".h5 .hdf5 .loop", "saved state"},
}};

std::string lower_case(std::string text) {
  for (char& c : text)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  return text;
}

// Calls visit for each of the suffixes of an entry.
template <class Visit>
void each_suffix(const FormatEntry& entry, Visit visit) {
  for (std::string_view rest = entry.suffixes; !rest.empty();) {
    const std::size_t end = std::min(rest.find(' '), rest.size());
    visit(rest.substr(0, end));
    rest.remove_prefix(std::min(end + 1, rest.size()));
  }
}

void check_repeats(const Fabric& fabric, const std::array<int, 2>& repeats) {
  constexpr int most = 1000;
  for (const int count : repeats)
    if (count < 1 || count > most)
      throw std::invalid_argument("repeats are COLUMNSxROWS, each from 1 to 1000, not " +
                                  std::to_string(repeats[0]) + 'x' + std::to_string(repeats[1]));
  if (repeats != std::array<int, 2>{1, 1} && !fabric.periodic)
    throw std::invalid_argument("repeats are for a periodic cell, and this is a piece");
}

}  // namespace

std::span<const FormatEntry> fabric_formats() { return entries; }

FabricFormat fabric_format(const std::filesystem::path& path) {
  const std::string name = lower_case(path.filename().string());
  const FormatEntry* best = nullptr;
  std::size_t longest = 0;
  std::string known;
  for (const FormatEntry& entry : entries)
    each_suffix(entry, [&](std::string_view suffix) {
      (known += known.empty() ? "" : " ") += suffix;
      // "x.inp" and "x.ccx.inp": the longer suffix counts
      if (name.ends_with(suffix) && suffix.size() > longest) best = &entry, longest = suffix.size();
    });
  if (best == nullptr)
    throw std::invalid_argument("cannot tell the format of '" + path.string() +
                                "' by its suffix; known are " + known);
  return best->format;
}

FabricFormat format_named(std::string_view name) {
  std::string known;
  for (const FormatEntry& entry : entries) {
    if (entry.name == name) return entry.format;
    (known += known.empty() ? "" : ", ") += entry.name;
  }
  throw std::invalid_argument("there is no format '" + std::string(name) + "'; there are " + known);
}

void write_fabric(const std::filesystem::path& path, const State& state, FabricFormat format,
                  const ExportOptions& options) {
  check_repeats(state.fabric, options.repeats);
  switch (format) {
    case FabricFormat::obj_lines:
      return write_obj_lines(path, state.fabric, options);
    case FabricFormat::obj_tubes:
      return write_obj_tubes(path, state.fabric, options);
    case FabricFormat::ply:
      return write_ply(path, state.fabric, options);
    case FabricFormat::glb:
      return write_glb(path, state.fabric, options);
    case FabricFormat::gltf:
      return write_gltf(path, state.fabric, options);
    case FabricFormat::vtp:
      return write_vtp(path, state, options);
    case FabricFormat::bcc:
      return write_bcc(path, state.fabric, options);
    case FabricFormat::bcc_bspline:
      return write_bcc_bspline(path, state.fabric, options);
    case FabricFormat::yarns:
      return write_yarns(path, state.fabric, options);
    case FabricFormat::step:
      return write_step(path, state.fabric, options);
    case FabricFormat::step_tubes:
      return write_step_tubes(path, state.fabric, options);
    case FabricFormat::abaqus:
      return write_beams(path, state, BeamDialect::abaqus, options);
    case FabricFormat::calculix:
      return write_beams(path, state, BeamDialect::calculix, options);
    case FabricFormat::points_csv:
      return write_points_csv(path, state, options);
    case FabricFormat::state:
      return write_state(path, state);
  }
}

void write_fabric(const std::filesystem::path& path, const State& state) {
  write_fabric(path, state, fabric_format(path));
}

void write_fabric(const std::filesystem::path& path, const Fabric& fabric) {
  write_fabric(path, State{fabric, {}, {}});
}

}  // namespace loopwright
