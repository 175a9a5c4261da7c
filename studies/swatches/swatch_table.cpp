#include "swatch_table.hpp"

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <map>
#include <set>
#include <stdexcept>

namespace loopwright {
namespace {

// Fields of a line. Notes hold single quotation marks and commas, so quoting is not relied upon: the columns
// before the notes have neither, and the file name stands after the last comma.
std::vector<std::string> fields_of(std::string line) {
  if (!line.empty() && line.back() == '\r') line.pop_back();
  std::vector<std::string> fields{""};
  for (const char c : line) {
    if (c == ',')
      fields.emplace_back();
    else
      fields.back() += c;
  }
  return fields;
}

double number_in(const std::vector<std::string>& fields, const std::map<std::string, std::size_t>& columns,
                 const std::string& name) {
  const auto found = columns.find(name);
  if (found == columns.end() || found->second >= fields.size()) return NAN;
  const std::string& text = fields[found->second];
  char* end = nullptr;
  const double value = std::strtod(text.c_str(), &end);
  return end == text.c_str() ? NAN : value;
}

}  // namespace

std::vector<MeasuredSwatch> measured_swatches(const std::filesystem::path& folder) {
  std::vector<MeasuredSwatch> swatches;
  std::set<std::string> named;
  std::ifstream table(folder / "swatches.csv");
  std::map<std::string, std::size_t> columns;
  for (std::string line; std::getline(table, line);) {
    const std::vector<std::string> fields = fields_of(line);
    if (columns.empty()) {
      for (std::size_t k = 0; k < fields.size(); ++k) columns[fields[k]] = k;
      continue;
    }
    MeasuredSwatch swatch;
    swatch.file = folder / fields.back();
    swatch.name = swatch.file.stem().string();
    if (!std::filesystem::is_regular_file(swatch.file) || !named.insert(swatch.name).second) continue;
    swatch.width_mm = number_in(fields, columns, "Relaxed Width (mm)");
    swatch.height_mm = number_in(fields, columns, "Relaxed Height (mm)");
    swatch.mass_g = number_in(fields, columns, "Mass (g)");
    swatch.stretched_width_mm = number_in(fields, columns, "Stretched Width (mm)");
    swatch.stretched_height_mm = number_in(fields, columns, "Stretched Height (mm)");
    swatches.push_back(swatch);
  }
  std::vector<std::filesystem::path> others;
  if (std::filesystem::is_directory(folder))
    for (const auto& entry : std::filesystem::directory_iterator(folder)) {
      const std::filesystem::path& path = entry.path();
      if ((path.extension() == ".knitout" || path.extension() == ".k") &&
          named.insert(path.stem().string()).second)
        others.push_back(path);
    }
  std::sort(others.begin(), others.end());
  for (const std::filesystem::path& path : others) {
    MeasuredSwatch swatch;
    swatch.name = path.stem().string();
    swatch.file = path;
    swatches.push_back(swatch);
  }
  if (swatches.empty())
    throw std::runtime_error(folder.string() + ": no knitout programme there; name a folder like knitdb");
  return swatches;
}

}  // namespace loopwright
