// Predicts the size of knitted swatches from their programmes and compares it with what was measured.
//   study_swatches cells TABLE                    relax a cell of every pattern of faces, for the net road
//   study_swatches list FOLDER                    names of the swatches
//   study_swatches predict FOLDER NAME ROWS TABLE one swatch, by its cell and by the net: ROWS/NAME.row
//   study_swatches predict-net (the same)         by the net alone
//   study_swatches collect FOLDER ROWS OUT        all rows: OUT/results.csv, details.csv, figures on the
//   screen
//   study_swatches uncertainty FOLDER ROWS OUT N  swatches whose cells have N loops or fewer, with what is
//   not
//                                                 known well at its bounds: OUT/uncertainty.csv
//   study_swatches response FOLDER NAME pattern|border    how its cell, or its border's, gives way to loads: a table
//   study_swatches whole FOLDER NAME STATES       one whole swatch, border and all; what it was like after every
//                                                 stage is kept in STATES, and a second run goes on from there
// studies/swatches/run does all but the last three.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <iostream>
#include <sstream>

#include "base/parallel.hpp"
#include "cell_response.hpp"
#include "net_road.hpp"
#include "outputs/atomic_file.hpp"
#include "outputs/write_plot_svg.hpp"
#include "swatch_table.hpp"
#include "whole_road.hpp"

namespace loopwright {
namespace {

// What is kept of a swatch: a name and a number a line.
using Row = std::vector<std::pair<std::string, double>>;

Row row_of(const SwatchPrediction& cell, const SwatchPrediction& net) {
  return {{"width_mm", cell.width_mm},
          {"height_mm", cell.height_mm},
          {"mass_g", cell.mass_g},
          {"stretched_width_mm", cell.stretched_width_mm},
          {"stretched_height_mm", cell.stretched_height_mm},
          {"net_width_mm", net.width_mm},
          {"net_height_mm", net.height_mm},
          {"net_seconds", net.seconds_knit},
          {"cell_wales", cell.cell_wales},
          {"cell_courses", cell.cell_courses},
          {"loops", cell.loops},
          {"newton_iterations", cell.newton_iterations},
          {"pass_throughs", cell.pass_throughs},
          {"interlacings", cell.interlacings},
          {"interlacings_intact", cell.interlacings_intact},
          {"converged", cell.converged ? 1 : 0},
          {"stretched_converged", cell.stretched_converged ? 1 : 0},
          {"seconds_knit", cell.seconds_knit},
          {"seconds_geometry", cell.seconds_geometry},
          {"seconds_relax", cell.seconds_relax},
          {"seconds_stretch", cell.seconds_stretch}};
}

std::map<std::string, double> read_row(const std::filesystem::path& path) {
  std::map<std::string, double> row;
  std::ifstream file(path);
  std::string name;
  double value = 0;
  while (file >> name >> value) row[name] = value;
  return row;
}

const MeasuredSwatch& swatch_named(const std::vector<MeasuredSwatch>& swatches, const std::string& name) {
  const auto found = std::find_if(swatches.begin(), swatches.end(),
                                  [&name](const MeasuredSwatch& s) { return s.name == name; });
  if (found == swatches.end()) throw std::runtime_error("no swatch of that name: " + name);
  return *found;
}

int predict(const std::filesystem::path& folder, const std::string& name, const std::filesystem::path& rows,
            const std::filesystem::path& table, bool with_cell) {
  const auto swatches = measured_swatches(folder);
  const MeasuredSwatch* const found = &swatch_named(swatches, name);
  std::filesystem::create_directories(rows);
  const MachineModel machine;
  const SwatchPrediction net = predict_by_net(found->file, machine, read_loop_sizes(table));
  SwatchWork work;
  work.stretched = true;
  work.state = rows / (name + ".h5");
  SwatchPrediction cell;
  try {
    if (with_cell) {
      cell = predict_by_cell(found->file, work);
    } else {
      cell.trouble = "the cell took too long";
    }
  } catch (const std::exception& error) {
    cell.trouble = error.what();
  }
  // A prediction there must be: where the cell has none, the net's.
  if (!cell.trouble.empty() || !cell.is_certified || !cell.converged) {
    std::cerr << name << ": " << (cell.trouble.empty() ? "the cell did not come to rest whole" : cell.trouble)
              << "; the net's size is taken\n";
    cell.width_mm = net.width_mm, cell.height_mm = net.height_mm, cell.mass_g = net.mass_g;
    cell.converged = cell.stretched_converged = false;
  }
  AtomicFile file(rows / (name + ".row"));
  for (const auto& [key, value] : row_of(cell, net)) file.stream() << key << ' ' << value << '\n';
  file.commit();
  return 0;
}

struct Errors {
  double absolute = 0, signed_sum = 0;
  int count = 0;
  void add(double predicted, double measured) {
    if (!(measured > 0) || !(predicted > 0)) return;
    absolute += std::abs(predicted / measured - 1);
    signed_sum += predicted / measured - 1;
    ++count;
  }
  void print(const char* what) const {
    if (count == 0) return;
    std::printf("%-28s mean absolute error %5.2f %%   mean error %+5.2f %%   of %d swatches\n", what,
                100 * absolute / count, 100 * signed_sum / count, count);
  }
};

void plot(const std::filesystem::path& path, const std::vector<MeasuredSwatch>& swatches,
          const std::map<std::string, std::map<std::string, double>>& rows) {
  PlotCurve width{"width", {}, {}, true}, height{"height", {}, {}, true}, equal{"equal", {}, {}, false};
  double low = 1e9, high = 0;
  for (const MeasuredSwatch& s : swatches) {
    const auto found = rows.find(s.name);
    if (found == rows.end() || !(s.width_mm > 0) || !(s.height_mm > 0)) continue;
    width.x.push_back(s.width_mm), width.y.push_back(found->second.at("width_mm"));
    height.x.push_back(s.height_mm), height.y.push_back(found->second.at("height_mm"));
    low = std::min({low, s.width_mm, s.height_mm}), high = std::max({high, s.width_mm, s.height_mm});
  }
  if (width.x.empty()) return;
  equal.x = equal.y = {low, high};
  write_plot_svg(path, {"Sixty wales by sixty courses, predicted from the programme",
                        "measured, mm",
                        "predicted, mm",
                        {width, height, equal}});
}

int collect(const std::filesystem::path& folder, const std::filesystem::path& rows_folder,
            const std::filesystem::path& out) {
  const auto swatches = measured_swatches(folder);
  std::map<std::string, std::map<std::string, double>> rows;
  for (const MeasuredSwatch& s : swatches) {
    auto row = read_row(rows_folder / (s.name + ".row"));
    if (row.contains("seconds_stretch")) rows[s.name] = std::move(row);
  }
  if (rows.empty()) {
    std::cerr << "no swatch has a result yet: nothing is written\n";
    return 1;
  }
  AtomicFile results(out / "results.csv"), details(out / "details.csv");
  results.stream() << "swatch,measured_width_mm,predicted_width_mm,measured_height_mm,predicted_height_mm,"
                      "measured_mass_g,predicted_mass_g,seconds,converged,interlacings_intact\n";
  details.stream() << "swatch,width_error,height_error,mass_error,measured_stretched_width_mm,"
                      "measured_stretched_height_mm";
  for (const auto& [key, value] : row_of({}, {})) details.stream() << ',' << key;
  details.stream() << '\n';
  Errors width, height, mass, net_width, net_height, stretched_width, stretched_height;
  double seconds = 0;
  std::vector<double> widths, heights;
  const auto known = [](double value) { return value > 0 ? std::to_string(value).substr(0, 6) : ""; };
  for (const MeasuredSwatch& s : swatches) {
    const auto found = rows.find(s.name);
    if (found == rows.end()) continue;
    auto& r = found->second;
    const double took = r["seconds_knit"] + r["seconds_geometry"] + r["seconds_relax"];
    seconds += took;
    char line[400];
    std::snprintf(line, sizeof line, "%s,%s,%.2f,%s,%.2f,%s,%.3f,%.2f,%d,%d\n", s.name.c_str(),
                  known(s.width_mm).c_str(), r["width_mm"], known(s.height_mm).c_str(), r["height_mm"],
                  known(s.mass_g).c_str(), r["mass_g"], took, static_cast<int>(r["converged"]),
                  r["interlacings"] > 0 && r["interlacings"] == r["interlacings_intact"] ? 1 : 0);
    results.stream() << line;
    const auto error = [](double predicted, double measured) {
      return measured > 0 ? std::to_string(predicted / measured - 1) : "";
    };
    details.stream() << s.name << ',' << error(r["width_mm"], s.width_mm) << ','
                     << error(r["height_mm"], s.height_mm) << ',' << error(r["mass_g"], s.mass_g) << ','
                     << known(s.stretched_width_mm) << ',' << known(s.stretched_height_mm);
    for (const auto& [key, value] : row_of({}, {})) details.stream() << ',' << r[key];
    details.stream() << '\n';
    width.add(r["width_mm"], s.width_mm), height.add(r["height_mm"], s.height_mm);
    mass.add(r["mass_g"], s.mass_g);
    net_width.add(r["net_width_mm"], s.width_mm), net_height.add(r["net_height_mm"], s.height_mm);
    if (r["stretched_converged"] > 0) {
      stretched_width.add(r["stretched_width_mm"], s.stretched_width_mm);
      stretched_height.add(r["stretched_height_mm"], s.stretched_height_mm);
    }
    if (s.width_mm > 0) widths.push_back(s.width_mm);
    if (s.height_mm > 0) heights.push_back(s.height_mm);
  }
  results.commit();
  details.commit();
  plot(out / "scatter.svg", swatches, rows);
  width.print("width"), height.print("height"), mass.print("mass");
  net_width.print("width, net road"), net_height.print("height, net road");
  stretched_width.print("stretched width"), stretched_height.print("stretched height");
  const auto median_errors = [](std::vector<double> values, const char* what) {
    if (values.empty()) return;
    std::sort(values.begin(), values.end());
    Errors errors;
    for (const double v : values) errors.add(values[values.size() / 2], v);
    errors.print(what);
  };
  median_errors(widths, "width, always the median");
  median_errors(heights, "height, always the median");
  std::printf("%zu of %zu swatches, %.0f s of work\n", rows.size(), swatches.size(), seconds);
  return rows.size() == swatches.size() ? 0 : 1;
}

// How far a prediction moves with what is not known well: friction from none to no slip, take-down by a
// factor of three, diameters by a twentieth, yarn in a loop by a fiftieth.
struct Variant {
  const char* name;
  MachineModel machine;
};

std::vector<Variant> variants() {
  std::vector<Variant> all{{"as_stated", {}}};
  const auto with = [&all](const char* name, double MachineModel::*member, double value) {
    MachineModel machine;
    machine.*member = value;
    all.push_back({name, machine});
  };
  const MachineModel usual;
  with("frictionless", &MachineModel::friction, 0);
  with("friction_0.15", &MachineModel::friction, 0.15);
  with("friction_0.40", &MachineModel::friction, 0.4);
  with("no_slip", &MachineModel::friction, 5);
  with("take_down_third", &MachineModel::take_down_N, usual.take_down_N / 3);
  with("take_down_thrice", &MachineModel::take_down_N, usual.take_down_N * 3);
  for (const auto& [name, share] : {std::pair{"thinner_yarn", 0.95}, std::pair{"thicker_yarn", 1.05}}) {
    with(name, &MachineModel::diameter_mm, usual.diameter_mm * share);
    all.back().machine.core_diameter_mm *= share;
  }
  with("shorter_loops", &MachineModel::loop_length_mm, usual.loop_length_mm * 0.98);
  with("longer_loops", &MachineModel::loop_length_mm, usual.loop_length_mm * 1.02);
  return all;
}

int uncertainty(const std::filesystem::path& folder, const std::filesystem::path& rows_folder,
                const std::filesystem::path& out, double most_loops) {
  AtomicFile file(out / "uncertainty.csv");
  file.stream() << "swatch,variant,width_mm,height_mm,converged,interlacings_intact\n";
  for (const MeasuredSwatch& s : measured_swatches(folder)) {
    auto row = read_row(rows_folder / (s.name + ".row"));
    if (!row.contains("loops") || row["loops"] == 0 || row["loops"] > most_loops) continue;
    for (const Variant& variant : variants()) {
      SwatchWork work;
      work.machine = variant.machine;
      const SwatchPrediction p = predict_by_cell(s.file, work);
      char line[300];
      std::snprintf(line, sizeof line, "%s,%s,%.2f,%.2f,%d,%d\n", s.name.c_str(), variant.name, p.width_mm,
                    p.height_mm, p.converged ? 1 : 0, p.interlacings_intact == p.interlacings ? 1 : 0);
      file.stream() << line;
      std::cout << line << std::flush;
    }
  }
  file.commit();
  return 0;
}

int response(const std::filesystem::path& folder, const std::string& name, const std::string& part) {
  const auto swatches = measured_swatches(folder);
  const MeasuredSwatch& swatch = swatch_named(swatches, name);
  std::printf("course_N_m,wale_N_m,shear_N_m,width_mm,height_mm,shear,converged\n");
  for (const LoadedCell& c : cell_response(
           swatch.file, part == "border" ? SwatchPart::side_border : SwatchPart::pattern, {}))
    std::printf("%g,%g,%g,%.4f,%.4f,%.5f,%d\n", c.course_N_m, c.wale_N_m, c.shear_N_m, c.width_mm, c.height_mm,
                c.shear, c.converged ? 1 : 0);
  return 0;
}

int whole(const std::filesystem::path& folder, const std::string& name, const std::filesystem::path& states) {
  const auto swatches = measured_swatches(folder);
  const MeasuredSwatch* const found = &swatch_named(swatches, name);
  std::filesystem::create_directories(states);
  std::printf("%s, measured %.1f x %.1f mm\n", name.c_str(), found->width_mm, found->height_mm);
  std::printf("stage         width  height   middle third     steps  interlacings  uncertified  seconds\n");
  WholeWork work;
  work.states = states;
  work.on_progress = [](WholeStage stage, const RelaxProgress& progress) {
    if (progress.newton_iterations % 10 == 0)
      std::fprintf(stderr, "%s: %s, step %d, residual %.2g\n", whole_stage_names[static_cast<std::size_t>(stage)],
                   progress.phase.c_str(), progress.newton_iterations, progress.residual);
  };
  bool all = true;
  work.on_stage = [&all](WholeStage stage, const WholeSize& s) {
    std::printf("%-12s %6.1f  %6.1f  %6.1f x %-6.1f  %6d  %6d/%-6d  %10d  %8.1f%s\n",
                whole_stage_names[static_cast<std::size_t>(stage)], s.width_mm, s.height_mm, s.middle_width_mm,
                s.middle_height_mm, s.newton_iterations, s.interlacings_intact, s.interlacings, s.pass_throughs,
                s.seconds, s.converged ? "" : "  NOT AT REST");
    std::fflush(stdout);
    all = all && s.converged;
  };
  relax_whole(found->file, work);
  return all ? 0 : 1;
}

int run(const std::vector<std::string>& words) {
  if (words.size() == 2 && words[0] == "cells") {
    write_loop_sizes(words[1], relax_face_cells({}));
    return 0;
  }
  if (words.size() == 2 && words[0] == "list") {
    for (const MeasuredSwatch& s : measured_swatches(words[1])) std::cout << s.name << '\n';
    return 0;
  }
  if (words.size() == 5 && (words[0] == "predict" || words[0] == "predict-net")) {
    set_thread_count(1);
    return predict(words[1], words[2], words[3], words[4], words[0] == "predict");
  }
  if (words.size() == 5 && words[0] == "uncertainty") {
    set_thread_count(1);
    return uncertainty(words[1], words[2], words[3], std::stod(words[4]));
  }
  if (words.size() == 4 && words[0] == "response" && (words[3] == "pattern" || words[3] == "border")) {
    set_thread_count(1);
    return response(words[1], words[2], words[3]);
  }
  if (words.size() == 4 && words[0] == "whole") return whole(words[1], words[2], words[3]);
  if (words.size() == 4 && words[0] == "collect") return collect(words[1], words[2], words[3]);
  std::cerr
      << "study_swatches cells TABLE | list FOLDER | predict[-net] FOLDER NAME ROWS TABLE | collect FOLDER "
         "ROWS OUT | uncertainty FOLDER ROWS OUT MOST_LOOPS | response FOLDER NAME pattern|border | whole FOLDER NAME STATES\n";
  return 2;
}

}  // namespace
}  // namespace loopwright

int main(int count, char** words) {
  try {
    return loopwright::run({words + 1, words + count});
  } catch (const std::exception& error) {
    std::cerr << "study_swatches: " << error.what() << '\n';
    return 1;
  }
}
