// CSV (RFC 4180) of all yarns' points, for spreadsheets and scripts.
#pragma once
#include <filesystem>

#include "outputs/export_options.hpp"
#include "outputs/state.hpp"

namespace loopwright {

// One line a point: `yarn`, `x_mm`, `y_mm`, `z_mm`, then the point data of write_vtp() under the same names.
// Fields are empty where a point has no loop. Throws FileError.
void write_points_csv(const std::filesystem::path& path, const State& state,
                      const ExportOptions& options = {});

}  // namespace loopwright
