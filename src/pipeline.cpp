#include "pipeline.hpp"

#include <algorithm>
#include <charconv>
#include <stdexcept>

#include "experiments/piece_size.hpp"
#include "geometry/find_repeat.hpp"
#include "geometry/fit_fabric.hpp"
#include "geometry/mend_crossings.hpp"
#include "geometry/periodic_cell.hpp"
#include "geometry/start_from_cell.hpp"
#include "geometry/window.hpp"
#include "machine/run_machine.hpp"
#include "mechanics/tiled_history.hpp"
#include "mechanics/yarn_material.hpp"
#include "notation/material.hpp"
#include "notation/read_program.hpp"
#include "outputs/state_material.hpp"
#include "topology/build_yarn_graph.hpp"

namespace loopwright {
namespace {

// "all" or a count of at least 1; nothing for anything else.
std::optional<int> parsed_count(std::string_view text) {
  if (text == "all") return 0;
  int count = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), count);
  if (error != std::errc() || end != text.data() + text.size() || count < 1) return std::nullopt;
  return count;
}

struct WantedPart {
  YarnCurves curves;
  LoopSelection inside;  // loops that are measured; empty: all that the curves hold
};

// The window and two rings of loops round it: the rings are the frame. Yarn may slide in the frame, where it
// is cut, so only the window's own interlacings are asked for (steps are certified for all yarn, the frame's
// too). Wales, courses and size are the window's own: the frame only holds it.
WantedPart window_in_frame(const YarnGraph& graph, const GeometryOptions& options, const PlacedPiece& piece,
                           const WindowSize& window) {
  const auto with_frame = [](int count) { return count == 0 ? 0 : count + 4; };
  WantedPart part;
  part.inside = middle_window(graph, piece.layout, window.wales, window.courses);
  part.curves =
      cut_window(graph, options, piece,
                 middle_window(graph, piece.layout, with_frame(window.wales), with_frame(window.courses)));
  std::erase_if(part.curves.interlacings, [&part](const PlacedInterlacing& i) {
    return part.inside[i.parent.position()] == 0 || part.inside[i.child.position()] == 0;
  });
  const YarnCurves inner = cut_window(graph, options, piece, part.inside);
  part.curves.wales = inner.wales, part.curves.courses = inner.courses;
  part.curves.width = inner.width, part.curves.height = inner.height;
  return part;
}

// What mechanics may change of the outer measures where there is neither lattice nor frame.
constexpr FreeMeasures no_frame{false, false, false};

// Of yarn on yarn, where the yarn's data do not state it: the middle of what is measured.
constexpr double usual_friction = 0.25;
constexpr double usual_twist_stiffness = 0.3;  // of lively yarn, over B

bool is_lively(const Fabric& fabric) {
  return std::any_of(fabric.yarns.begin(), fabric.yarns.end(),
                     [](const FabricYarn& yarn) { return yarn.liveliness != 0; });
}

// Lively yarn resists twist, whether or not its data say how much, and the wales of its cloth lean.
void make_lively(const Fabric& fabric, ModelOptions& options) {
  if (!is_lively(fabric)) return;
  if (options.material.twist_stiffness == 0) options.material.twist_stiffness = usual_twist_stiffness;
  options.free.skew = fabric.periodic;
}

Edges edges_of(const Program& program) { return program.settings.edges.value_or(Edges::bound_off); }

// Whether nothing holds the piece's border: mechanics has no frame to move then, and sizes are those of the
// loops.
bool is_free_piece(const Program& program, const PieceRequest& request) {
  const Edges edges = edges_of(program);
  return !request.periodic && !request.window && edges != Edges::held && edges != Edges::periodic;
}

bool is_framed(const RelaxOptions& options) { return options.model.free.width || options.model.free.height; }

// The repeat that a fabric file states, or the one that a knitout programme is found to have.
CellRange repeat_of(const Knitting& knitting) {
  if (!knitting.program.repeat_starts.empty()) return cell_range(knitting.program);
  const std::optional<FoundRepeat> found = find_repeat(knitting.graph);
  if (!found)
    throw std::invalid_argument(
        "periodic cell: no repeat was found in the programme; ask for a part of it with --window instead");
  return found->range;
}

WantedPart wanted_part(const Knitting& knitting, const PieceRequest& request,
                       const GeometryOptions& options) {
  const YarnGraph& graph = knitting.graph;
  // a whole piece has edges, cast-ons and bind-offs, where the template may need other shares
  const bool whole = !request.window && !request.periodic && knitting.program.window.needles == 0 &&
                     edges_of(knitting.program) != Edges::periodic;
  const PlacedPiece piece = whole ? mended_piece(graph, options) : place_type_points(graph, options);
  if (request.window) return window_in_frame(graph, options, piece, *request.window);
  if (request.periodic || edges_of(knitting.program) == Edges::periodic)
    return {cut_periodic_cell(graph, options, piece, repeat_of(knitting)), {}};
  return {cut_window(graph, options, piece, program_window(graph, knitting.program.window)), {}};
}

}  // namespace

WindowSize parsed_window(std::string_view text) {
  const std::size_t cross = text.find('x');
  if (cross != std::string_view::npos) {
    const std::optional<int> wales = parsed_count(text.substr(0, cross));
    const std::optional<int> courses = parsed_count(text.substr(cross + 1));
    if (wales && courses) return {*wales, *courses};
  }
  throw std::invalid_argument("a window is written WALESxCOURSES, such as 16x16, allx16 or 16xall, not '" +
                              std::string(text) + "'");
}

Knitting knit(const std::filesystem::path& file, const PieceRequest& request, Diagnostics& diagnostics) {
  FabricOptions options;
  if (request.periodic) options.edges = Edges::periodic;
  return knit_with(file, options, diagnostics);
}

Knitting knit_with(const std::filesystem::path& file, const FabricOptions& options,
                   Diagnostics& diagnostics) {
  Knitting knitting;
  knitting.program = read_program(file, diagnostics, options);
  knitting.record = run_machine(knitting.program, diagnostics);
  knitting.graph = build_yarn_graph(knitting.program, knitting.record, diagnostics);
  return knitting;
}

Fabric first_geometry(const Knitting& knitting, const PieceRequest& request) {
  if (knitting.graph.loops.empty()) throw std::invalid_argument("nothing was knitted: there is no loop");
  const GeometryOptions options = make_geometry_options(knitting.program);
  const WantedPart part = wanted_part(knitting, request, options);
  Fabric fabric = fit_fabric(part.curves, knitting.graph, options, {request.segments_per_loop});
  if (!part.inside.empty())
    std::erase_if(fabric.loops,
                  [&part](const LoopSpan& span) { return part.inside[span.loop.position()] == 0; });
  if (fabric.loops.empty()) throw std::invalid_argument("the part that is wanted holds no loop");
  fabric.name = knitting.program.settings.name;
  return fabric;
}

ImportedCurves import_curves(const std::filesystem::path& file, const PieceRequest& request,
                             Diagnostics& diagnostics) {
  YarnData yarn;
  read_yarn(request.curve_yarn, {}, yarn, diagnostics);
  ImportedCurves imported;
  if (!diagnostics.ok()) return imported;
  CurveOptions options;
  options.unit_mm = request.curve_unit_mm;
  options.diameter_mm = yarn.diameter_mm;
  options.linear_density_tex = yarn.linear_density_tex.value_or(0);
  options.colour = yarn.colour;
  imported.curves = fabric_of_curves(read_curve_file(file), options);
  Fabric& fabric = imported.curves.fabric;
  fabric.name = file.stem().string();
  imported.options.model.material = yarn_material(yarn, fabric.diameter_mm);
  imported.options.model.material.friction =
      request.friction.value_or(yarn.friction_coefficient.value_or(usual_friction));
  for (FabricYarn& each : fabric.yarns) each.liveliness = liveliness_of(yarn, fabric.diameter_mm);
  make_lively(fabric, imported.options.model);
  imported.options.model.free = no_frame;
  imported.options.plate_room = -1;  // it need not be flat
  return imported;
}

RelaxOptions relax_options(const Fabric& fabric, const Program& program, const PieceRequest& request) {
  const YarnData& yarn = reference_yarn(program);
  RelaxOptions options;
  options.model.material = yarn_material(yarn, fabric.diameter_mm);
  options.model.material.friction =
      request.friction.value_or(yarn.friction_coefficient.value_or(usual_friction));
  make_lively(fabric, options.model);
  if (is_free_piece(program, request)) options.model.free = no_frame;
  options.set = program.settings.set;
  return options;
}

std::optional<Fabric> start_from_relaxed_cell(const Knitting& knitting, const PieceRequest& request,
                                              const Fabric& first, RelaxOptions& options) {
  const Program& program = knitting.program;
  if (first.periodic || request.window || program.window.needles == 0 || program.repeat_starts.size() < 2)
    return std::nullopt;
  const GeometryOptions geometry = make_geometry_options(program);
  std::optional<Fabric> cell;
  CellRange range;
  try {
    range = cell_range(program);
    const PlacedPiece piece = place_type_points(knitting.graph, geometry);
    cell = fit_fabric(cut_periodic_cell(knitting.graph, geometry, piece, range), knitting.graph, geometry,
                      {request.segments_per_loop});
  } catch (const std::invalid_argument&) {
    return std::nullopt;  // the notation does not close into a cell
  }
  RelaxOptions cell_options = options;
  cell_options.grow_in = true;
  const RelaxResult relaxed = relax(*cell, cell_options);
  if (!relaxed.converged) return std::nullopt;
  std::optional<StartFromCell> start = start_from_cell(first, relaxed.fabric, knitting.graph, range);
  if (!start) return std::nullopt;
  hold_cut_contacts(relaxed.fabric, options.model, *start);
  options.grow_in = false;
  options.history = tiled_history(relaxed.fabric, relaxed.history, *start);
  return std::move(start->fabric);
}

RelaxOptions relax_options(const State& state) {
  const auto number = [&state](const char* key) {
    const auto found = state.numbers.find(key);
    if (found == state.numbers.end())
      throw std::invalid_argument(std::string("the state does not say its ") + key +
                                  "; make it anew from its notation");
    return found->second;
  };
  RelaxOptions options;
  std::string missing;
  const std::optional<YarnMaterial> material = state_material(state, &missing);
  if (!material) number(missing.c_str());  // says so
  options.model.material = *material;
  options.model.free.skew = state.fabric.periodic && is_lively(state.fabric);
  if (state.numbers.contains("plate_stiffness"))
    options.model.plates = {number("plate_stiffness"), number("plate_low"), number("plate_high")};
  options.grow_in = number("radius") < 1;
  if (state.numbers.contains("framed") && number("framed") == 0) options.model.free = no_frame;
  if (state.numbers.contains("plate_room")) options.plate_room = number("plate_room");
  options.history = state.history;
  return options;
}

RelaxResult relax_piece(const Fabric& fabric, const RelaxOptions& options) {
  RelaxResult result = relax(fabric, options);
  if (!fabric.periodic && !is_framed(options)) {
    const PieceSize size = piece_size(result.fabric);
    result.fabric.width = size.width, result.fabric.height = size.height;
  }
  return result;
}

Assessment assess(const Fabric& fabric) {
  return {measure(fabric), check_interlacings(fabric), min_clearance(fabric),
          static_cast<int>(std::count_if(fabric.yarns.begin(), fabric.yarns.end(), is_closed)),
          linking_numbers(fabric)};
}

JsonObject results(const Assessment& assessment) {
  const Measurements& m = assessment.measured;
  const auto known = [](const std::optional<double>& value) {
    return value ? JsonValue(*value) : JsonValue(nullptr);
  };
  JsonArray yarn_m;
  for (const YarnMeasurement& one : m.yarn) yarn_m.emplace_back(one.length_m);
  JsonObject all{{"loops", m.loops},
                 {"yarns", m.yarns},
                 {"wales", m.wales},
                 {"courses", m.courses},
                 {"width_mm", m.width_mm},
                 {"height_mm", m.height_mm},
                 {"thickness_mm", m.thickness_mm},
                 {"wale_spacing_mm", m.wale_spacing_mm},
                 {"course_spacing_mm", m.course_spacing_mm},
                 {"wales_per_cm", m.wales_per_cm},
                 {"courses_per_cm", m.courses_per_cm},
                 {"loop_length_mm", m.loop_length_mm},
                 {"Kc", m.Kc},
                 {"Kw", m.Kw},
                 {"Ks", m.Ks},
                 {"wale_lean_degrees", m.wale_lean_degrees},
                 {"cover_factor", m.cover_factor},
                 {"tightness_factor_sqrt_tex_per_cm", known(m.tightness_factor)},
                 {"yarn_m", std::move(yarn_m)},
                 {"mass_g", known(m.mass_g)},
                 {"areal_density_g_m2", known(m.areal_density_g_m2)},
                 {"interlacings", assessment.interlacings.expected},
                 {"interlacings_intact", assessment.interlacings.intact},
                 {"min_clearance", assessment.clearance.distance}};
  if (assessment.closed_yarns > 0) {
    JsonArray linked;
    for (const LinkedPair& pair : assessment.linked)
      linked.emplace_back(JsonArray{pair.a, pair.b, pair.number});
    all.emplace_back("closed_yarns", assessment.closed_yarns);
    all.emplace_back("linked_pairs", std::move(linked));
  }
  return all;
}

JsonObject results(const Assessment& assessment, const RelaxResult& relaxed) {
  JsonObject all = results(assessment);
  all.emplace_back("pass_throughs", relaxed.pass_throughs);
  all.emplace_back("converged", relaxed.converged);
  all.emplace_back("residual", relaxed.residual);
  all.emplace_back("newton_iterations", relaxed.newton_iterations);
  all.emplace_back("linear_iterations", relaxed.linear_iterations);
  all.emplace_back("spot_iterations", relaxed.spot_iterations);
  return all;
}

State saved_state(const Fabric& fabric, const RelaxOptions& options, double radius) {
  const YarnMaterial& material = options.model.material;
  State state;
  state.fabric = fabric;
  set_state_material(state, material);
  state.numbers["framed"] = is_framed(options) ? 1 : 0;
  state.numbers["radius"] = radius;
  if (options.plate_room < 0) state.numbers["plate_room"] = options.plate_room;
  return state;
}

State saved_state(const RelaxResult& relaxed, const RelaxOptions& options, double radius) {
  State state = saved_state(relaxed.fabric, options, radius);
  if (relaxed.plates.stiffness > 0) {
    state.numbers["plate_stiffness"] = relaxed.plates.stiffness;
    state.numbers["plate_low"] = relaxed.plates.low;
    state.numbers["plate_high"] = relaxed.plates.high;
  }
  state.history = relaxed.history;
  state.numbers["pass_throughs"] = relaxed.pass_throughs;
  state.numbers["converged"] = relaxed.converged ? 1 : 0;
  state.numbers["residual"] = relaxed.residual;
  state.numbers["newton_iterations"] = relaxed.newton_iterations;
  state.numbers["linear_iterations"] = relaxed.linear_iterations;
  state.numbers["spot_iterations"] = relaxed.spot_iterations;
  return state;
}

}  // namespace loopwright
