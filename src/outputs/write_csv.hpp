// Tables as CSV (RFC 4180): one header line, then one line a row.
#pragma once
#include <filesystem>
#include <string>
#include <vector>

namespace loopwright {

struct Table {
  std::vector<std::string> columns;       // names with their units, e.g. "strain", "stress_N_m"
  std::vector<std::vector<double>> rows;  // each as long as `columns`
};

// Numbers are printed with the fewest digits that read back to the same bits; NaN is an empty field. The path
// `-` is standard output. Throws FileError, and std::invalid_argument for a row of another length.
void write_csv(const std::filesystem::path& path, const Table& table);

}  // namespace loopwright
