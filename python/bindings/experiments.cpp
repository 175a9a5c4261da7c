// Stretch tests and membrane constants.
#include <map>

#include "bindings.hpp"
#include "experiments/as_knitted.hpp"
#include "experiments/stretch.hpp"
#include "homogenise.hpp"

namespace loopwright::python {
namespace {

struct Stretched {
  std::vector<StretchPoint> points;
  ClothPointer cloth;  // at the last point
  bool stopped = false;

  bool whole() const {
    return std::all_of(points.begin(), points.end(), [](const StretchPoint& p) {
      return p.interlacings_intact == p.interlacings && p.pass_throughs == 0;
    });
  }
};
using StretchedPointer = std::shared_ptr<Stretched>;

StretchTest stretch_test(const std::string& direction, const std::vector<double>& to,
                         const std::optional<std::vector<double>>& load, double step,
                         std::optional<double> load_step, bool held_across) {
  StretchTest test;
  const std::optional<StretchDirection> known = stretch_direction_named(direction);
  if (!known)
    throw std::invalid_argument("there is no direction '" + direction +
                                "'; there are course, wale, both, shear");
  test.direction = *known;
  test.turning_points = to;
  test.largest_step = step;
  if (load) {
    test.control = StretchControl::load;
    test.turning_points = *load;
    test.largest_step = load_step.value_or(usual_load_step(*load));
  }
  test.free_across = !held_across;
  return test;
}

StretchedPointer stretch_cloth(const Cloth& cloth, const std::string& direction,
                               const std::vector<double>& to, const std::optional<std::vector<double>>& load,
                               double step, std::optional<double> load_step, bool held_across,
                               py::object progress) {
  const StretchTest test = stretch_test(direction, to, load, step, load_step, held_across);
  if (cloth.fabric().loops.empty())
    throw std::invalid_argument("a stretch test needs loops, and these are curves without");
  Watch watch(std::move(progress));
  auto stretched = std::make_shared<Stretched>();
  without_gil([&] {
    Piece piece = cloth.piece();
    std::optional<RelaxResult> rest = cloth.at_rest();
    if (!rest)
      rest = run_relax(piece, false, [&](const RelaxProgress& now, double share) {
               return watch.goes_on(now.phase, share, now.newton_iterations, now.residual);
             }).result;
    stretched->stopped = rest->stopped;
    if (rest->stopped) return;
    const auto wanted = static_cast<double>(point_count(test));
    double share = 0;
    piece.options.on_progress = [&](const RelaxProgress& now) {
      return watch.goes_on("stretch", share, now.newton_iterations, now.residual);
    };
    std::size_t done = 0;
    StretchResult result = stretch(*rest, piece.options, test, [&](const StretchPoint& p) {
      share = static_cast<double>(++done) / wanted;
      return watch.goes_on("stretch", share, p.newton_iterations, p.residual);
    });
    piece.options.on_progress = {};
    stretched->points = std::move(result.points);
    stretched->stopped = result.stopped;
    stretched->cloth = std::make_shared<Cloth>(piece_of(saved_state(result.fabric, piece.options, 1)));
  });
  watch.raise();
  if (!stretched->whole())
    warn("BrokenWarning", "broken: interlacings are lost (columns pass_throughs, interlacings_intact)");
  const auto not_at_rest = std::count_if(stretched->points.begin(), stretched->points.end(),
                                         [](const StretchPoint& p) { return !p.converged; });
  if (not_at_rest > 0 && !stretched->stopped)
    warn("NotAtRestWarning", "not at rest at " + std::to_string(not_at_rest) + " of " +
                                 std::to_string(stretched->points.size()) + " points (column converged)");
  return stretched;
}

// The columns of the command's CSV.
py::dict columns_of(const std::vector<StretchPoint>& points, const std::shared_ptr<const void>& owner) {
  py::dict all;
  const auto number = [&](const char* name, double StretchPoint::*member) {
    all[name] = column<double>(points, member, owner);
  };
  const auto count = [&](const char* name, int StretchPoint::*member) {
    all[name] = column<std::int32_t>(points, member, owner);
  };
  number("course_strain", &StretchPoint::course_strain);
  number("wale_strain", &StretchPoint::wale_strain);
  number("shear", &StretchPoint::shear);
  number("course_force_N_m", &StretchPoint::course_force);
  number("wale_force_N_m", &StretchPoint::wale_force);
  number("shear_force_N_m", &StretchPoint::shear_force);
  number("energy_J_m2", &StretchPoint::energy);
  number("residual", &StretchPoint::residual);
  count("newton_iterations", &StretchPoint::newton_iterations);
  count("pass_throughs", &StretchPoint::pass_throughs);
  count("interlacings_intact", &StretchPoint::interlacings_intact);
  count("interlacings", &StretchPoint::interlacings);
  number("min_clearance", &StretchPoint::min_clearance);
  all["converged"] = column<bool>(points, &StretchPoint::converged, owner);
  return all;
}

py::dict homogenise_cloth(const Cloth& cloth, const std::vector<double>& course,
                          const std::vector<double>& wale, const std::vector<double>& shear,
                          double course_pull, double wale_pull, double step, bool grid, py::object progress) {
  HomogeniseRequest request;
  request.grid = {with_zero(course), with_zero(wale), with_zero(shear), step};
  request.with_grid = grid;
  request.course_pull = course_pull, request.wale_pull = wale_pull;
  Watch watch(std::move(progress));
  const HomogeniseProgress on_progress = [&watch](const char* what, double share, const std::string&) {
    return watch.goes_on(what, share, 0, 0);
  };
  JsonObject all;
  auto points = std::make_shared<std::vector<StretchPoint>>();
  bool stopped = false, whole = true;
  without_gil([&] {
    const Piece piece = elastic_piece(cloth.piece());
    const RelaxResult rest = elastic_rest_of(piece, on_progress);
    stopped = rest.stopped;
    if (stopped) return;
    const Assessment assessment = assess(rest.fabric);
    Homogenised found = homogenise(rest, piece, request, on_progress);
    all = results(assessment, rest);
    for (auto& [key, value] : results(found)) all.emplace_back(key, std::move(value));
    whole = is_whole(assessment, rest.pass_throughs) && found.whole;
    stopped = found.stopped;
    *points = std::move(found.points);
  });
  watch.raise();
  if (!whole) warn("BrokenWarning", "broken: interlacings are lost under strain: strain it less");
  py::dict dict = python_of(all);
  dict["grid"] = columns_of(*points, points);
  dict["whole"] = whole;
  dict["stopped"] = stopped;
  return dict;
}

py::dict sensitivity_of(const Cloth& cloth, const std::map<std::string, double>& deviations,
                        py::object progress) {
  std::vector<Deviation> certain;
  for (const auto& [name, percent] : deviations) {
    if (!(percent >= 0 && percent < 100))
      throw std::invalid_argument("a deviation is a number of per cent, from 0 to below 100");
    certain.push_back({yarn_quantity_named(name), percent / 100});
  }
  Watch watch(std::move(progress));
  JsonObject all;
  bool whole = true;
  without_gil([&] {
    const Piece piece = elastic_piece(cloth.piece());
    const RelaxResult rest =
        elastic_rest_of(piece, [&watch](const char* what, double share, const std::string&) {
          return watch.goes_on(what, share, 0, 0);
        });
    if (rest.stopped) return;
    const Assessment assessment = assess(rest.fabric);
    whole = is_whole(assessment, rest.pass_throughs);
    const std::vector<Sensitivity> found = sensitivities(rest, piece.options);
    all = results(assessment, rest);
    all.emplace_back("relative_change_per_relative_change", results(found));
    if (certain.empty()) return;
    const SizeDeviation size = size_deviation(found, certain);
    all.emplace_back("width_deviation_mm", size.width * assessment.measured.width_mm);
    all.emplace_back("height_deviation_mm", size.height * assessment.measured.height_mm);
  });
  watch.raise();
  if (!whole) warn("BrokenWarning", "broken: interlacings are lost at rest without friction");
  return python_of(all);
}

ClothPointer relax_as_knitted_cloth(const Cloth& cloth, double machine_width_mm, double take_down_N,
                                    double flat_gap_mm, double hand_pull_N_m, std::optional<double> tolerance,
                                    py::object progress) {
  Watch watch(std::move(progress));
  ClothPointer relaxed = without_gil([&] {
    RelaxRun run;
    run.options = cloth.piece().options;
    if (tolerance) run.options.tolerance = *tolerance;
    run.options.on_progress = [&watch](const RelaxProgress& now) {
      return watch.goes_on(now.phase, 0.5 * now.radius, now.newton_iterations, now.residual);
    };
    KnittedRest rest = relax_as_knitted(cloth.fabric(), run.options,
                                        {machine_width_mm, take_down_N, flat_gap_mm, hand_pull_N_m});
    run.options.on_progress = {};
    run.options.tolerance = cloth.piece().options.tolerance;
    run.result = std::move(rest.relaxed);
    run.result.converged = run.result.converged && rest.on_machine.converged;
    run.radius = run.result.stopped ? 0 : 1;
    run.linked_before = linking_numbers(cloth.fabric());
    return std::make_shared<Cloth>(std::move(run), cloth.state());
  });
  watch.raise();
  warn_of(*relaxed);
  return relaxed;
}

}  // namespace

void bind_experiments(py::module_& module) {
  py::class_<Stretched, StretchedPointer>(module, "StretchTest",
                                          "A stretch test: columns by name, a row for every point.")
      .def_property_readonly(
          "columns", [](const StretchedPointer& s) { return columns_of(s->points, s); },
          "(points,) views by the names of docs/stretch.md: course_strain, course_force_N_m ...")
      .def("__getitem__",
           [](const StretchedPointer& s, const py::str& name) -> py::object {
             return columns_of(s->points, s)[name];
           })
      .def("__len__", [](const Stretched& s) { return s.points.size(); })
      .def_readonly("cloth", &Stretched::cloth, "The Cloth at the last point; None if there is none.")
      .def_readonly("stopped", &Stretched::stopped)
      .def_property_readonly("whole", &Stretched::whole, "No interlacing was lost at any point.")
      .def_property_readonly(
          "interlacings_kept",
          [](const Stretched& s) {
            std::pair kept(0, 0);
            for (const StretchPoint& p : s.points)
              if (kept.second == 0 || p.interlacings_intact < kept.first)
                kept = {p.interlacings_intact, p.interlacings};
            return kept;
          },
          "(kept, of so many) at the worst point.")
      .def_property_readonly(
          "converged",
          [](const Stretched& s) {
            return std::all_of(s.points.begin(), s.points.end(), [](const auto& p) { return p.converged; });
          },
          "At rest at every point.")
      .def("__repr__", [](const Stretched& s) {
        return "<StretchTest of " + std::to_string(s.points.size()) + " points>";
      });

  // what `cloth` is asked for as well as the package's functions
  auto cloth = py::reinterpret_borrow<py::class_<Cloth, ClothPointer>>(module.attr("Cloth"));
  cloth.def(
      "stretch", &stretch_cloth, py::kw_only(), py::arg("direction") = "course",
      py::arg("to") = std::vector<double>{0.3}, py::arg("load") = py::none(), py::arg("step") = 0.02,
      py::arg("load_step") = py::none(), py::arg("held_across") = false, py::arg("progress") = py::none(),
      "Pulls it and reads off the forces of its frame; it is brought to rest first if it is not there.\n\n"
      "direction: 'course', 'wale', 'both' or 'shear'; to: strains to go to, in order; load: forces "
      "instead,\n"
      "N/m; step, load_step: the largest steps; held_across: the other size stays as it is.");
  cloth.def(
      "relax_as_knitted", &relax_as_knitted_cloth, py::kw_only(), py::arg("machine_width_mm"),
      py::arg("take_down_N") = 0.0, py::arg("flat_gap_mm") = 0.0, py::arg("hand_pull_N_m") = 0.0,
      py::arg("tolerance") = py::none(), py::arg("progress") = py::none(),
      "From a first geometry to rest by the way that cloth goes: on the needles, machine_width_mm wide "
      "under\n"
      "a pull of take_down_N along its wales; hanging under that pull, as wide as it likes; then let go.\n"
      "flat_gap_mm: kept flat all the while, the outermost centrelines so far apart (0: not at all);\n"
      "hand_pull_N_m: then pulled straight both ways at once, and let go again.");
  cloth.def(
      "sensitivity", &sensitivity_of, py::kw_only(), py::arg("deviations") = std::map<std::string, double>{},
      py::arg("progress") = py::none(),
      "How a cell's size and stiffness depend on the data of its yarn, without friction: the keys of\n"
      "docs/homogenise.md. deviations: standard deviations of quantities in per cent, {'loop-length': 2}.");
  const HomogeniseRequest usual;
  cloth.def("homogenise", &homogenise_cloth, py::kw_only(), py::arg("course") = usual.grid.course,
            py::arg("wale") = usual.grid.wale, py::arg("shear") = usual.grid.shear,
            py::arg("course_pull") = usual.course_pull, py::arg("wale_pull") = usual.wale_pull,
            py::arg("step") = usual.grid.largest_step, py::arg("grid") = true,
            py::arg("progress") = py::none(),
            "A cell as a membrane, without friction: the keys of docs/homogenise.md, and 'grid': columns.");
}

}  // namespace loopwright::python
