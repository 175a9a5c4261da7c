// The folder of swatches: which programmes, and what was measured of them.
#pragma once
#include <cmath>
#include <filesystem>
#include <string>
#include <vector>

namespace loopwright {

struct MeasuredSwatch {
  std::string name;            // the programme's file name without its ending
  std::filesystem::path file;  // the programme
  double width_mm = NAN, height_mm = NAN, mass_g = NAN, stretched_width_mm = NAN, stretched_height_mm = NAN;
};

// From swatches.csv in the folder; programmes that it does not name come after it, with nothing measured.
// Throws std::runtime_error if the folder holds no programme.
std::vector<MeasuredSwatch> measured_swatches(const std::filesystem::path& folder);

}  // namespace loopwright
