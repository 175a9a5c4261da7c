#include "notation/material.hpp"

#include <gmock/gmock.h>

#include "notation_test.hpp"

namespace loopwright {
namespace {

TEST(Materials, AreTheFilesOfDataMaterials) {
  int files = 0;
  for (const auto& entry : std::filesystem::directory_iterator(source_dir() / "data" / "materials")) {
    const std::string text = text_of(entry.path());
    Diagnostics diagnostics(entry.path().filename());
    const Material material = read_material(text, diagnostics);
    EXPECT_EQ(said(diagnostics), "");
    const Material* built_in = find_material(material.name);
    ASSERT_NE(built_in, nullptr) << material.name;
    EXPECT_EQ(built_in->text, text);
    // every value says where it comes from
    std::istringstream lines(text);
    for (std::string line; std::getline(lines, line);) {
      const bool names = line.starts_with("name") || line.starts_with("alias") || line.starts_with(";");
      EXPECT_TRUE(names || line.find(" ; ") != line.npos) << entry.path() << ": " << line;
    }
    ++files;
  }
  EXPECT_EQ(materials().size(), static_cast<std::size_t>(files));
  EXPECT_GE(files, 7);
}

TEST(Materials, HaveWhatMechanicsNeeds) {
  for (const Material& material : materials()) {
    const YarnData& yarn = material.yarn;
    EXPECT_GT(yarn.linear_density_tex.value_or(0), 0) << material.name;
    EXPECT_GT(yarn.bend_stiffness_mN_mm2.value_or(0), 0) << material.name;
    EXPECT_GT(yarn.stretch_stiffness_cN.value_or(0), 0) << material.name;
    EXPECT_GT(yarn.diameter_mm.value_or(0), yarn.core_diameter_mm.value_or(0)) << material.name;
    EXPECT_EQ(yarn.material, material.name);
  }
}

TEST(Materials, UnitsComeOutAsTheFieldsSay) {
  // values of physics literature in SI, by hand: 1.47e-8 N m^2, 68 N, 6e5 N/m^3
  const Material* acrylic = find_material("Acrylic  77 TEX");
  ASSERT_NE(acrylic, nullptr);
  EXPECT_DOUBLE_EQ(acrylic->yarn.bend_stiffness_mN_mm2.value(), 1.47e-8 * 1e9);
  EXPECT_DOUBLE_EQ(acrylic->yarn.stretch_stiffness_cN.value(), 6800);
  EXPECT_DOUBLE_EQ(acrylic->yarn.shell_stiffness.value(), 6e5 * 1e-9);
  EXPECT_EQ(find_material("Tamm Petit 2/30"), find_material("acrylic 2/30 Nm"));
  EXPECT_EQ(find_material("no such yarn"), nullptr);
}

YarnData yarn_of(const std::string& value) {
  Diagnostics diagnostics("yarn");
  YarnData yarn;
  read_yarn(value, {1, 1}, yarn, diagnostics);
  EXPECT_EQ(said(diagnostics), "") << value;
  return yarn;
}

TEST(YarnHeader, KeysOverrideTheMaterial) {
  const YarnData yarn = yarn_of("wool 2/28 Nm friction=0.15, bend-stiffness = 1.2e-8 N m^2  colour=#ff0000");
  EXPECT_EQ(yarn.material, "wool 2/28 Nm");
  EXPECT_EQ(yarn.linear_density_tex, 71);
  EXPECT_EQ(yarn.friction_coefficient, 0.15);
  EXPECT_NEAR(yarn.bend_stiffness_mN_mm2.value(), 12, 1e-12);
  EXPECT_EQ(yarn.colour, "#ff0000");
}

TEST(YarnHeader, CountsBecomeTex) {
  EXPECT_NEAR(yarn_of("linear-density=2/30 Nm").linear_density_tex.value(), 2000.0 / 30, 1e-12);
  EXPECT_NEAR(yarn_of("linear-density=30 Ne").linear_density_tex.value(), 19.685, 1e-3);
  EXPECT_NEAR(yarn_of("linear-density=150 den").linear_density_tex.value(), 150.0 / 9, 1e-12);
  EXPECT_NEAR(yarn_of("linear-density=167 dtex").linear_density_tex.value(), 16.7, 1e-12);
  EXPECT_NEAR(yarn_of("stretch-stiffness=8 N").stretch_stiffness_cN.value(), 800, 1e-9);
  // 1 gf cm^2 = 9.80665e-3 N * 1e-4 m^2
  EXPECT_NEAR(yarn_of("bend-stiffness=0.01 gf cm^2").bend_stiffness_mN_mm2.value(), 9.80665, 1e-9);
  EXPECT_EQ(yarn_of("").material, "");
}

TEST(YarnHeader, LivelinessIsTurnsEitherWay) {
  EXPECT_EQ(yarn_of("liveliness=150 tpm").liveliness_per_m, 150);
  EXPECT_EQ(yarn_of("liveliness=-150 turns/m").liveliness_per_m, -150);
  EXPECT_NEAR(yarn_of("liveliness=2.54 tpi").liveliness_per_m.value(), 100, 1e-12);
  EXPECT_EQ(yarn_of("cotton liveliness=0 tpm").liveliness_per_m, 0);
  EXPECT_EQ(yarn_of("twist-stiffness=3 mN mm^2").twist_stiffness_mN_mm2, 3);
  for (const char* wrong : {"liveliness=150", "liveliness=150 mm", "liveliness=2e5 tpm",
                            "twist-stiffness=0 mN mm^2", "twist-stiffness=-1 mN mm^2"}) {
    Diagnostics diagnostics("yarn");
    YarnData yarn;
    read_yarn(wrong, {1, 1}, yarn, diagnostics);
    EXPECT_FALSE(diagnostics.ok()) << wrong;
  }
}

// Every key as it is written reads back as the same number.
TEST(YarnHeader, IsWrittenAsItIsRead) {
  const YarnData yarn = yarn_of(
      "cotton linear-density=21 tex diameter=0.17 mm core-diameter=0.12 mm bend-stiffness=2.5 mN mm^2 "
      "stretch-stiffness=5000 cN twist-stiffness=0.75 mN mm^2 liveliness=-120 tpm shell-stiffness=0.02 "
      "N/mm^3 "
      "shell-exponent=2.5 friction=0.19 colour=#102030");
  const YarnData back = yarn_of(yarn_value(yarn));
  EXPECT_EQ(back.material, yarn.material);
  EXPECT_EQ(back.linear_density_tex, 21);
  EXPECT_EQ(back.diameter_mm, 0.17);
  EXPECT_EQ(back.core_diameter_mm, 0.12);
  EXPECT_EQ(back.bend_stiffness_mN_mm2, 2.5);
  EXPECT_EQ(back.stretch_stiffness_cN, 5000);
  EXPECT_EQ(back.twist_stiffness_mN_mm2, 0.75);
  EXPECT_EQ(back.liveliness_per_m, -120);
  EXPECT_EQ(back.shell_stiffness, 0.02);
  EXPECT_EQ(back.shell_exponent, 2.5);
  EXPECT_EQ(back.friction_coefficient, 0.19);
  EXPECT_EQ(back.colour, "#102030");
}

TEST(YarnHeader, FreeTextOfKnitoutIsLeftAlone) {
  YarnData yarn;
  yarn.colour = "#123456";
  EXPECT_FALSE(read_yarn_if_known("50-50 Rust", yarn));
  EXPECT_EQ(yarn.colour, "#123456");
  EXPECT_TRUE(read_yarn_if_known("Tamm Petit", yarn));
  EXPECT_EQ(yarn.linear_density_tex, 66.7);
}

}  // namespace
}  // namespace loopwright
