// The size of a swatch within a second: a net of springs, one along the course and one along the wale for
// every loop, whose lengths come from periodic cells of the faces (front or rear stitch) around the loop.
#pragma once
#include <array>
#include <filesystem>
#include <map>
#include <string>

#include "cell_road.hpp"

namespace loopwright {

// Faces of four wales by two courses, course by course from below: bit k is wale k % 4 of course k / 4, set
// for a rear stitch.
using FacePattern = unsigned;
constexpr int pattern_wales = 4, pattern_courses = 2;
// One pattern of all that are the same cloth: shifted, seen from behind, mirrored.
FacePattern representative(FacePattern pattern);

struct LoopSize {
  double wale_mm = 0, course_mm = 0;  // spacings at rest
  bool converged = false;
};
using LoopSizes = std::map<FacePattern, LoopSize>;  // by representative

// Knits and relaxes a cell of every pattern (22 of them).
LoopSizes relax_face_cells(const MachineModel& machine);
void write_loop_sizes(const std::filesystem::path& path, const LoopSizes& sizes);
LoopSizes read_loop_sizes(const std::filesystem::path& path);

// Every loop takes the mean of the cells of all eight patterns that it lies in. All courses share the width
// and all wales the height, as springs of equal stiffness side by side do. What is moved (cables, lace)
// counts as what its loops show. Throws std::invalid_argument for a swatch that is no larger than what is
// measured.
SwatchPrediction predict_by_net(const std::filesystem::path& file, const MachineModel& machine,
                                const LoopSizes& sizes);

}  // namespace loopwright
