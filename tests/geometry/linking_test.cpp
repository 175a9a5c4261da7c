// Linking numbers of links whose numbers the theory of knots gives.
#include "geometry/linking.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <functional>
#include <numbers>

#include "geometry/fit_fabric.hpp"

namespace loopwright {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;
constexpr double pi = std::numbers::pi;

// A closed yarn through curve(0 .. 2 pi).
FabricYarn ring(const std::function<Vec3(double)>& curve, int segments = 60) {
  std::vector<Vec3> samples;
  for (int k = 0; k < segments; ++k) samples.push_back(curve(2 * pi * k / segments));
  FabricYarn yarn;
  yarn.periodic = true;
  yarn.control_points = periodic_control_points(samples, {});
  yarn.held.assign(yarn.control_points.size(), 0);
  return yarn;
}

Fabric of(std::vector<FabricYarn> yarns) {
  Fabric fabric;
  fabric.yarns = std::move(yarns);
  return fabric;
}

FabricYarn circle(const Vec3& centre, const Vec3& a, const Vec3& b) {
  return ring([=](double t) { return centre + a * std::cos(t) + b * std::sin(t); });
}

TEST(Linking, hopf_link_is_one_and_its_mirror_image_minus_one) {
  // Gauss' integral is +1 here: seen from +y, the second circle goes up through the first, which runs
  // counter-clockwise seen from +z.
  const FabricYarn flat = circle({0, 0, 0}, {3, 0, 0}, {0, 3, 0});
  const FabricYarn up = circle({3, 0, 0}, {-2, 0, 0}, {0, 0, 2});
  const FabricYarn down = circle({3, 0, 0}, {-2, 0, 0}, {0, 0, -2});
  // `up` passes the disc of `flat` at x = 1 (t = 0) going toward +z, `down` toward -z
  EXPECT_THAT(linking_numbers(of({flat, up})), ElementsAre(LinkedPair{0, 1, 1}));
  EXPECT_THAT(linking_numbers(of({flat, down})), ElementsAre(LinkedPair{0, 1, -1}));
}

TEST(Linking, torus_links_wind_as_often_as_their_numbers_say) {
  for (const int turns : {2, 3, 5}) {
    const auto strand = [turns](double phase) {
      return ring(
          [=](double t) {
            const double around = turns * t + phase, r = 5 + 1.5 * std::cos(around);
            return Vec3{r * std::cos(t), r * std::sin(t), 1.5 * std::sin(around)};
          },
          200);
    };
    const std::vector<LinkedPair> linked = linking_numbers(of({strand(0), strand(pi)}));
    ASSERT_EQ(linked.size(), 1U);
    EXPECT_EQ(std::abs(linked[0].number), turns);
  }
}

TEST(Linking, borromean_rings_hang_together_without_any_pair_that_does) {
  const Fabric fabric = of({circle({0, 0, 0}, {4, 0, 0}, {0, 2, 0}), circle({0, 0, 0}, {0, 4, 0}, {0, 0, 2}),
                            circle({0, 0, 0}, {0, 0, 4}, {2, 0, 0})});
  EXPECT_THAT(linking_numbers(fabric), IsEmpty());
}

TEST(Linking, open_yarns_and_yarns_of_a_lattice_are_left_out) {
  FabricYarn open = circle({0, 0, 0}, {3, 0, 0}, {0, 3, 0});
  open.periodic = false;
  FabricYarn goes_on = circle({3, 0, 0}, {-2, 0, 0}, {0, 0, 2});
  goes_on.shift = {1, 0};
  Fabric fabric = of({open, goes_on, circle({3, 0, 0}, {0, 2, 0}, {0, 0, 2})});
  fabric.periodic = true;
  fabric.width = fabric.height = 10;
  EXPECT_FALSE(is_closed(fabric.yarns[0]));
  EXPECT_FALSE(is_closed(fabric.yarns[1]));
  EXPECT_TRUE(is_closed(fabric.yarns[2]));
  EXPECT_THAT(linking_numbers(fabric), IsEmpty());
}

}  // namespace
}  // namespace loopwright
