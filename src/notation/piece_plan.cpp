#include "notation/piece_plan.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "notation/fabric_headers.hpp"

namespace loopwright {
namespace {

constexpr int smallest_margin = 3;  // wales and courses on each side
constexpr std::size_t widest_repeat = 10'000;
constexpr int widest_piece = 3 * largest_size;

int rounded_up(int value, int multiple) { return (value + multiple - 1) / multiple * multiple; }

// The repeat: the least common width of all passes, and the lines that knit.
bool find_repeat(const Vermiculation& source, PiecePlan& plan, Diagnostics& diagnostics) {
  std::size_t wales = 1;
  int courses = 0;
  for (const CourseLine& line : source.lines) {
    if (line.knits()) ++courses;
    for (const Pass& pass : line.passes) {
      for (const std::size_t width : {pass.cells.size(), pass.rear.size()}) {
        if (width == 0) continue;
        wales = std::lcm(wales, width);
        if (wales <= widest_repeat) continue;
        diagnostics.error(pass.at, "the widths of the passes up to here have no common repeat of at most " +
                                       std::to_string(widest_repeat) +
                                       " wales; give them the same width, or widths that divide one another");
        return false;
      }
    }
  }
  if (courses == 0) {
    diagnostics.error({}, "there is no course; write a line of vermiculation letters, e.g. 'g' for plain");
    return false;
  }
  plan.repeat_wales = static_cast<int>(wales);
  plan.repeat_courses = courses;
  return true;
}

// How far racking takes a loop.
int farthest_racking(const Vermiculation& source) {
  double farthest = 0;
  for (const CourseLine& line : source.lines) {
    for (const Pass& pass : line.passes) {
      for (const RackMark& mark : pass.racks) farthest = std::max(farthest, std::abs(mark.racking));
    }
  }
  return static_cast<int>(std::ceil(farthest));
}

bool find_size(const Vermiculation& source, const FabricSettings& settings, PiecePlan& plan,
               Diagnostics& diagnostics) {
  plan.wales = settings.size_wales > 0 ? settings.size_wales : plan.repeat_wales;
  plan.courses = settings.size_courses > 0 ? settings.size_courses : plan.repeat_courses;
  if (plan.edges == Edges::periodic) {
    const int wales = rounded_up(plan.wales, plan.repeat_wales);
    const int courses = rounded_up(plan.courses, plan.repeat_courses);
    if (wales != plan.wales || courses != plan.courses) {
      diagnostics.warning({}, "a periodic cell is made of whole repeats; the size becomes " +
                                  std::to_string(wales) + " wales x " + std::to_string(courses) + " courses");
    }
    plan.wales = wales;
    plan.courses = courses;
  }
  if (plan.edges == Edges::held || plan.edges == Edges::periodic) {
    plan.margin_wales = rounded_up(std::max(smallest_margin, farthest_racking(source)), plan.repeat_wales);
    plan.margin_courses = rounded_up(smallest_margin, plan.repeat_courses);
  } else {
    plan.whole = settings.size_courses == 0;
  }
  plan.first = -plan.margin_wales;
  plan.last = plan.wales + plan.margin_wales;
  if (plan.last > widest_piece) {
    diagnostics.error({}, "the piece with its margins is wider than " + std::to_string(widest_piece) +
                              " needles; give a smaller ;;Size or a narrower repeat");
    return false;
  }
  return true;
}

// Whether facing needles take yarn in the same pass while the beds are at home.
bool facing_needles_knit(const Pass& pass) {
  if (!pass.both_beds) return false;
  const std::size_t width = std::lcm(pass.cells.size(), pass.rear.size());
  for (std::size_t w = 0; w < width; ++w) {
    if (forms_loop(pass.cells[w % pass.cells.size()].letter) &&
        forms_loop(pass.rear[w % pass.rear.size()].letter)) {
      return true;
    }
  }
  return false;
}

// Facing needles cannot both knit in one pass when the beds stand opposite; half a pitch of racking lets
// them.
Gating gating_of(const Vermiculation& source) {
  if (source.gating) return *source.gating;
  for (const CourseLine& line : source.lines) {
    if (std::any_of(line.passes.begin(), line.passes.end(), facing_needles_knit)) return Gating::half_pitch;
  }
  return Gating::opposite;
}

}  // namespace

std::optional<PiecePlan> plan_piece(const Vermiculation& source, const FabricOptions& options,
                                    FabricSettings& settings, Diagnostics& diagnostics) {
  PiecePlan plan;
  plan.edges = options.edges ? *options.edges : settings.edges.value_or(Edges::held);
  settings.edges = plan.edges;
  if (options.size_wales > 0) settings.size_wales = options.size_wales;
  if (options.size_courses > 0) settings.size_courses = options.size_courses;
  if (!diagnostics.ok() || !find_repeat(source, plan, diagnostics)) return std::nullopt;
  settings.repeat_wales = plan.repeat_wales;
  settings.repeat_courses = plan.repeat_courses;
  if (!find_size(source, settings, plan, diagnostics)) return std::nullopt;
  plan.gating = gating_of(source);
  return plan;
}

}  // namespace loopwright
