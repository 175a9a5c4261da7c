// loopwright sensitivity: how size and stiffness of a cell depend on the data of its yarn.
#include "experiments/sensitivity.hpp"

#include <algorithm>
#include <charconv>
#include <iomanip>
#include <iostream>
#include <sstream>
#include <stdexcept>

#include "base/parallel.hpp"
#include "elastic_rest.hpp"
#include "homogenise.hpp"
#include "interrupt.hpp"
#include "outputs/atomic_file.hpp"

namespace loopwright {
namespace {

Deviation parsed_deviation(const std::string& text) {
  const std::size_t equals = text.find('=');
  const std::string key = text.substr(0, equals);
  for (const YarnQuantity quantity : yarn_quantities) {
    if (equals == std::string::npos || name_of(quantity) != key) continue;
    double percent = 0;
    const char *begin = text.data() + equals + 1, *end = text.data() + text.size();
    const auto [at, error] = std::from_chars(begin, end, percent);
    const bool whole = at == end || (at + 1 == end && *at == '%');
    if (error == std::errc() && whole && percent >= 0 && percent < 100) return {quantity, percent / 100};
  }
  std::string known;
  for (const YarnQuantity quantity : yarn_quantities)
    known += (known.empty() ? "" : ", ") + name_of(quantity);
  throw std::invalid_argument("a deviation is KEY=PERCENT, from 0 to below 100, not '" + text +
                              "'; KEY is one of " + known);
}

std::string csv_of(const std::vector<Sensitivity>& all) {
  std::ostringstream text;
  text.precision(9);
  text << "quantity,width,height,course_modulus,wale_modulus,shear_modulus\n";
  for (const Sensitivity& s : all)
    text << name_of(s.quantity) << ',' << s.width << ',' << s.height << ',' << s.course_modulus << ','
         << s.wale_modulus << ',' << s.shear_modulus << '\n';
  return text.str();
}

void write_text(const std::string& file, const std::string& text) {
  if (file == "-") {
    std::cout << text;
    return;
  }
  AtomicFile out{std::filesystem::path(file)};
  out.stream() << text;
  out.commit();
}

void print_table(const std::string& file, const std::vector<Sensitivity>& all, std::ostream& out) {
  std::ostringstream text;
  text << file << ": per cent of change by one per cent more of\n"
       << std::fixed << std::setprecision(3) << "  " << std::left << std::setw(20) << "" << std::right;
  for (const char* name : {"width", "height", "course N/m", "wale N/m", "shear N/m"})
    text << std::setw(12) << name;
  for (const Sensitivity& s : all) {
    text << "\n  " << std::left << std::setw(20) << name_of(s.quantity) << std::right;
    for (const double value : {s.width, s.height, s.course_modulus, s.wale_modulus, s.shear_modulus})
      text << std::setw(12) << value;
  }
  out << text.str() << '\n';
}

}  // namespace

int run(const SensitivityCommand& command) {
  for (const std::string& file : {command.csv, command.json}) require_writable(file);
  if (command.csv == "-" && command.json == "-")
    throw std::invalid_argument("CSV and JSON cannot both go to standard output");
  std::vector<Deviation> deviations;
  for (const std::string& text : command.deviations) deviations.push_back(parsed_deviation(text));
  const std::optional<Piece> piece = read_elastic_piece(command.file, command.piece);
  if (!piece) return exit_error;
  set_thread_count(command.threads);

  const InterruptGuard guard;
  const ElasticRest rest = elastic_rest_of(command.file, *piece);
  if (rest.status != exit_good) return rest.status;
  const std::vector<Sensitivity> all = sensitivities(rest.relaxed, piece->options);
  const SizeDeviation size = size_deviation(all, deviations);

  if (!command.csv.empty()) write_text(command.csv, csv_of(all));
  if (!command.json.empty()) {
    JsonObject json = results(rest.assessment, rest.relaxed);
    json.emplace_back("relative_change_per_relative_change", results(all));
    if (!deviations.empty()) {
      json.emplace_back("width_deviation_mm", size.width * rest.assessment.measured.width_mm);
      json.emplace_back("height_deviation_mm", size.height * rest.assessment.measured.height_mm);
    }
    write_json(command.json, json);
  }
  std::ostream& out = people(command.csv == "-" ? "-" : command.json);
  print_table(command.file, all, out);
  if (!deviations.empty()) {
    std::ostringstream line;
    line << std::setprecision(3) << "  standard deviation of width " << 100 * size.width << " %, of height "
         << 100 * size.height << " %\n";
    out << line.str();
  }
  return exit_good;
}

}  // namespace loopwright
