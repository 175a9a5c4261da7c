// loopwright homogenise: a cell as a membrane.
#include <algorithm>
#include <cmath>
#include <iostream>
#include <sstream>
#include <stdexcept>

#include "base/parallel.hpp"
#include "elastic_rest.hpp"
#include "experiments/curl.hpp"
#include "experiments/membrane.hpp"
#include "experiments/membrane_law.hpp"
#include "interrupt.hpp"
#include "outputs/write_plot_svg.hpp"
#include "progress_bar.hpp"
#include "stretch_table.hpp"

namespace loopwright {
namespace {

std::vector<double> with_zero(std::vector<double> strains) {
  strains.push_back(0);
  std::sort(strains.begin(), strains.end());
  strains.erase(std::unique(strains.begin(), strains.end()), strains.end());
  return strains;
}

struct Pull {
  std::vector<double> strain, force, across;
  PullLaw law;
  bool whole = true, stopped = false;
};

Pull pulled(const RelaxResult& rest, const RelaxOptions& options, StretchDirection direction, double to,
            double step) {
  StretchTest test;
  test.direction = direction;
  test.turning_points = {to};
  test.largest_step = std::min(step, to / 4);  // the law has three constants
  const StretchResult result = stretch(rest, options, test, [](const auto&) { return !interrupted(); });
  Pull pull;
  for (const StretchPoint& p : result.points) {
    const bool course = direction == StretchDirection::course;
    pull.strain.push_back(course ? p.course_strain : p.wale_strain);
    pull.across.push_back(course ? p.wale_strain : p.course_strain);
    pull.force.push_back(course ? p.course_force : p.wale_force);
    pull.whole = pull.whole && p.interlacings_intact == p.interlacings && p.pass_throughs == 0;
  }
  pull.stopped = result.stopped;
  if (!pull.stopped) pull.law = fit_pull(pull.strain, pull.force);
  return pull;
}

JsonObject json_of(const FitError& error) {
  return {{"rms_N_m", error.rms}, {"share_of_rms_force", error.share}, {"worst_N_m", error.worst}};
}

JsonObject json_of(const Pull& pull) {
  return {{"to_strain", pull.strain.back()},  {"Y_N_m", pull.law.Y},
          {"beta_N_m", pull.law.beta},        {"alpha", pull.law.alpha},
          {"error", json_of(pull.law.error)}, {"strain", pull.strain},
          {"strain_across", pull.across},     {"force_N_m", pull.force}};
}

JsonObject json_of(const MembraneLaw& law) {
  return {{"Cxx_N_m", law.Cxx},
          {"Cyy_N_m", law.Cyy},
          {"Cxy_N_m", law.Cxy},
          {"G_N_m", law.G},
          {"beta_x_N_m", law.beta_x},
          {"alpha_x", law.alpha_x},
          {"beta_y_N_m", law.beta_y},
          {"alpha_y", law.alpha_y},
          {"course_error", json_of(law.course)},
          {"wale_error", json_of(law.wale)},
          {"shear_error", json_of(law.shear)}};
}

JsonObject json_of(const MembraneStiffness& s) {
  JsonArray rows;
  for (const auto& row : s.C) rows.emplace_back(std::vector<double>(row.begin(), row.end()));
  return {{"stiffness_N_m", std::move(rows)},
          {"eigenvalues_N_m", std::vector<double>(s.lowest_first.begin(), s.lowest_first.end())},
          {"course_modulus_N_m", s.course_modulus},
          {"wale_modulus_N_m", s.wale_modulus},
          {"shear_modulus_N_m", s.shear_modulus},
          {"course_poisson", s.course_poisson},
          {"wale_poisson", s.wale_poisson}};
}

// Cells with yarns that do not close along their courses have none.
void add_curl_moment(const Fabric& cell, const RelaxOptions& options, JsonObject& all) {
  const double unit =
      options.model.material.reference_bend_N_m2 / std::pow(cell.diameter_mm * 1e-3, 2);  // B/d^2 in N
  try {
    const CurlMoment moment = curl_moment(cell, options.model);
    all.emplace_back("curl_moment_N", std::vector<double>{unit * moment.course, unit * moment.wale});
  } catch (const std::invalid_argument&) {
    all.emplace_back("curl_moment_N", nullptr);
  }
}

Plot plot_of(const std::string& file, const Pull& course, const Pull& wale) {
  Plot plot{file + ", pulled one way", "strain", "force per length, N/m", {}};
  for (const auto& [name, pull] : {std::pair("along the courses", &course), {"along the wales", &wale}}) {
    plot.curves.push_back({name, pull->strain, pull->force, true});
    PlotCurve law{std::string(name) + ", law", {}, {}};
    for (int k = 0; k <= 60; ++k) {
      law.x.push_back(pull->strain.back() * k / 60);
      law.y.push_back(pull->law(law.x.back()));
    }
    plot.curves.push_back(std::move(law));
  }
  return plot;
}

std::string lines_for_people(const std::string& file, const Measurements& measured,
                             const MembraneStiffness& s, const Pull& course, const Pull& wale) {
  std::ostringstream text;
  text.precision(3);
  text << file << ": cell of " << measured.width_mm << " x " << measured.height_mm
       << " mm at rest without friction\n"
       << "  pulled along courses " << s.course_modulus << " N/m, Poisson " << s.course_poisson
       << "; along wales " << s.wale_modulus << " N/m, Poisson " << s.wale_poisson << "; shear "
       << s.shear_modulus << " N/m\n";
  for (const auto& [name, pull] : {std::pair("courses", &course), {"wales", &wale}})
    text << "  law along " << name << " to " << pull->strain.back() << ": Y " << pull->law.Y << ", beta "
         << pull->law.beta << " N/m, alpha " << pull->law.alpha << ", off by " << 100 * pull->law.error.share
         << " %\n";
  if (s.lowest_first[0] < 0)
    text << "  unstable: the cell changes its size by itself (an eigenvalue of the stiffness is "
         << s.lowest_first[0] << " N/m)\n";
  return text.str();
}

}  // namespace

int run(const HomogeniseCommand& command) {
  for (const std::string& file : {command.csv, command.plot, command.json}) require_writable(file);
  if (command.csv == "-" && command.json == "-")
    throw std::invalid_argument("CSV and JSON cannot both go to standard output");
  StrainGrid grid{with_zero(command.course), with_zero(command.wale), with_zero(command.shear), command.step};
  const std::optional<Piece> piece = read_elastic_piece(command.file, command.piece);
  if (!piece) return exit_error;
  set_thread_count(command.threads);

  const InterruptGuard guard;
  const ElasticRest rest = elastic_rest_of(command.file, *piece);
  if (rest.status != exit_good) return rest.status;
  RelaxOptions options = piece->options;
  options.on_progress = [](const RelaxProgress&) { return !interrupted(); };
  const MembraneStiffness stiffness = membrane_stiffness(rest.relaxed, options);
  const Pull course =
      pulled(rest.relaxed, options, StretchDirection::course, command.course_pull, command.step);
  const Pull wale = pulled(rest.relaxed, options, StretchDirection::wale, command.wale_pull, command.step);
  std::vector<StretchPoint> points;
  const bool wants_grid = !command.csv.empty() || !command.json.empty();
  const std::size_t wanted = grid.course.size() * grid.wale.size() * grid.shear.size();
  if (wants_grid && !interrupted()) {
    ProgressBar bar("straining");
    std::size_t done = 0;
    points = strain_grid(rest.relaxed, options, grid, [&](const StretchPoint&) {
      bar.show(static_cast<double>(++done) / static_cast<double>(wanted), "");
      return !interrupted();
    });
  }
  if (!command.csv.empty()) write_csv(command.csv, table_of(points));
  if (interrupted()) {
    std::cerr << command.file << ": stopped; only the points so far are written\n";
    return exit_interrupted;
  }

  if (!command.plot.empty()) write_plot_svg(command.plot, plot_of(command.file, course, wale));
  if (!command.json.empty()) {
    JsonObject all = results(rest.assessment, rest.relaxed);
    for (auto& [key, value] : json_of(stiffness)) all.emplace_back(key, std::move(value));
    add_curl_moment(rest.relaxed.fabric, options, all);
    all.emplace_back("course_pull", json_of(course));
    all.emplace_back("wale_pull", json_of(wale));
    if (points.size() >= 8) all.emplace_back("law", json_of(fit_membrane(points)));
    write_json(command.json, all);
  }
  people(command.csv == "-" ? "-" : command.json)
      << lines_for_people(command.file, rest.assessment.measured, stiffness, course, wale);
  const bool broken = std::any_of(points.begin(), points.end(), [](const StretchPoint& p) {
    return p.interlacings_intact < p.interlacings || p.pass_throughs > 0;
  });
  if (broken || !course.whole || !wale.whole) {
    std::cerr << command.file << ": error: broken: interlacings are lost under strain: strain it less\n";
    return exit_error;
  }
  return exit_good;
}

}  // namespace loopwright
