// How a part of a swatch gives way to loads in its plane: the size of its cell under each of them, on the way back from
// the pull by hand, which no friction turns round. What a sheet of pattern and border needs (border.py).
#pragma once
#include <filesystem>
#include <vector>

#include "cell_road.hpp"

namespace loopwright {

enum class SwatchPart { pattern, side_border };

struct LoadedCell {
  double course_N_m = 0, wale_N_m = 0, shear_N_m = 0;  // borne by the height and width under the pull by hand
  double width_mm = 0, height_mm = 0, shear = 0;       // of 60 wales and 60 courses; skew over height
  bool converged = false;
};

// The cell under the pull by hand, without load, and under each load: 1 and 3 N/m along the courses and along the wales,
// pulling and pushing, and 1 N/m of shear both ways. Throws std::runtime_error where no repeat is found.
std::vector<LoadedCell> cell_response(const std::filesystem::path& file, SwatchPart part,
                                      const MachineModel& machine);

}  // namespace loopwright
