// Force over strain of a held plain piece pulled along its courses, its height held: by the stretch test of
// src/experiments, and by yarns in motion with each of the three bindings, pulled slowly.
// Usage: study_yarn_bindings FABRIC_FILE [WALES COURSES [STRAIN]]
#include <chrono>
#include <cstdio>
#include <cstdlib>

#include "dynamics/yarn_motion.hpp"
#include "experiments/stretch.hpp"
#include "machine/run_machine.hpp"
#include "notation/read_program.hpp"
#include "pipeline.hpp"
#include "topology/build_yarn_graph.hpp"

using namespace loopwright;

namespace {

constexpr double step = 0.02;

struct Pulled {
  std::vector<double> force;  // N/m at 0, step, 2 step ...
  double us_per_loop_step = 0;
  int newton = 0, steps = 0, intact = 0;
  bool converged = true;
};

Pulled pulled(const RelaxResult& relaxed, const RelaxOptions& options, const std::string& binding,
              double set, double most_strain) {
  const Fabric& fabric = relaxed.fabric;
  const bool contact = binding == "contact";
  SplineModel model = spline_model(fabric, options.model.material, set, set > 0);
  model.drag = 0.05;
  const MotionState start = motion_state(fabric);
  Bindings bindings;
  std::optional<FabricContact> shells;
  if (binding == "barycentric") bindings = barycentric_bindings(model, start.place, feet(fabric), 200);
  if (binding == "sliding")
    bindings = sliding_bindings(model, start.place, feet(fabric), options.model.material.friction);
  if (contact) shells = fabric_contact(fabric, options.model, relaxed.history);
  MotionOptions motion_options;
  motion_options.tolerance = 1e-2;
  motion_options.constraint_tolerance = 1e-6;
  motion_options.most_newton = contact ? 25 : 10;
  YarnMotion motion(model, start, bindings, motion_options, shells);
  const double newton_per_m =
      options.model.material.reference_bend_N_m2 / std::pow(fabric.diameter_mm * 1e-3, 3) / fabric.height;
  Pulled result;
  const auto begin = std::chrono::steady_clock::now();
  // Without plates the piece curls, slowly: in two steps it has hardly begun, in thirty its force no longer
  // changes by a hundredth.
  constexpr int parts = 4;
  const int settle = binding != "barycentric" && set == 0 ? 30 : 2;
  double strain = 0;
  for (int point = 0; point * step <= most_strain + 1e-9; ++point) {
    for (int k = 0; k < (point == 0 ? settle : parts + settle); ++k) {
      if (point > 0 && k < parts) strain += step / parts;
      std::vector<Vec3> held = start.place;
      for (Vec3& p : held) p.x *= 1 + strain;
      const StepReport report = motion.step(25, held);
      result.newton += report.newton;
      ++result.steps;
      result.converged = result.converged && report.converged;
    }
    result.force.push_back(motion.course_force(fabric.width * (1 + strain)) * newton_per_m);
    if (std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count() > 60) break;
  }
  result.us_per_loop_step = 1e6 *
                            std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count() /
                            result.steps / static_cast<double>(fabric.loops.size());
  result.intact = check_interlacings(with_places(fabric, motion.state().place)).intact;
  return result;
}

}  // namespace

int main(int count, char** words) {
  if (count != 2 && count != 4 && count != 5)
    return std::fprintf(stderr, "study_yarn_bindings FILE [WALES COURSES [STRAIN]]\n"), 1;
  const double most_strain = count == 5 ? std::atof(words[4]) : 0.2;
  FabricOptions size;
  if (count >= 4) size.size_wales = std::atoi(words[2]), size.size_courses = std::atoi(words[3]);
  Diagnostics diagnostics(words[1]);
  Knitting knitting;
  knitting.program = read_program(words[1], diagnostics, size);
  knitting.record = run_machine(knitting.program, diagnostics);
  knitting.graph = build_yarn_graph(knitting.program, knitting.record, diagnostics);
  if (!diagnostics.ok()) return 1;
  const PieceRequest request;
  const Fabric fabric = first_geometry(knitting, request);
  const RelaxOptions options = relax_options(fabric, knitting.program, request);
  const RelaxResult relaxed = relax(fabric, options);
  std::printf("%s: %zu loops, %d of %zu interlacings at rest\n", words[1], relaxed.fabric.loops.size(),
              check_interlacings(relaxed.fabric).intact, relaxed.fabric.interlacings.size());

  StretchTest test;
  test.turning_points = {most_strain};
  test.largest_step = step;
  test.free_across = false;
  const StretchResult reference = stretch(relaxed, options, test);
  // Motion knows no plates: the same test without them, and in the steps in which motion is pulled.
  RelaxResult bare = relaxed;
  RelaxOptions no_plates = options;
  bare.plates = {};
  no_plates.plate_room = -1;
  const StretchResult without_plates = stretch(bare, no_plates, test);
  test.largest_step = step / 4;
  const StretchResult fine = stretch(bare, no_plates, test);
  const struct {
    const char* name;
    const char* binding;
    double set;
  } runs[] = {{"contact", "contact", 0},
              {"contact, repose", "contact", 1},
              {"sliding, straight", "sliding", 0},
              {"sliding, repose", "sliding", 1},
              {"barycentric, repose", "barycentric", 1},
              {"barycentric, straight", "barycentric", 0}};
  std::vector<Pulled> results;
  for (const auto& run : runs) results.push_back(pulled(relaxed, options, run.binding, run.set, most_strain));
  std::printf("strain  stretch test  no plates  no plates, steps of %.3f", step / 4);
  for (const auto& run : runs) std::printf("  %s", run.name);
  std::printf("   (N/m)\n");
  for (std::size_t k = 0; k < reference.points.size(); ++k) {
    std::printf("%.2f  %.1f  %.1f  %.1f", step * static_cast<double>(k), reference.points[k].course_force,
                without_plates.points[k].course_force, fine.points[4 * k].course_force);
    for (const Pulled& p : results)
      k < p.force.size() ? std::printf("  %.1f", p.force[k]) : std::printf("  -");
    std::printf("\n");
  }
  for (std::size_t r = 0; r < results.size(); ++r)
    std::printf("%s: %.0f us per loop and step, %.1f Newton steps a step, %d interlacings%s\n", runs[r].name,
                results[r].us_per_loop_step, static_cast<double>(results[r].newton) / results[r].steps,
                results[r].intact, results[r].converged ? "" : ", some steps not to their tolerance");
  return 0;
}
