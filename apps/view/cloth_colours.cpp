#include "cloth_colours.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>

#include "mechanics/yarn_forces.hpp"
#include "outputs/yarn_scene.hpp"

namespace loopwright {
namespace {

constexpr Rgb chosen_colour{235, 60, 40};

std::string rounded(double value) {
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%.3g", value);
  return text.data();
}

// The scale goes from the 2nd to the 98th part in a hundred, so that a single sharp place does not hide the
// rest.
std::pair<double, double> range_of(std::vector<double> values) {
  std::erase_if(values, [](double v) { return !std::isfinite(v); });
  if (values.empty()) return {0, 1};
  std::sort(values.begin(), values.end());
  const auto at = [&](double share) {
    return values[static_cast<std::size_t>(share * static_cast<double>(values.size() - 1))];
  };
  const double low = at(0.02), high = at(0.98);
  return {low, high > low ? high : low + 1};
}

void colour_by_value(const Fabric& fabric, const std::vector<std::vector<double>>& values, double unit,
                     ClothColours& colours) {
  std::vector<double> all;
  for (const auto& yarn : values) all.insert(all.end(), yarn.begin(), yarn.end());
  const auto [low, high] = range_of(all);
  for (std::size_t y = 0; y < fabric.yarns.size(); ++y)
    for (const double v : values[y])
      colours.segments[y].push_back(
          scale_colour(std::isfinite(v) ? std::clamp((v - low) / (high - low), 0.0, 1.0) : 1));
  colours.scale = true;
  for (int k = 0; k <= 4; ++k)
    colours.legend.push_back({scale_colour(k / 4.0), rounded((low + (high - low) * k / 4) * unit)});
}

// A value per segment of the whole model, parted by yarn.
std::vector<std::vector<double>> by_yarn(const Fabric& fabric, const std::vector<double>& values,
                                         int samples) {
  std::vector<std::vector<double>> parted;
  std::size_t next = 0;
  for (const FabricYarn& yarn : fabric.yarns) {
    parted.emplace_back();
    for (int e = 0; e < yarn.segments(); ++e) {
      double sum = 0;
      for (int k = 0; k < samples; ++k) sum += values[next++];
      parted.back().push_back(sum / samples);
    }
  }
  return parted;
}

struct KindColour {
  Rgb colour;
  const char* name;
};
constexpr std::array<KindColour, 6> kinds{{{{86, 152, 96}, "front stitch"},
                                           {{74, 108, 190}, "rear stitch"},
                                           {{226, 160, 60}, "tuck"},
                                           {{150, 96, 160}, "split"},
                                           {{130, 130, 130}, "cast-on"},
                                           {{215, 208, 196}, "float"}}};

std::size_t kind_of(const LoopSpan& span) {
  switch (span.kind) {
    case LoopKind::tuck:
      return 2;
    case LoopKind::split:
      return 3;
    case LoopKind::cast_on:
      return 4;
    default:
      return span.side == StitchSide::front ? 0 : 1;
  }
}

template <class Colour>
void paint_span(const Fabric& fabric, const LoopSpan& span, ClothColours& colours, const Colour& colour) {
  const int segments = fabric.yarns[static_cast<std::size_t>(span.yarn)].segments();
  auto& of_yarn = colours.segments[static_cast<std::size_t>(span.yarn)];
  for (int e = static_cast<int>(std::floor(span.begin)); e < span.end; ++e) {
    Rgb& rgb = of_yarn[static_cast<std::size_t>((e % segments + segments) % segments)];
    rgb = colour(rgb);
  }
}

void colour_by_kind(const Fabric& fabric, ClothColours& colours) {
  for (std::size_t y = 0; y < fabric.yarns.size(); ++y)
    colours.segments[y].assign(static_cast<std::size_t>(fabric.yarns[y].segments()), kinds[5].colour);
  std::array<bool, kinds.size()> seen{};
  for (const LoopSpan& span : fabric.loops) {
    const std::size_t kind = kind_of(span);
    seen[kind] = true;
    paint_span(fabric, span, colours, [kind](const Rgb&) { return kinds[kind].colour; });
  }
  for (std::size_t k = 0; k < kinds.size(); ++k)
    if (seen[k]) colours.legend.push_back({kinds[k].colour, kinds[k].name});
}

void colour_by_yarn(const Fabric& fabric, ClothColours& colours) {
  for (std::size_t y = 0; y < fabric.yarns.size(); ++y)
    colours.segments[y].assign(static_cast<std::size_t>(fabric.yarns[y].segments()), drawn_colour(fabric, y));
}

}  // namespace

Rgb scale_colour(double share) {
  // a few stations of a scale with even lightness steps, after viridis (van der Walt and Smith, 2015, CC0)
  constexpr std::array<std::array<double, 3>, 6> stations{
      {{68, 1, 84}, {65, 68, 135}, {42, 120, 142}, {34, 168, 132}, {122, 209, 81}, {253, 231, 37}}};
  const double at = std::clamp(share, 0.0, 1.0) * (stations.size() - 1);
  const auto k = std::min(static_cast<std::size_t>(at), stations.size() - 2);
  Rgb rgb{};
  for (std::size_t i = 0; i < 3; ++i)
    rgb[i] = static_cast<std::uint8_t>(
        std::lround(stations[k][i] + (stations[k + 1][i] - stations[k][i]) * (at - static_cast<double>(k))));
  return rgb;
}

std::vector<double> segment_curvature(const Fabric& fabric, const FabricYarn& yarn) {
  std::vector<double> all;
  for (int e = 0; e < yarn.segments(); ++e) {
    // turning of the tangent over the segment's length, from four chords
    double turned = 0, length = 0;
    Vec3 before = position(fabric, yarn, e), last;
    for (int k = 1; k <= 4; ++k) {
      const Vec3 here = position(fabric, yarn, e + k / 4.0), chord = here - before;
      if (k > 1) turned += std::atan2(norm(cross(last, chord)), dot(last, chord));
      length += norm(chord);
      last = chord, before = here;
    }
    all.push_back(length > 0 ? turned / (0.75 * length) : 0);
  }
  return all;
}

ClothColours cloth_colours(const Fabric& fabric, const ModelOptions& options, ColourBy by,
                           const std::vector<int>& chosen, const std::vector<int>& kin) {
  ClothColours colours;
  colours.segments.resize(fabric.yarns.size());
  const double d = fabric.diameter_mm * 1e-3, bend = options.material.reference_bend_N_m2;
  switch (by) {
    case ColourBy::yarn:
      if (chosen.empty() && kin.empty()) return {};
      colour_by_yarn(fabric, colours);
      break;
    case ColourBy::tension: {
      const YarnForces forces = yarn_forces(fabric, options);
      colours.title = bend > 0 ? "Tension, cN" : "Tension, B/d\u00b2";
      colour_by_value(fabric, by_yarn(fabric, forces.tension, 1), bend > 0 ? bend / (d * d) * 100 : 1,
                      colours);
      break;
    }
    case ColourBy::contact: {
      const YarnForces forces = yarn_forces(fabric, options);
      colours.title = bend > 0 ? "Contact force, N/m" : "Contact force, B/d\u00b3";
      colour_by_value(fabric, by_yarn(fabric, forces.contact, forces.samples),
                      bend > 0 ? bend / (d * d * d) : 1, colours);
      break;
    }
    case ColourBy::curvature: {
      std::vector<std::vector<double>> values;
      for (const FabricYarn& yarn : fabric.yarns) values.push_back(segment_curvature(fabric, yarn));
      colours.title = "Curvature, 1/mm";
      colour_by_value(fabric, values, 1 / fabric.diameter_mm, colours);
      break;
    }
    case ColourBy::loop_kind:
      colour_by_kind(fabric, colours);
      break;
  }
  // what is chosen stands out from any colouring
  for (const int i : kin)
    paint_span(fabric, fabric.loops[static_cast<std::size_t>(i)], colours, [](const Rgb& was) {
      Rgb mixed{};
      for (std::size_t k = 0; k < 3; ++k)
        mixed[k] = static_cast<std::uint8_t>((was[k] * 3 + chosen_colour[k] * 2) / 5);
      return mixed;
    });
  for (const int i : chosen)
    paint_span(fabric, fabric.loops[static_cast<std::size_t>(i)], colours,
               [](const Rgb&) { return chosen_colour; });
  return colours;
}

}  // namespace loopwright
