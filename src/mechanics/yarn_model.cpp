#include "mechanics/yarn_model.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>
#include "mechanics/binding_space.hpp"

namespace loopwright {
namespace {

void require(bool holds, const std::string& message) {
  if (!holds) throw std::invalid_argument(message);
}

void check_material(const YarnMaterial& m) {
  const auto positive = [](double v) { return std::isfinite(v) && v > 0; };
  require(positive(m.stretch_stiffness), "stretch stiffness must be a positive number");
  require(positive(m.bend_stiffness), "bend stiffness must be a positive number");
  require(std::isfinite(m.twist_stiffness) && m.twist_stiffness >= 0,
          "twist stiffness must be a number, 0 or more");
  require(positive(m.contact.outer) && std::isfinite(m.contact.core) && m.contact.core < m.contact.outer,
          "the outer diameter must be positive and the contact core thinner than it");
  require(positive(m.contact.stiffness), "contact stiffness must be a positive number");
  require(std::isfinite(m.friction) && m.friction >= 0 && m.friction <= 5,
          "the friction coefficient must be from 0 to 5");
  require(std::isfinite(m.contact.exponent) && m.contact.exponent > 1,
          "the contact exponent must be above 1");
}

void check_yarn(const Fabric& fabric, const FabricYarn& yarn) {
  require(yarn.segments() >= 1, "a yarn needs at least 4 control points (periodic: at least 1)");
  require(!yarn.periodic || yarn.control_points.size() >= 4,
          "a periodic yarn needs at least 4 control points");
  require(!yarn.periodic || fabric.periodic || yarn.shift == std::array<int, 2>{0, 0},
          "a periodic yarn in a fabric that is not periodic");
  require(std::isfinite(yarn.segment_rest_length) && yarn.segment_rest_length > 0,
          "the rest length of a yarn must be a positive number");
  require(std::isfinite(yarn.diameter) && yarn.diameter > 0,
          "the diameter of a yarn must be a positive number");
  require(std::isfinite(yarn.liveliness), "the liveliness of a yarn must be a finite number");
  for (const Vec3& p : yarn.control_points) require(is_finite(p), "a control point is not a finite number");
  require(yarn.natural_curvature.empty() ||
              yarn.natural_curvature.size() == static_cast<std::size_t>(yarn.segments()),
          "natural curvature must be given for every segment of a yarn or for none");
  for (const std::array<double, 4>& segment : yarn.natural_curvature)
    for (const double kappa : segment)
      require(std::isfinite(kappa) && kappa >= 0, "a natural curvature must be a number, 0 or more");
}

}  // namespace

YarnModel build_yarn_model(const Fabric& fabric, const ModelOptions& options) {
  check_material(options.material);
  require(!fabric.yarns.empty(), "the fabric has no yarn");
  require(std::isfinite(fabric.width) && std::isfinite(fabric.height) && std::isfinite(fabric.skew),
          "the fabric's width, height or skew is not a finite number");
  require(!fabric.periodic || (fabric.width > 0 && fabric.height > 0),
          "a periodic cell needs a positive width and height");
  require(std::isfinite(options.sample_spacing) && options.sample_spacing > 0,
          "the contact sample spacing must be positive");

  require(std::isfinite(options.plates.stiffness) && options.plates.stiffness >= 0 &&
              (options.plates.stiffness == 0 || options.plates.low < options.plates.high),
          "plates need a stiffness of 0 or more, and the low one below the high one");

  YarnModel model;
  model.periodic = fabric.periodic;
  model.free = options.free;
  model.plates = options.plates;
  model.load = options.load;
  model.contact = options.material.contact;
  model.friction = options.material.friction;
  std::vector<int> loops_of(fabric.yarns.size(), 0);
  for (const LoopSpan& span : fabric.loops) ++loops_of[static_cast<std::size_t>(span.yarn)];
  double longest_segment = 0;
  for (const FabricYarn& yarn : fabric.yarns) {
    check_yarn(fabric, yarn);
    const double area = yarn.diameter * yarn.diameter;
    YarnModel::Yarn y;
    y.first_node = model.nodes;
    y.nodes = static_cast<int>(yarn.control_points.size());
    y.first_segment = model.segments;
    y.segments = yarn.segments();
    y.first_extended = model.extended;
    y.periodic = yarn.periodic;
    y.shift = yarn.shift;
    y.rest_length = yarn.segment_rest_length;
    y.diameter = yarn.diameter;
    // Yarns of one fibre: stretch stiffness grows with the section, and so does the bend stiffness of spun
    // yarn whose fibres slide (physics of B_min ~ linear density).
    y.stretch_stiffness = options.material.stretch_stiffness * area;
    y.bend_stiffness = options.material.bend_stiffness * area;
    y.twist_stiffness = options.material.twist_stiffness * area;
    y.liveliness = yarn.liveliness;
    if (const int loops = loops_of[model.yarns.size()]; loops > 0)
      y.segments_per_loop = std::max(1, y.segments / loops);
    longest_segment = std::max(longest_segment, y.rest_length);

    const int ghosts = yarn.periodic ? 3 : 0;
    for (int i = 0; i < y.nodes + ghosts; ++i) {
      const int turn = i / y.nodes;
      model.base.push_back(y.first_node + i % y.nodes);
      model.image.push_back(
          {static_cast<std::int8_t>(turn * yarn.shift[0]), static_cast<std::int8_t>(turn * yarn.shift[1])});
    }
    for (int e = 0; e < y.segments; ++e) {
      model.first.push_back(y.first_extended + e);
      model.yarn_of_segment.push_back(static_cast<std::int32_t>(model.yarns.size()));
      model.natural_length.push_back(y.rest_length);
    }
    if (!yarn.natural_curvature.empty()) {
      model.natural_curvature.resize(static_cast<std::size_t>(y.first_segment));  // straight ones before it
      model.natural_curvature.insert(model.natural_curvature.end(), yarn.natural_curvature.begin(),
                                     yarn.natural_curvature.end());
    }
    for (int i = 0; i < y.nodes; ++i)
      model.held.push_back(i < static_cast<int>(yarn.held.size()) ? yarn.held[static_cast<std::size_t>(i)]
                                                                  : std::uint8_t{0});
    model.nodes += y.nodes;
    model.segments += y.segments;
    model.extended += y.nodes + ghosts;
    model.yarns.push_back(y);
  }
  if (!model.natural_curvature.empty())
    model.natural_curvature.resize(static_cast<std::size_t>(model.segments));
  model.samples = std::max(2, static_cast<int>(std::ceil(longest_segment / options.sample_spacing - 1e-9)));
  require(model.samples <= most_contact_samples,
          "segments of " + std::to_string(longest_segment) + " d are too long for contact samples every " +
              std::to_string(options.sample_spacing) + " d; use more segments per loop");
  model.weights = sample_weights(model.samples);
  model.binding_points = binding_space(fabric);

  model.point_loads = options.point_loads;
  require(model.point_loads.empty() || model.point_loads.size() == model.held.size(),
          "loads must be given for every control point or for none");
  for (const Vec3& f : model.point_loads) require(is_finite(f), "a load is not a finite number");
  return model;
}

YarnState build_yarn_state(const Fabric& fabric) {
  YarnState state;
  for (const FabricYarn& yarn : fabric.yarns)
    state.nodes.insert(state.nodes.end(), yarn.control_points.begin(), yarn.control_points.end());
  state.width = fabric.width;
  state.height = fabric.height;
  state.skew = fabric.skew;
  return state;
}

Fabric with_state(const Fabric& fabric, const YarnState& state) {
  Fabric moved = fabric;
  auto next = state.nodes.begin();
  for (FabricYarn& yarn : moved.yarns) {
    const auto count = static_cast<std::ptrdiff_t>(yarn.control_points.size());
    std::copy(next, next + count, yarn.control_points.begin());
    next += count;
  }
  moved.width = state.width;
  moved.height = state.height;
  moved.skew = state.skew;
  return moved;
}

}  // namespace loopwright
