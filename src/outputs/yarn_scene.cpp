#include "outputs/yarn_scene.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>

#include "outputs/sky.hpp"
#include "outputs/tube_mesh.hpp"

namespace loopwright {
namespace {

// Muted colours that stay apart in lightness too, so that they can be told apart without colour vision.
constexpr std::array<std::array<std::uint8_t, 3>, 8> palette{{{222, 207, 182},
                                                              {62, 88, 122},
                                                              {178, 78, 66},
                                                              {112, 142, 110},
                                                              {226, 170, 86},
                                                              {122, 94, 128},
                                                              {92, 150, 158},
                                                              {92, 84, 78}}};

struct Detail {
  int per_segment, sides;
};

// Rings and sides such that chords stay within a quarter of a pixel of the round tube and of the bent
// centreline.
Detail detail_for(const FabricYarn& yarn, double pixels_per_diameter) {
  const double radius_px = std::max(yarn.diameter * pixels_per_diameter / 2, 0.5);
  const double cosine = std::clamp(1 - 0.25 / radius_px, 0.0, 0.999);
  const int sides = std::clamp(static_cast<int>(std::ceil(std::numbers::pi / std::acos(cosine))), 5, 40);
  // sagitta c^2 kappa / 8 with the curvature of a tight loop, 0.7 / d
  const double chord = std::sqrt(8 * 0.25 / (0.7 * std::max(pixels_per_diameter, 1.0)));
  const double segment = std::max(yarn.segment_rest_length, 1e-3);
  return {std::clamp(static_cast<int>(std::ceil(segment / chord)), 1, 16), sides};
}

std::array<std::int8_t, 4> packed(const Vec3& v) {
  const auto byte = [](double x) {
    return static_cast<std::int8_t>(std::lround(std::clamp(x, -1.0, 1.0) * 127));
  };
  return {byte(v.x), byte(v.y), byte(v.z), 0};
}

// Adds tubes to the scene. Long yarns are cut where the pattern of plies repeats, so that the arc length
// stays small enough for a float.
class TubeBuilder {
 public:
  TubeBuilder(YarnScene& scene, const Sky& sky) : scene_(scene), sky_(sky) {}

  void add(const Fabric& fabric, std::size_t y, Detail detail) {
    const FabricYarn& yarn = fabric.yarns[y];
    const std::vector<TubeRing> rings = tube_rings(fabric, yarn, detail.per_segment);
    sides_ = detail.sides;
    radius_ = yarn.diameter / 2;
    const auto rgb = drawn_colour(fabric, y);
    colour_ = {rgb[0], rgb[1], rgb[2], 255};
    const double length = rings.back().arc;
    // one ply moves to its neighbour's place in this length
    const double pitch = 1 / (scene_.look.plies * std::abs(scene_.look.twist));
    const double whole = std::max(1.0, std::round(length / pitch)) * pitch;
    const double stretch = yarn.periodic && length > 0 ? whole / length : 1;
    repeat_ = yarn.periodic ? whole : 256 * pitch;
    const bool ring_closed = yarn.periodic && yarn.shift == std::array<int, 2>{0, 0};

    double start = 0;
    for (std::size_t k = 0; k < rings.size(); ++k) {
      double arc = rings[k].arc * stretch - start;
      add_ring(rings[k], arc);
      if (k > 0) join_last_rings();
      if (!yarn.periodic && arc > repeat_ && k + 1 < rings.size()) {
        start += repeat_;
        add_ring(rings[k], arc - repeat_);
      }
    }
    if (!ring_closed) {
      add_cap(rings.front(), -rings.front().tangent);
      add_cap(rings.back(), rings.back().tangent);
    }
  }

 private:
  SceneVertex vertex(const TubeRing& ring, const Vec3& out, double turns, double arc) const {
    const Vec3 p = ring.centre + out * radius_ - scene_.centre;
    SceneVertex v;
    v.position = {static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(p.z)};
    v.along = {static_cast<float>(turns), static_cast<float>(arc), static_cast<float>(repeat_)};
    v.normal = packed(out);
    v.tangent = packed(ring.tangent);
    v.colour = colour_;
    return v;
  }

  // sides + 1 vertices: the last has the place of the first and the angle of a full turn
  void add_ring(const TubeRing& ring, double arc) {
    if (scene_.look.occlusion) sky_.gather(ring.centre, near_);
    const auto first = scene_.vertices.size();
    for (int s = 0; s <= sides_; ++s) {
      const double turns = static_cast<double>(s) / sides_, angle = 2 * std::numbers::pi * turns;
      const Vec3 out = ring.normal * std::cos(angle) + ring.binormal * std::sin(angle);
      SceneVertex v = vertex(ring, out, turns, arc);
      if (s == sides_)
        v.colour[3] = scene_.vertices[first].colour[3];
      else if (scene_.look.occlusion)
        v.colour[3] = static_cast<std::uint8_t>(
            std::lround(255 * Sky::open_share(ring.centre + out * radius_, out, near_)));
      scene_.vertices.push_back(v);
    }
  }

  void join_last_rings() {
    const auto n = static_cast<std::uint32_t>(sides_ + 1),
               end = static_cast<std::uint32_t>(scene_.vertices.size());
    const std::uint32_t a = end - 2 * n, c = end - n;
    for (std::uint32_t s = 0; s + 1 < n; ++s)
      scene_.indices.insert(scene_.indices.end(), {a + s, a + s + 1, c + s + 1, a + s, c + s + 1, c + s});
  }

  void add_cap(const TubeRing& ring, const Vec3& outward) {
    const auto base = static_cast<std::uint32_t>(scene_.vertices.size());
    const bool at_end = dot(outward, ring.tangent) > 0;
    for (int s = 0; s < sides_; ++s) {
      const double turns = static_cast<double>(s) / sides_, angle = 2 * std::numbers::pi * turns;
      SceneVertex v = vertex(ring, ring.normal * std::cos(angle) + ring.binormal * std::sin(angle), turns, 0);
      v.normal = packed(outward);
      scene_.vertices.push_back(v);
    }
    for (std::uint32_t s = 1; s + 1 < static_cast<std::uint32_t>(sides_); ++s)
      scene_.indices.insert(scene_.indices.end(),
                            {base, base + s + (at_end ? 0 : 1), base + s + (at_end ? 1 : 0)});
  }

  YarnScene& scene_;
  const Sky& sky_;
  std::vector<SkySample> near_;
  std::array<std::uint8_t, 4> colour_{};
  int sides_ = 0;
  double radius_ = 0, repeat_ = 0;
};

}  // namespace

std::array<int, 2> drawn_repeats(const Fabric& fabric, std::array<int, 2> asked) {
  if (!fabric.periodic) return {1, 1};
  const auto enough = [](int wanted, double per_cell) {
    return wanted > 0 ? wanted : std::max(1, static_cast<int>(std::ceil(6 / std::max(per_cell, 0.5) - 1e-9)));
  };
  return {enough(asked[0], fabric.wales), enough(asked[1], fabric.courses)};
}

Bounds fabric_bounds(const Fabric& fabric, std::array<int, 2> repeats) {
  constexpr double most = std::numeric_limits<double>::max();
  Bounds box{{most, most, most}, {-most, -most, -most}};
  for (const FabricYarn& yarn : fabric.yarns)
    for (const Vec3& p : polyline(fabric, yarn, 4)) {
      if (!is_finite(p))
        throw std::invalid_argument("the fabric has coordinates that are not finite numbers");
      for (int i = 0; i < 3; ++i) {
        box.lower[i] = std::min(box.lower[i], p[i] - yarn.diameter / 2);
        box.upper[i] = std::max(box.upper[i], p[i] + yarn.diameter / 2);
      }
    }
  if (box.lower.x > box.upper.x) throw std::invalid_argument("the fabric has no yarn to draw");
  const Bounds one = box;
  for (const auto& [m, n] :
       {std::pair{repeats[0] - 1, 0}, {0, repeats[1] - 1}, {repeats[0] - 1, repeats[1] - 1}}) {
    const Vec3 shift = fabric.lattice(m, n);
    for (int i = 0; i < 3; ++i) {
      box.lower[i] = std::min(box.lower[i], one.lower[i] + shift[i]);
      box.upper[i] = std::max(box.upper[i], one.upper[i] + shift[i]);
    }
  }
  return box;
}

YarnScene yarn_scene(const Fabric& fabric, const SceneOptions& options) {
  if (options.look.plies < 1 || !(std::abs(options.look.twist) > 1e-3))
    throw std::invalid_argument("a yarn is drawn with 1 ply or more and a twist that is not 0");
  const std::array<int, 2> repeats = drawn_repeats(fabric, options.repeats);
  YarnScene scene;
  scene.look = options.look;
  scene.bounds = fabric_bounds(fabric, repeats);
  scene.centre = scene.bounds.centre();
  for (int n = 0; n < repeats[1]; ++n)
    for (int m = 0; m < repeats[0]; ++m) {
      const Vec3 o = fabric.lattice(m, n);
      scene.offsets.push_back({static_cast<float>(o.x), static_cast<float>(o.y), static_cast<float>(o.z)});
    }
  const Sky sky = options.look.occlusion ? Sky(fabric) : Sky();
  TubeBuilder builder(scene, sky);
  for (std::size_t y = 0; y < fabric.yarns.size(); ++y)
    builder.add(fabric, y, detail_for(fabric.yarns[y], options.pixels_per_diameter));
  return scene;
}

std::array<std::uint8_t, 3> parsed_colour(std::string_view text, std::array<std::uint8_t, 3> otherwise) {
  if (text.size() != 7 || text[0] != '#') return otherwise;
  std::array<std::uint8_t, 3> rgb{};
  for (std::size_t i = 0; i < 6; ++i) {
    const char c = text[i + 1];
    const int digit = c >= '0' && c <= '9'   ? c - '0'
                      : c >= 'a' && c <= 'f' ? c - 'a' + 10
                      : c >= 'A' && c <= 'F' ? c - 'A' + 10
                                             : -1;
    if (digit < 0) return otherwise;
    rgb[i / 2] = static_cast<std::uint8_t>(rgb[i / 2] * 16 + digit);
  }
  return rgb;
}

std::array<std::uint8_t, 3> drawn_colour(const Fabric& fabric, std::size_t yarn) {
  const CarrierId carrier = fabric.yarns[yarn].carrier;
  const std::size_t place = carrier.valid() ? carrier.position() : yarn;
  return parsed_colour(fabric.yarns[yarn].colour, palette[place % palette.size()]);
}

}  // namespace loopwright
