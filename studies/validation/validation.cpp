// The figures of docs/validation.md that are not tests: cells at three tightnesses, stretch curves beside
// reference relaxations made with another model, scaling, friction at rest and in a cycle, and acrylic
// fabrics beside published measurements. Writes its plots into docs/pictures of the folder that it is run in.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <limits>
#include <string>
#include <vector>

#include "experiments/stretch.hpp"
#include "geometry/interlacing.hpp"
#include "outputs/write_plot_svg.hpp"
#include "validation_cells.hpp"

namespace loopwright {
namespace {

void print_tightness() {
  struct Row {
    double loop, Kc, Kw, bend;
  };
  std::printf("plain, frictionless (reference: 96 straight segments a stitch)\n");
  std::printf("   l/d      Kc   (ref)      Kw   (ref)       R   (ref)  E_b l/B   (ref)  least distance\n");
  for (const Row& row :
       {Row{14, 5.994, 3.546, 51.23}, Row{17, 5.295, 4.047, 43.18}, Row{20, 5.507, 3.566, 40.52}}) {
    const RelaxResult cell = rested(cell_of("g", row.loop, 1, 24), hard_yarn(0));
    const Spacing k = spacing(cell.fabric);
    const double loops = static_cast<double>(cell.fabric.loops.size());
    std::printf("%6.0f  %6.3f  %6.3f  %6.3f  %6.3f  %6.3f  %6.3f   %6.2f  %6.2f  %.3f%s\n", row.loop, k.Kc,
                row.Kc, k.Kw, row.Kw, k.Kc / k.Kw, row.Kc / row.Kw, cell.energy.bend / loops * k.loop_length,
                row.bend, min_clearance(cell.fabric).distance, cell.converged ? "" : "  not converged");
  }
  std::printf("\n");
}

// Reference curves at l/d = 17 (nominal stress times l^3 / B, transverse strain).
struct Reference {
  const char *name, *courses;
  StretchDirection direction;
  std::vector<double> strain, stress, across;
};

const std::vector<Reference>& references() {
  static const std::vector<Reference> all{{"plain",
                                           "g",
                                           StretchDirection::course,
                                           {.05, .1, .2, .3, .4, .5, .6},
                                           {76.8, 132.6, 285.3, 455.4, 618.2, 804.5, 1058.4},
                                           {-.021, -.043, -.085, -.129, -.173, -.217, -.261}},
                                          {"rib",
                                           "ge",
                                           StretchDirection::course,
                                           {.1, .25, .5, .75, 1, 1.25, 1.5, 1.75},
                                           {95.1, 194.7, 309.2, 361.1, 438.6, 546.4, 692.2, 902.2},
                                           {-.048, -.075, -.110, -.141, -.170, -.204, -.242, -.285}},
                                          {"garter",
                                           "g\ne",
                                           StretchDirection::course,
                                           {.05, .1, .2, .3, .4, .5},
                                           {97, 209, 408, 608, 855, 1148},
                                           {-.031, -.060, -.120, -.184, -.238, -.291}},
                                          {"plain",
                                           "g",
                                           StretchDirection::wale,
                                           {.05, .1, .15, .2, .3},
                                           {104, 256, 778, 1783, 7783},
                                           {-.034, -.032, -.033, -.042, -.092}},
                                          {"rib",
                                           "ge",
                                           StretchDirection::wale,
                                           {.05, .1, .15, .2, .3},
                                           {104, 189, 274, 382, 753},
                                           {-.024, -.062, -.107, -.144, -.193}},
                                          {"garter",
                                           "g\ne",
                                           StretchDirection::wale,
                                           {.1, .2, .3, .4, .5, .6, .7},
                                           {30, 44, 88, 128, 211, 643, 1436},
                                           {-.015, -.029, -.056, -.097, -.143, -.144, -.150}}};
  return all;
}

void print_curves(double sample_spacing, bool draw) {
  RelaxOptions options = hard_yarn(0);
  options.model.sample_spacing = sample_spacing;
  for (const StretchDirection direction : {StretchDirection::course, StretchDirection::wale}) {
    const bool course = direction == StretchDirection::course;
    Plot plot{course ? "Stretched along the courses, l/d 17, no friction"
                     : "Stretched along the wales, l/d 17, no friction",
              "strain",
              "stress l^3 / B",
              {}};
    for (const Reference& r : references()) {
      if (r.direction != direction) continue;
      const RelaxResult rest = rested(cell_of(r.courses, 17, 1, 24), options);
      StretchTest test;
      test.direction = direction;
      test.turning_points = {r.strain.back() + 0.02};
      Curve curve;
      int unsettled = 0;
      stretch(rest, options, test, [&](const StretchPoint& p) {
        const double unit = std::pow(17e-3, 3) / options.model.material.reference_bend_N_m2;
        curve.add(course ? p.course_strain : p.wale_strain, unit * (course ? p.course_force : p.wale_force),
                  course ? p.wale_strain : p.course_strain);
        unsettled += !p.converged;
        return true;
      });
      std::printf(
          "%s along the %s, frictionless, l/d 17, samples every %.2f d (%d of %zu points not at rest)\n",
          r.name, course ? "courses" : "wales", sample_spacing, unsettled, curve.strain.size());
      std::printf("  strain  stress l^3/B  (ref)      off   across   (ref)\n");
      for (std::size_t k = 0; k < r.strain.size(); ++k) {
        const double s = curve.at(curve.strain, curve.stress, r.strain[k]);
        std::printf("  %6.2f  %8.1f  %8.1f  %+6.1f %%  %+.3f  %+.3f\n", r.strain[k], s, r.stress[k],
                    100 * (s / r.stress[k] - 1), curve.at(curve.strain, curve.across, r.strain[k]),
                    r.across[k]);
      }
      std::printf("  strain at 600: %.3f (ref %.3f)\n\n", curve.at(curve.stress, curve.strain, 600),
                  Curve{r.strain, r.stress, r.across}.at(r.stress, r.strain, 600));
      plot.curves.push_back({r.name, curve.strain, curve.stress, false});
      plot.curves.push_back({std::string(r.name) + ", reference", r.strain, r.stress, true});
    }
    if (draw)
      write_plot_svg(course ? "docs/pictures/validation_courses.svg" : "docs/pictures/validation_wales.svg",
                     plot);
  }
}

// How even a curve is: largest departure of the force from a parabola through five neighbouring points.
double unevenness(const Curve& curve) {
  constexpr double weights[] = {-3 / 35.0, 12 / 35.0, 17 / 35.0, 12 / 35.0, -3 / 35.0};
  double sum = 0;
  int counted = 0;
  for (std::size_t k = 2; k + 2 < curve.stress.size(); ++k) {
    double smooth = 0;
    for (std::size_t i = 0; i < 5; ++i) smooth += weights[i] * curve.stress[k + i - 2];
    if (curve.strain[k] < 0.1) continue;
    sum += std::pow(curve.stress[k] / smooth - 1, 2);
    ++counted;
  }
  return std::sqrt(sum / counted);
}

void print_corrugation() {
  std::printf(
      "what the spacing of contact samples does to a stretch curve along the courses, frictionless, l/d 17\n"
      "  (stress l^3/B at strains, and r.m.s. departure from parabolas through five points)\n");
  for (const char* courses : {"g", "ge"})
    for (const double segments : {12.0, 16.0, 24.0, 48.0})
      for (const double apart : {0.18, 0.12, 0.06}) {
        RelaxOptions options = hard_yarn(0);
        options.model.sample_spacing = apart;
        const RelaxResult rest = rested(cell_of(courses, 17, 1, segments), options);
        StretchTest test;
        test.turning_points = {0.42};
        Curve curve;
        for (const StretchPoint& p : stretch(rest, options, test).points)
          curve.add(p.course_strain,
                    p.course_force * std::pow(17e-3, 3) / options.model.material.reference_bend_N_m2, 0);
        std::printf("  %-5s %2.0f segments, samples every %.2f d:", courses[1] ? "rib" : "plain", segments,
                    apart);
        for (const double e : {0.1, 0.2, 0.3, 0.4})
          std::printf("  %6.1f", curve.at(curve.strain, curve.stress, e));
        std::printf("   %.2f %%\n", 100 * unevenness(curve));
      }
  std::printf("\n");
}

void print_scaling() {
  std::printf("plain at l/d 17 for yarns of other sizes and stiffnesses: stress at a strain of 0.2, N/m\n");
  double first = 0;
  for (const double diameter : {0.25, 1.0, 4.0}) {
    RelaxOptions options = hard_yarn(0);
    StretchTest test;
    test.turning_points = {0.2};
    const RelaxResult rest = rested(cell_of("g", 17 * diameter, diameter, 24), options);
    const double stress = stretch(rest, options, test).points.back().course_force,
                 scaled = stress * std::pow(17e-3 * diameter, 3);
    if (first == 0) first = scaled;
    std::printf("  l %6.2f mm: %10.5f, times l^3 %+.5f %% off the first\n", 17 * diameter, stress,
                100 * (scaled / first - 1));
  }
  std::printf("\n");
}

// Friction: pulled and pushed by less and less in turn, then let go.
void print_shaken() {
  std::printf("plain, l/d 17, shaken (stretched and compressed by 10 %% to 1 %% in turn), then let go\n");
  for (const double friction : {0.0, 0.2, 0.3})
    for (const double from : {1.1, 1 / 1.1}) {
      RelaxOptions options = hard_yarn(friction);
      const RelaxResult start = rested(cell_of("g", 17, 1, 24), options);
      const RelaxResult shaken_cell = shaken(start, options, from);
      const Spacing k = spacing(shaken_cell.fabric);
      std::printf("  friction %.1f, first stretched to %.2f of its width: Kc %.3f Kw %.3f Ks %.2f R %.3f%s\n",
                  friction, from, k.Kc, k.Kw, k.Kc * k.Kw, k.Kc / k.Kw,
                  shaken_cell.converged ? "" : "  not converged");
    }
  std::printf("\n");
}

// Yarn [mm, N] and loops. Singal and others, Nature Communications 15, 2622 (2024): B 0.09 N mm^2 and shell
// 1.2e-3 (both twice what their code says, which leaves out the half of the bend energy and counts pairs
// twice). 77 tex: Ding, Sanchez, Bertoldi, Rycroft, arXiv 2307.12360, core and shell estimated
// (data/materials). Measured strains at 0.1 N/mm; NaN: none that may be looked at here.
constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
struct Acrylic {
  const char *name, *courses;
  double loop, diameter, core;  // mm
  double course_strain = unknown, wale_strain = unknown;
  double B = 0.09, EA = 300, shell = 1.2e-3;  // N mm^2, N, N/mm^3
};
constexpr Acrylic acrylics[] = {{"plain", "g", 11.28, 1.48, 0.65, .271, .1425},
                                {"garter", "g\ne", 10.55, 1.08, 0.51, .326, .570},
                                {"rib", "ge", 16.10, 2.36, 0.82, 1.730, .366},
                                {"seed", "ge\neg", 15.67, 2.40, 0.57}};
constexpr Acrylic of_77_tex(const char* name, const char* courses, double core) {
  return {name, courses, 7.23, 1.05, core, unknown, unknown, 0.0147, 68, 6e-4};
}
// First guessed in proportion to the yarns of Singal and others, then its fibres (1180 kg/m3) packed to 0.8, as
// tight as staple yarn gets.
constexpr double cores_77_tex[] = {0.5, 0.32};  // mm

RelaxOptions acrylic_yarn(const Acrylic& a, double friction) {
  RelaxOptions options;
  options.model.material = {a.EA * a.diameter * a.diameter / a.B,
                            1,
                            {1, a.core / a.diameter, a.shell * std::pow(a.diameter, 5) / a.B, 2.4},
                            friction,
                            a.B * 1e-6};
  options.model.free = {true, true, false};
  return options;
}

// A cell that bears a force along one direction, N/m of its rest size, in steps of 10 N/m; across it is free
// or as wide as at rest, as cloth is between its clamps.
class Specimen {
 public:
  Specimen(const RelaxResult& rest, const RelaxOptions& options, bool course, bool held_across)
      : at_(rest),
        options_(options),
        course_(course),
        rest_size_(course ? rest.fabric.width : rest.fabric.height) {
    const double d = rest.fabric.diameter_mm * 1e-3;
    unit_ = (course ? rest.fabric.height : rest.fabric.width) * d * d * d /
            options.model.material.reference_bend_N_m2;
    options_.grow_in = false;
    options_.model.free = {course || !held_across, !course || !held_across, false};
  }
  // The strain there, from the rest size.
  double bear(double force) {
    const int steps = std::max(1, static_cast<int>(std::ceil(std::abs(force - force_) / 10)));
    const double from = force_;
    for (int k = 1; k <= steps; ++k) {
      force_ = from + (force - from) * k / steps;
      options_.model.load = {course_ ? force_ * unit_ : 0, course_ ? 0 : force_ * unit_, 0};
      options_.history = at_.history;
      at_ = relax(at_.fabric, options_);
      unsettled_ += !at_.converged;
    }
    return (course_ ? at_.fabric.width : at_.fabric.height) / rest_size_ - 1;
  }
  int unsettled() const { return unsettled_; }

 private:
  RelaxResult at_;
  RelaxOptions options_;
  bool course_;
  double rest_size_, unit_ = 0, force_ = 0;
  int unsettled_ = 0;
};

struct Yarn {
  double friction, set;  // set: where it came to rest
};

// First pull: from rest. Second pull, as measured: pulled to 200 N/m once, let go, and pulled again; strain
// from where the second pull begins. Clamped specimens lie between free and held across.
void print_pulls(const Acrylic& a, Yarn yarn) {
  RelaxOptions options = acrylic_yarn(a, yarn.friction);
  options.set = yarn.set;
  const RelaxResult rest = rested(cell_of(a.courses, a.loop, a.diameter, 24), options);
  const Spacing k = spacing(rest.fabric);
  std::printf(
      "  %s of %.2f mm, friction %.2f, set %.1f: %.3f x %.3f mm a loop, yarn stretched by %.2f %%%s\n",
      a.name, a.loop, yarn.friction, yarn.set, a.diameter * rest.fabric.width / rest.fabric.wales,
      a.diameter * rest.fabric.height / rest.fabric.courses, 100 * (k.loop_length * a.diameter / a.loop - 1),
      rest.converged ? "" : ", NOT AT REST");
  if (!rest.converged) return;
  const auto known = [](double measured) {
    char text[16] = "     -";
    if (std::isfinite(measured)) std::snprintf(text, sizeof text, "%6.3f", measured);
    return std::string(text);
  };
  const auto off = [](double strain, double measured) {
    char text[16] = "         ";
    if (std::isfinite(measured)) std::snprintf(text, sizeof text, "%+6.1f %%", 100 * (strain / measured - 1));
    return std::string(text);
  };
  for (const bool course : {true, false})
    for (const bool held : {false, true}) {
      Specimen cloth(rest, options, course, held);
      const double measured = course ? a.course_strain : a.wale_strain, first = cloth.bear(100);
      cloth.bear(200);
      const double begin = cloth.bear(0), second = (1 + cloth.bear(100)) / (1 + begin) - 1;
      std::printf("    %-7s %s   %s   %6.3f  %s   %6.3f  %s   %+.3f%s\n", course ? "courses" : "wales",
                  held ? "held" : "free", known(measured).c_str(), first, off(first, measured).c_str(),
                  second, off(second, measured).c_str(), begin,
                  cloth.unsettled() > 0 ? "  some points not at rest" : "");
      std::fflush(stdout);
    }
}

void print_acrylic_heading(const char* yarn) {
  std::printf(
      "acrylic fabrics%s: strain at 0.1 N/mm (100 N/m), measured and here: in the first pull from rest, and\n"
      "in the second after one to 0.2 N/mm, counted from where it begins (how far that is from rest)\n",
      yarn);
  std::printf("    along   across  measured  first      off   second      off   begins at\n");
}

void print_acrylic() {
  print_acrylic_heading("");
  for (const Acrylic& a : acrylics)
    for (const Yarn yarn : {Yarn{0, 0}, Yarn{0.25, 0}, Yarn{0.25, 0.5}, Yarn{0.25, 0.8}})
      print_pulls(a, yarn);
  std::printf("\n");
}

void print_acrylic_77_tex() {
  print_acrylic_heading(", 77 tex");
  for (const double core : cores_77_tex) {
    std::printf("  core %.2f mm\n", core);
    for (const Acrylic& a : {of_77_tex("plain", "g", core), of_77_tex("garter", "g\ne", core),
                             of_77_tex("rib", "ge", core), of_77_tex("seed", "ge\neg", core)})
      for (const Yarn yarn : {Yarn{0.25, 0}, Yarn{0.25, 0.5}}) print_pulls(a, yarn);
  }
  std::printf("\n");
}

// Their simulated plain: nominal force in N/m over strain, and its size at rest, 2.80 x 2.12 mm. The run that
// these were read from has a core of 0.60 mm, their data of the yarn say 0.65 mm.
void print_simulated_acrylic() {
  const std::vector<double> cs{.12, .22, .31, .41, .50, .60}, cf{20, 33, 46, 62, 82, 107},
      ws{.038, .080, .123, .165, .208, .250}, wf{15, 28, 43, 63, 98, 160};
  Plot plot{"Plain of soft acrylic, no friction", "strain", "force, N/m", {}};
  struct Case {
    double core, segments;
    bool drawn;
  };
  for (const Case& c : {Case{0.60, 12, false}, {0.60, 24, true}, {0.60, 48, false}, {0.65, 24, true}}) {
    Acrylic yarn = acrylics[0];
    yarn.core = c.core;
    const RelaxOptions options = acrylic_yarn(yarn, 0);
    const RelaxResult rest = rested(cell_of("g", 11.28, 1.48, c.segments), options);
    std::printf(
        "soft-shell plain of Singal and others, frictionless, core %.2f mm, %.0f segments a loop: "
        "%.3f x %.3f mm (2.80 x 2.12)\n",
        c.core, c.segments, rest.fabric.width * 1.48 / rest.fabric.wales,
        rest.fabric.height * 1.48 / rest.fabric.courses);
    for (const bool course : {true, false}) {
      StretchTest test;
      test.direction = course ? StretchDirection::course : StretchDirection::wale;
      test.turning_points = {course ? 0.62 : 0.26};
      Curve curve;
      for (const StretchPoint& p : stretch(rest, options, test).points)
        curve.add(course ? p.course_strain : p.wale_strain, course ? p.course_force : p.wale_force, 0);
      const auto &s = course ? cs : ws, &f = course ? cf : wf;
      std::printf("  %s", course ? "courses" : "wales  ");
      for (std::size_t k = 0; k < s.size(); ++k) {
        const double here = curve.at(curve.strain, curve.stress, s[k]);
        std::printf("  %.3f: %.1f (%.0f, %+.0f %%)", s[k], here, f[k], 100 * (here / f[k] - 1));
      }
      std::printf("\n");
      if (!c.drawn) continue;
      const std::string along = course ? "along the courses, core " : "along the wales, core ";
      plot.curves.push_back(
          {along + (c.core < 0.62 ? "0.60 mm" : "0.65 mm"), curve.strain, curve.stress, false});
      if (c.core < 0.62) plot.curves.push_back({course ? "theirs, courses" : "theirs, wales", s, f, true});
    }
  }
  write_plot_svg("docs/pictures/validation_acrylic.svg", plot);
  std::printf("\n");
}

// Loaded, unloaded, loaded and unloaded: the second cycle counts.
void print_hysteresis() {
  std::printf("plain along the courses to 0.2: work given back over work done, second cycle\n");
  struct Case {
    bool acrylic;
    double friction, step;
  };
  std::vector<Case> cases;
  for (const bool acrylic : {true, false}) {
    for (const double friction : {0.0, 0.1, 0.25, 0.4}) cases.push_back({acrylic, friction, 0.01});
    for (const double step : {0.02, 0.005, 0.0025}) cases.push_back({acrylic, 0.25, step});
  }
  for (const Case& c : cases) {
    const RelaxOptions options = c.acrylic ? acrylic_yarn(acrylics[0], c.friction) : hard_yarn(c.friction);
    const RelaxResult rest =
        rested(c.acrylic ? cell_of("g", 11.28, 1.48, 24) : cell_of("g", 17, 1, 24), options);
    StretchTest test;
    test.turning_points = {0.2, 0, 0.2, 0};
    test.largest_step = c.step;
    const auto points = stretch(rest, options, test).points;
    const std::size_t quarter = (points.size() - 1) / 4;
    double done = 0, back = 0;
    int unsettled = 0;
    for (std::size_t k = 2 * quarter + 1; k < points.size(); ++k) {
      const double work = 0.5 * (points[k].course_force + points[k - 1].course_force) *
                          (points[k].course_strain - points[k - 1].course_strain);
      (k <= 3 * quarter ? done : back) += k <= 3 * quarter ? work : -work;
      unsettled += !points[k].converged;
    }
    std::printf(
        "  %s, friction %.2f, strain steps of %.4f: %.3f (%d points not at rest), force at 0.2 %.4g N/m\n",
        c.acrylic ? "soft acrylic, l/d 7.6" : "hard yarn, l/d 17", c.friction, c.step, back / done, unsettled,
        points[3 * quarter].course_force);
  }
  std::printf("\n");
}

// Cotton Ne 30, 19.7 tex, loops of 2.8 mm, shaken with friction.
void print_areal_weight() {
  RelaxOptions options = hard_yarn(0.25);
  options.model.material.contact.core = 0.85;
  const RelaxResult rest = rested(cell_of("g", 2.8, 0.16, 24), options);
  const Spacing k = spacing(shaken(rest, options, 1.1).fabric);
  std::printf("plain of cotton Ne 30, loops of 2.8 mm: Ks %.2f, %.1f g/m^2 (162)\n", k.Kc * k.Kw,
              k.Kc * k.Kw * 19.7e-3 / 2.8e-3);
}

}  // namespace
}  // namespace loopwright

int main(int count, char** words) {
  using namespace loopwright;
  const struct {
    const char* name;
    void (*print)();
  } parts[] = {{"tightness", print_tightness},     {"curves", [] { print_curves(0.12, true); }},
               {"corrugation", print_corrugation}, {"scaling", print_scaling},
               {"shaken", print_shaken},           {"simulated", print_simulated_acrylic},
               {"acrylic", print_acrylic},         {"acrylic77", print_acrylic_77_tex},
               {"hysteresis", print_hysteresis},   {"weight", print_areal_weight}};
  for (const auto& part : parts)
    if (count < 2 || std::string(words[1]) == part.name) part.print();
}
