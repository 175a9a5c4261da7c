#include "homogenise.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <stdexcept>
#include <utility>

namespace loopwright {
namespace {

bool is_whole(const StretchPoint& point) {
  return point.interlacings_intact == point.interlacings && point.pass_throughs == 0;
}

using Going = std::function<bool()>;

Pull pulled(const RelaxResult& rest, const RelaxOptions& options, StretchDirection direction, double to,
            double step, const Going& going) {
  StretchTest test;
  test.direction = direction;
  test.turning_points = {to};
  test.largest_step = std::min(step, to / 4);  // the law has three constants
  const StretchResult result = stretch(rest, options, test, [&](const auto&) { return going(); });
  Pull pull;
  for (const StretchPoint& p : result.points) {
    const bool course = direction == StretchDirection::course;
    pull.strain.push_back(course ? p.course_strain : p.wale_strain);
    pull.across.push_back(course ? p.wale_strain : p.course_strain);
    pull.force.push_back(course ? p.course_force : p.wale_force);
    pull.whole = pull.whole && is_whole(p);
  }
  pull.stopped = result.stopped;
  if (!pull.stopped) pull.law = fit_pull(pull.strain, pull.force);
  return pull;
}

// Cells with yarns that do not close along their courses have none.
std::optional<CurlMoment> moment_in_newtons(const Fabric& cell, const RelaxOptions& options) {
  const double unit = force_unit_N(options.model.material, cell.diameter_mm);
  try {
    const CurlMoment moment = curl_moment(cell, options.model);
    return CurlMoment{unit * moment.course, unit * moment.wale};
  } catch (const std::invalid_argument&) {
    return std::nullopt;
  }
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

JsonObject json_of(const SharedLockingLaw& law) {
  return {{"Cxx_N_m", law.Cxx},
          {"Cyy_N_m", law.Cyy},
          {"Cxy_N_m", law.Cxy},
          {"beta_N_m", law.beta},
          {"alpha", law.alpha},
          {"r", law.r},
          {"course_error", json_of(law.course)},
          {"wale_error", json_of(law.wale)}};
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

}  // namespace

std::vector<double> with_zero(std::vector<double> strains) {
  strains.push_back(0);
  std::sort(strains.begin(), strains.end());
  strains.erase(std::unique(strains.begin(), strains.end()), strains.end());
  return strains;
}

RelaxResult elastic_rest_of(const Piece& piece, const HomogeniseProgress& on_progress) {
  RelaxOptions options = piece.options;
  options.on_progress = [&on_progress](const RelaxProgress& progress) {
    std::ostringstream note;
    note << progress.phase << ", step " << progress.newton_iterations;
    return !on_progress || on_progress("relaxing", 0.5 * progress.radius, note.str());
  };
  return elastic_rest(piece.state.fabric, options);
}

Homogenised homogenise(const RelaxResult& rest, const Piece& piece, const HomogeniseRequest& request,
                       const HomogeniseProgress& on_progress) {
  bool stopped = false;
  double share = 0;
  const char* what = "pulling";
  const Going going = [&] {
    stopped = stopped || (on_progress && !on_progress(what, share, {}));
    return !stopped;
  };
  RelaxOptions options = piece.options;
  options.on_progress = [&going](const RelaxProgress&) { return going(); };
  Homogenised all;
  all.stiffness = membrane_stiffness(rest, options);
  const double step = request.grid.largest_step;
  all.course = pulled(rest, options, StretchDirection::course, request.course_pull, step, going);
  share = 0.5;
  all.wale = pulled(rest, options, StretchDirection::wale, request.wale_pull, step, going);
  if (request.with_grid && !stopped) {
    what = "straining";
    const std::size_t wanted =
        request.grid.course.size() * request.grid.wale.size() * request.grid.shear.size();
    std::size_t done = 0;
    share = 0;
    all.points = strain_grid(rest, options, request.grid, [&](const StretchPoint&) {
      share = static_cast<double>(++done) / static_cast<double>(wanted);
      return going();
    });
  }
  all.stopped = stopped;
  all.whole = all.course.whole && all.wale.whole &&
              std::all_of(all.points.begin(), all.points.end(), [](const auto& p) { return is_whole(p); });
  if (!stopped) all.curl = moment_in_newtons(rest.fabric, options);
  if (!stopped && all.points.size() >= 8) {
    all.law = fit_membrane(all.points);
    all.shared_law = fit_shared_locking(all.points);
  }
  return all;
}

JsonObject results(const Homogenised& homogenised) {
  JsonObject all = json_of(homogenised.stiffness);
  if (homogenised.curl)
    all.emplace_back("curl_moment_N", std::vector<double>{homogenised.curl->course, homogenised.curl->wale});
  else
    all.emplace_back("curl_moment_N", nullptr);
  all.emplace_back("course_pull", json_of(homogenised.course));
  all.emplace_back("wale_pull", json_of(homogenised.wale));
  if (homogenised.law) all.emplace_back("law", json_of(*homogenised.law));
  if (homogenised.shared_law) all.emplace_back("shared_law", json_of(*homogenised.shared_law));
  return all;
}

JsonObject results(const std::vector<Sensitivity>& sensitivities) {
  JsonObject all;
  for (const Sensitivity& s : sensitivities)
    all.emplace_back(name_of(s.quantity), JsonObject{{"width", s.width},
                                                     {"height", s.height},
                                                     {"course_modulus", s.course_modulus},
                                                     {"wale_modulus", s.wale_modulus},
                                                     {"shear_modulus", s.shear_modulus}});
  return all;
}

YarnQuantity yarn_quantity_named(std::string_view name) {
  std::string known;
  for (const YarnQuantity quantity : yarn_quantities) {
    if (name_of(quantity) == name) return quantity;
    known += (known.empty() ? "" : ", ") + name_of(quantity);
  }
  throw std::invalid_argument("there is no quantity '" + std::string(name) + "' of a yarn; there are " +
                              known);
}

}  // namespace loopwright
