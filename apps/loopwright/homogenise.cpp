// loopwright homogenise: a cell as a membrane.
#include "homogenise.hpp"

#include <iostream>
#include <sstream>
#include <stdexcept>

#include "base/parallel.hpp"
#include "elastic_rest.hpp"
#include "interrupt.hpp"
#include "outputs/write_plot_svg.hpp"
#include "progress_bar.hpp"
#include "stretch_table.hpp"

namespace loopwright {
namespace {

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
  HomogeniseRequest request;
  request.grid = {with_zero(command.course), with_zero(command.wale), with_zero(command.shear), command.step};
  request.with_grid = !command.csv.empty() || !command.json.empty();
  request.course_pull = command.course_pull, request.wale_pull = command.wale_pull;
  const std::optional<Piece> piece = read_elastic_piece(command.file, command.piece);
  if (!piece) return exit_error;
  set_thread_count(command.threads);

  const InterruptGuard guard;
  const ElasticRest rest = elastic_rest_of(command.file, *piece);
  if (rest.status != exit_good) return rest.status;
  Homogenised all;
  {
    ProgressBar bar("homogenising");
    all =
        homogenise(rest.relaxed, *piece, request, [&bar](const char* what, double share, const std::string&) {
          bar.show(share, what);
          return !interrupted();
        });
  }
  if (!command.csv.empty()) write_csv(command.csv, table_of(all.points));
  if (all.stopped) {
    std::cerr << command.file << ": stopped; only the points so far are written\n";
    return exit_interrupted;
  }

  if (!command.plot.empty()) write_plot_svg(command.plot, plot_of(command.file, all.course, all.wale));
  if (!command.json.empty()) {
    JsonObject json = results(rest.assessment, rest.relaxed);
    for (auto& [key, value] : results(all)) json.emplace_back(key, std::move(value));
    write_json(command.json, json);
  }
  people(command.csv == "-" ? "-" : command.json)
      << lines_for_people(command.file, rest.assessment.measured, all.stiffness, all.course, all.wale);
  if (!all.whole) {
    std::cerr << command.file << ": error: broken: interlacings are lost under strain: strain it less\n";
    return exit_error;
  }
  return exit_good;
}

}  // namespace loopwright
