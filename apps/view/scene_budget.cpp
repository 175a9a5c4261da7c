#include "scene_budget.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace loopwright {
namespace {

constexpr double most_vertices = 4e6;  // 150 MB
constexpr double most_vertices_without_gpu = 1.2e6;
constexpr std::size_t most_indices_without_gpu = 3'000'000;
constexpr double most_shaded_vertices = 5e5;  // some microseconds each
constexpr std::size_t most_moving_segments = 40'000;

}  // namespace

std::size_t segments_of(const Fabric& fabric) {
  std::size_t all = 0;
  for (const FabricYarn& yarn : fabric.yarns) all += static_cast<std::size_t>(yarn.segments());
  return all;
}

// The rings and sides of yarn_scene().
double vertices_of(const Fabric& fabric, double pixels_per_diameter) {
  const double chord = std::sqrt(2 / (0.7 * std::max(pixels_per_diameter, 1.0)));
  double all = 0;
  for (const FabricYarn& yarn : fabric.yarns) {
    const double radius = std::max(yarn.diameter * pixels_per_diameter / 2, 0.5);
    const double sides = std::clamp(
        std::ceil(std::numbers::pi / std::acos(std::clamp(1 - 0.25 / radius, 0.0, 0.999))), 5.0, 40.0);
    const double rings = std::clamp(std::ceil(yarn.segment_rest_length / chord), 1.0, 16.0);
    all += yarn.segments() * rings * (sides + 1);
  }
  return all;
}

double affordable_detail(const Fabric& fabric, double wanted, bool without_gpu) {
  const double most = without_gpu ? most_vertices_without_gpu : most_vertices;
  while (wanted > 2 && vertices_of(fabric, wanted) > most) wanted /= std::numbers::sqrt2;
  return wanted;
}

bool affords_occlusion(const Fabric& fabric, double pixels_per_diameter) {
  return vertices_of(fabric, pixels_per_diameter) <= most_shaded_vertices;
}

bool affords_shadows(const YarnScene& scene, bool without_gpu) {
  return !without_gpu || scene.indices.size() * scene.offsets.size() <= most_indices_without_gpu;
}

SparseFabric sparse_fabric(const Fabric& fabric) {
  SparseFabric sparse{fabric, 1};
  const std::size_t segments = segments_of(fabric);
  sparse.every = static_cast<int>(std::clamp((segments + most_moving_segments - 1) / most_moving_segments,
                                             std::size_t{1}, std::size_t{4}));
  if (sparse.every == 1) return sparse;
  for (FabricYarn& yarn : sparse.fabric.yarns) {
    const std::vector<Vec3> all = std::move(yarn.control_points);
    yarn.control_points.clear();
    for (std::size_t i = 0; i < all.size(); i += static_cast<std::size_t>(sparse.every))
      yarn.control_points.push_back(all[i]);
    // an open yarn has a segment, a closed one its least number
    while (yarn.control_points.size() < 6) yarn.control_points.push_back(all.back());
    yarn.held.clear();
    yarn.segment_rest_length = 1e-3;  // a ring a segment
  }
  sparse.fabric.loops.clear();
  return sparse;
}

}  // namespace loopwright
