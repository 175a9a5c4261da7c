// The reading side of the saved state: columns back into a fabric, and what makes a fabric unsound.
#include <algorithm>
#include <cmath>
#include <tuple>

#include "outputs/hdf5_columns.hpp"
#include "outputs/state.hpp"

namespace loopwright {
namespace {

using hdf5::ContentError;
using hdf5::Reader;

template <class... Columns>
void require_rows(const std::string& group, std::size_t rows, const Columns&... columns) {
  if (((columns.size() != rows) || ...))
    throw ContentError("the columns of '" + group + "' differ in length");
}

template <class T>
T only(const std::vector<T>& column, const char* name) {
  if (column.size() != 1) throw ContentError("'" + std::string(name) + "' is not a single value");
  return column.front();
}

bool flag(std::uint8_t value, const char* name) {
  if (value > 1) throw ContentError("'" + std::string(name) + "' is neither 0 nor 1");
  return value == 1;
}

// An enumeration's value, where the numbers low .. high are all valid.
template <class Enum>
Enum named(std::int32_t value, int low, int high, const char* name) {
  if (value < low || value > high) throw ContentError("'" + std::string(name) + "' holds an unknown value");
  return static_cast<Enum>(value);
}

std::array<int, 2> pair_at(const std::vector<std::int32_t>& column, std::size_t row) {
  return {column[2 * row], column[2 * row + 1]};
}

void read_fabric(const Reader& in, Fabric& fabric) {
  const auto one = [&in](const char* name) { return only(in.doubles(name), name); };
  fabric.name = only(in.texts("fabric/name"), "fabric/name");
  fabric.diameter_mm = one("fabric/diameter");
  fabric.width = one("fabric/width");
  fabric.height = one("fabric/height");
  fabric.skew = one("fabric/skew");
  fabric.wales = one("fabric/wales");
  fabric.courses = one("fabric/courses");
  fabric.periodic = flag(only(in.octets("fabric/periodic"), "fabric/periodic"), "fabric/periodic");
}

// A row for every segment of every yarn; yarn whose rows are all 0 is straight.
void read_set(const Reader& in, std::vector<FabricYarn>& yarns) {
  const auto curvatures = in.doubles("segments/natural_curvature", 4);
  std::size_t next = 0;
  for (FabricYarn& yarn : yarns) {
    const auto count = static_cast<std::size_t>(std::max(yarn.segments(), 0));
    if (count > curvatures.size() / 4 - next)
      throw ContentError("'segments/natural_curvature' has fewer rows than the yarns have segments");
    for (std::size_t e = 0; e < count; ++e, ++next)
      yarn.natural_curvature.push_back({curvatures[4 * next], curvatures[4 * next + 1],
                                        curvatures[4 * next + 2], curvatures[4 * next + 3]});
    if (std::all_of(yarn.natural_curvature.begin(), yarn.natural_curvature.end(),
                    [](const auto& row) { return row == std::array<double, 4>{}; }))
      yarn.natural_curvature.clear();
  }
  if (next != curvatures.size() / 4)
    throw ContentError("'segments/natural_curvature' has more rows than the yarns have segments");
}

void read_yarns(const Reader& in, std::vector<FabricYarn>& yarns) {
  const auto ids = in.integers("yarns/yarn"), carriers = in.integers("yarns/carrier");
  const auto colours = in.texts("yarns/colour");
  const auto diameters = in.doubles("yarns/diameter"), densities = in.doubles("yarns/linear_density");
  const auto lengths = in.doubles("yarns/segment_rest_length");
  const auto periodic = in.octets("yarns/periodic");
  const auto liveliness =
      in.has("yarns/liveliness") ? in.doubles("yarns/liveliness") : std::vector<double>(ids.size(), 0);
  const auto shift = in.integers("yarns/shift", 2), counts = in.integers("yarns/control_points");
  require_rows("yarns", ids.size(), carriers, colours, diameters, densities, lengths, periodic, counts,
               liveliness);
  require_rows("yarns", 2 * ids.size(), shift);
  const auto places = in.doubles("control_points/position", 3);
  const auto held = in.octets("control_points/held");
  require_rows("control_points", places.size() / 3, held);

  std::size_t next = 0;
  for (std::size_t y = 0; y < ids.size(); ++y) {
    FabricYarn yarn;
    yarn.yarn = YarnId(ids[y]);
    yarn.carrier = CarrierId(carriers[y]);
    yarn.colour = colours[y];
    yarn.diameter = diameters[y];
    yarn.linear_density_tex = densities[y];
    yarn.segment_rest_length = lengths[y];
    yarn.liveliness = liveliness[y];
    yarn.periodic = flag(periodic[y], "yarns/periodic");
    yarn.shift = pair_at(shift, y);
    if (counts[y] < 0 || static_cast<std::size_t>(counts[y]) > held.size() - next)
      throw ContentError("'yarns/control_points' asks for more control points than there are");
    for (std::int32_t k = 0; k < counts[y]; ++k, ++next) {
      yarn.control_points.push_back({places[3 * next], places[3 * next + 1], places[3 * next + 2]});
      yarn.held.push_back(held[next]);
    }
    yarns.push_back(std::move(yarn));
  }
  if (next != held.size()) throw ContentError("'yarns/control_points' leaves control points over");
  if (in.has("segments/natural_curvature")) read_set(in, yarns);
}

void read_loops(const Reader& in, Fabric& fabric) {
  const auto ids = in.integers("loops/loop"), yarns = in.integers("loops/yarn");
  const auto begins = in.doubles("loops/begin"), apexes = in.doubles("loops/apex"),
             ends = in.doubles("loops/end");
  const auto lines = in.integers("loops/line"), columns = in.integers("loops/text_column");
  const auto kinds = in.integers("loops/kind"), sides = in.integers("loops/side");
  const auto directions = in.integers("loops/direction");
  require_rows("loops", ids.size(), yarns, begins, apexes, ends, lines, columns, kinds, sides, directions);
  // these three came later: older states do without
  const bool placed = in.has("loops/course");
  const auto courses = placed ? in.integers("loops/course") : std::vector<std::int32_t>(ids.size(), -1);
  const auto slots = placed ? in.doubles("loops/slot") : std::vector<double>(ids.size(), 0);
  const auto beds = placed ? in.integers("loops/bed") : std::vector<std::int32_t>(ids.size(), 0);
  require_rows("loops", ids.size(), courses, slots, beds);
  for (std::size_t k = 0; k < ids.size(); ++k) {
    LoopSpan loop;
    loop.loop = LoopId(ids[k]);
    loop.yarn = yarns[k];
    loop.begin = begins[k];
    loop.apex = apexes[k];
    loop.end = ends[k];
    loop.at = {lines[k], columns[k]};
    loop.kind = named<LoopKind>(kinds[k], 0, static_cast<int>(LoopKind::split), "loops/kind");
    if (sides[k] == 0) throw ContentError("'loops/side' holds an unknown value");
    loop.side = named<StitchSide>(sides[k], -1, 1, "loops/side");
    loop.direction = named<Direction>(directions[k], -1, 1, "loops/direction");
    loop.course = courses[k];
    loop.slot = slots[k];
    loop.bed = named<Bed>(beds[k], 0, static_cast<int>(Bed::back_slider), "loops/bed");
    fabric.loops.push_back(loop);
  }
  const auto parents = in.integers("interlacings/parent"), children = in.integers("interlacings/child");
  const auto signs = in.integers("interlacings/sign"), shift = in.integers("interlacings/shift", 2);
  require_rows("interlacings", parents.size(), children, signs);
  require_rows("interlacings", 2 * parents.size(), shift);
  for (std::size_t k = 0; k < parents.size(); ++k)
    fabric.interlacings.push_back({LoopId(parents[k]), LoopId(children[k]), signs[k], pair_at(shift, k)});
}

ContactHistory read_history(const Reader& in) {
  ContactHistory history;
  if (!in.has("history/segments")) return history;
  const auto segments = in.integers("history/segments", 2), shift = in.integers("history/shift", 2);
  const auto slip = in.doubles("history/slip", 3);
  require_rows("history", segments.size(), shift);
  require_rows("history", segments.size() / 2 * 3, slip);
  const auto image = [&](std::size_t k) {
    if (shift[k] < -128 || shift[k] > 127) throw ContentError("'history/shift' is out of range");
    return static_cast<std::int8_t>(shift[k]);
  };
  for (std::size_t k = 0; 2 * k < segments.size(); ++k)
    history.push_back({segments[2 * k],
                       segments[2 * k + 1],
                       image(2 * k),
                       image(2 * k + 1),
                       {slip[3 * k], slip[3 * k + 1], slip[3 * k + 2]}});
  return history;
}

std::string yarn_fault(const FabricYarn& yarn, bool fabric_is_periodic) {
  if (!(yarn.diameter > 0) || !std::isfinite(yarn.diameter)) return "its diameter is not a positive number";
  if (!(yarn.segment_rest_length > 0) || !std::isfinite(yarn.segment_rest_length))
    return "its segments' rest length is not a positive number";
  if (!(yarn.linear_density_tex >= 0) || !std::isfinite(yarn.linear_density_tex))
    return "its linear density is negative";
  if (!std::isfinite(yarn.liveliness)) return "its liveliness is not a number";
  if (yarn.periodic && !fabric_is_periodic && yarn.shift != std::array<int, 2>{0, 0})
    return "it repeats with a lattice that the fabric does not have";
  if (yarn.segments() < 1) return "it has too few control points";
  if (!yarn.natural_curvature.empty() &&
      yarn.natural_curvature.size() != static_cast<std::size_t>(yarn.segments()))
    return "its natural curvatures and segments differ in number";
  for (const std::array<double, 4>& row : yarn.natural_curvature)
    for (const double kappa : row)
      if (!(kappa >= 0) || !std::isfinite(kappa)) return "a natural curvature is not a number of 0 or more";
  if (yarn.held.size() != yarn.control_points.size())
    return "its held marks and control points differ in number";
  if (std::any_of(yarn.held.begin(), yarn.held.end(), [](std::uint8_t h) { return h > 1; }))
    return "a held mark is neither 0 nor 1";
  if (!std::all_of(yarn.control_points.begin(), yarn.control_points.end(), is_finite))
    return "it has coordinates that are not finite numbers";
  return {};
}

}  // namespace

State state_from_columns(const Reader& in);

State state_from_columns(const Reader& in) {
  State state;
  read_fabric(in, state.fabric);
  read_yarns(in, state.fabric.yarns);
  read_loops(in, state.fabric);
  state.history = read_history(in);
  const auto number_names = in.texts("run/number_names"), text_names = in.texts("run/text_names");
  const auto numbers = in.doubles("run/numbers");
  const auto texts = in.texts("run/texts");
  require_rows("run", number_names.size(), numbers);
  require_rows("run", text_names.size(), texts);
  for (std::size_t k = 0; k < numbers.size(); ++k) state.numbers[number_names[k]] = numbers[k];
  for (std::size_t k = 0; k < texts.size(); ++k) state.texts[text_names[k]] = texts[k];
  return state;
}

std::string fabric_fault(const Fabric& fabric) {
  for (const double v :
       {fabric.diameter_mm, fabric.width, fabric.height, fabric.skew, fabric.wales, fabric.courses})
    if (!std::isfinite(v)) return "a size of the fabric is not a finite number";
  if (!(fabric.diameter_mm > 0)) return "the yarn diameter is not positive";
  if (fabric.periodic && !(fabric.width > 0 && fabric.height > 0))
    return "the periodic cell has no width or height";
  for (std::size_t y = 0; y < fabric.yarns.size(); ++y)
    if (const std::string fault = yarn_fault(fabric.yarns[y], fabric.periodic); !fault.empty())
      return "yarn " + std::to_string(y) + ": " + fault;
  for (std::size_t k = 0; k < fabric.loops.size(); ++k) {
    const LoopSpan& loop = fabric.loops[k];
    const std::string which = "loop " + std::to_string(k) + ": ";
    if (loop.yarn < 0 || static_cast<std::size_t>(loop.yarn) >= fabric.yarns.size())
      return which + "its yarn does not exist";
    if (!std::isfinite(loop.slot)) return which + "its place among the needles is not a number";
    if (!std::isfinite(loop.begin) || !std::isfinite(loop.apex) || !std::isfinite(loop.end) ||
        loop.begin > loop.end)
      return which + "its place on the yarn is not a stretch of it";
  }
  for (const PlacedInterlacing& pair : fabric.interlacings)
    if (!pair.parent.valid() || !pair.child.valid() || (pair.sign != 1 && pair.sign != -1))
      return "an interlacing names no loop or has a sign other than +1 and -1";
  return {};
}

std::string history_fault(const Fabric& fabric, const ContactHistory& history) {
  int segments = 0;
  for (const FabricYarn& yarn : fabric.yarns) segments += yarn.segments();
  const auto is_one = [&](std::int32_t segment) { return segment >= 0 && segment < segments; };
  for (std::size_t k = 0; k < history.size(); ++k) {
    const ContactSlip& now = history[k];
    if (!is_one(now.a) || !is_one(now.b)) return "friction's history names a segment that does not exist";
    if (!is_finite(now.slip)) return "friction's history has a slip that is not a finite number";
    if (k == 0) continue;
    const ContactSlip& before = history[k - 1];
    if (std::tie(before.a, before.b, before.m, before.n) >= std::tie(now.a, now.b, now.m, now.n))
      return "friction's history is not in the order of its segments";
  }
  return {};
}

}  // namespace loopwright
