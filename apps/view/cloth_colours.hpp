// Colours that say something of the yarn: whose it is, how it is pulled, bent or pressed, what loop it is in.
#pragma once
#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "mechanics/yarn_model.hpp"

namespace loopwright {

using Rgb = std::array<std::uint8_t, 3>;

enum class ColourBy : std::uint8_t { yarn, tension, curvature, contact, loop_kind };

struct LegendEntry {
  Rgb colour{};
  std::string text;
};

struct ClothColours {
  std::vector<std::vector<Rgb>> segments;  // by yarn and segment, as SceneOptions::colours
  std::string title;                       // with its unit
  bool scale = false;                      // entries are ends of a colour scale, from low to high
  std::vector<LegendEntry> legend;
};

// `options`: the yarn's data; where they do not say its bend stiffness, forces are in B/d^2. `chosen`:
// indices into Fabric::loops that are marked; `kin`: those that are marked faintly.
ClothColours cloth_colours(const Fabric& fabric, const ModelOptions& options, ColourBy by,
                           const std::vector<int>& chosen = {}, const std::vector<int>& kin = {});

// A colour of the scale (dark blue over green to yellow, of even lightness steps), share from 0 to 1.
Rgb scale_colour(double share);

// Mean curvature of each segment of a yarn, 1/d.
std::vector<double> segment_curvature(const Fabric& fabric, const FabricYarn& yarn);

}  // namespace loopwright
