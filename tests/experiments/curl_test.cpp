// Curl: curvatures of cloth laid on cylinders, moments of tense yarns, and which way knitted cloth bends.
#include "experiments/curl.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "experiments/rest_hessian.hpp"
#include "mechanics/fabrics.hpp"

namespace loopwright {
namespace {

// Laid round a cylinder of radius 1/curvature whose axis runs along y (course) or x, toward +z if positive.
Fabric bent(Fabric fabric, double course, double wale) {
  for (FabricYarn& yarn : fabric.yarns)
    for (Vec3& p : yarn.control_points) {
      const double k = course != 0 ? course : wale;
      double& along = course != 0 ? p.x : p.y;
      const double radius = 1 / k - p.z, angle = along * k;
      along = radius * std::sin(angle);
      p.z = 1 / k - radius * std::cos(angle);
    }
  return fabric;
}

TEST(Curl, CurvatureOfClothOnCylinders) {
  for (const char* courses : {"g", "ge", "g\ne"}) {
    SCOPED_TRACE(courses);
    const Fabric flat = knitted(courses, "held", "8 wales x 8 courses");
    const Curl none = curl(flat);
    EXPECT_NEAR(none.course, 0, 2e-3);
    EXPECT_NEAR(none.wale, 0, 2e-3);
    EXPECT_EQ(none.loops, 16);
    for (const double k : {0.02, -0.02}) {
      EXPECT_NEAR(curl(bent(flat, k, 0)).course, k, 2e-3);
      EXPECT_NEAR(curl(bent(flat, k, 0)).wale, 0, 2e-3);
      EXPECT_NEAR(curl(bent(flat, 0, k)).wale, k, 2e-3);
      EXPECT_NEAR(curl(bent(flat, 0, k)).course, 0, 2e-3);
    }
  }
  EXPECT_THROW(curl(knitted("g", "held", "4 wales x 4 courses")), std::invalid_argument);
}

// Yarns under a tension T at a height h, s apart: bending toward them slackens them, dW/dkappa = -T h / s.
TEST(CurlMoment, OfTenseYarns) {
  constexpr double h = 0.7, s = 3, strain = 0.01, EA = 500, length = 8;
  FabricYarn yarn = free_yarn(8, length / 8 / (1 + strain), [](int i) { return Vec3{1.0 * i, 0.5, h}; });
  yarn.periodic = true;
  yarn.shift = {1, 0};
  Fabric cell = fabric_of({yarn});
  cell.periodic = true;
  cell.width = length, cell.height = s;
  ModelOptions options = frictionless().model;
  options.material.stretch_stiffness = EA;
  const CurlMoment moment = curl_moment(cell, options);
  EXPECT_NEAR(moment.course, -EA * strain * h / s, 1e-6);
  EXPECT_NEAR(moment.wale, 0, 1e-9);
  std::swap(cell.yarns[0].shift[0], cell.yarns[0].shift[1]);
  EXPECT_THROW(curl_moment(cell, options), std::invalid_argument);
}

// Known of all plain cloth: top and bottom roll to the face, the sides to the back; cloth whose faces are
// alike has no reason to.
TEST(CurlMoment, PlainCurlsAsKnown) {
  const RelaxResult plain = elastic_rest(knitted("g", "periodic", ""), frictionless());
  const CurlMoment moment = curl_moment(plain.fabric, frictionless().model);
  EXPECT_LT(moment.wale, -0.01);
  EXPECT_GT(moment.course, 0.01);
  // knitted on the rear bed, its face is to the back
  const RelaxResult back = elastic_rest(knitted("e", "periodic", ""), frictionless());
  const CurlMoment turned = curl_moment(back.fabric, frictionless().model);
  EXPECT_NEAR(turned.course, -moment.course, 1e-3 * std::abs(moment.course));
  EXPECT_NEAR(turned.wale, -moment.wale, 1e-3 * std::abs(moment.wale));
  for (const char* courses : {"g\ne", "ge\neg"}) {
    SCOPED_TRACE(courses);
    const RelaxResult rest = elastic_rest(knitted(courses, "periodic", ""), frictionless());
    const CurlMoment even = curl_moment(rest.fabric, frictionless().model);
    EXPECT_LT(std::abs(even.course), 0.05 * std::abs(moment.course));
    EXPECT_LT(std::abs(even.wale), 0.05 * std::abs(moment.wale));
  }
}

}  // namespace
}  // namespace loopwright
