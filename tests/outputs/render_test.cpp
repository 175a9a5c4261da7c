#include "outputs/render.hpp"

#include <gmock/gmock.h>
#include <png.h>

#include <limits>
#include <optional>

#include "outputs/sky.hpp"
#include "plain_fabric.hpp"
#include "temporary_folder.hpp"

namespace loopwright {
namespace {

// Tests that draw need OpenGL; where there is none they are skipped, and the message is checked instead.
class Render : public test::TemporaryFolder {
 protected:
  void SetUp() override {
    TemporaryFolder::SetUp();
    try {
      HeadlessGl probe;
    } catch (const NoOpenGl& error) {
      EXPECT_THAT(error.what(), ::testing::HasSubstr("libgl1-mesa-dri"));
      GTEST_SKIP() << "This machine gives no OpenGL context: " << error.what();
    }
  }
};

RenderOptions small(View view, int width = 320, int height = 240) {
  RenderOptions options;
  options.view = view;
  options.width = width;
  options.height = height;
  options.style.transparent = true;
  options.look.fuzz = 0;  // hairs would count as yarn
  return options;
}

// Pixels covered by yarn; edges count by their share.
double covered(const Image& image) {
  double sum = 0;
  for (std::size_t i = 3; i < image.pixels.size(); i += 4) sum += image.pixels[i] / 255.0;
  return sum;
}

double lightness(const Image& image, int x, int y) {
  const auto p = image.at(x, y);
  return 0.2126 * p[0] + 0.7152 * p[1] + 0.0722 * p[2];
}

TEST_F(Render, StraightYarnCoversItsProjectedArea) {
  const Fabric fabric = test::straight_yarn(20);
  Camera camera;
  camera.target = {10, 0, 0};
  camera.height = 6;
  for (const auto& [width, height] : {std::pair{1200, 240}, {600, 120}}) {
    RenderOptions options = small(View::front, width, height);
    const Image image = render(fabric, camera, options);
    const double pixels_per_d = height / 6.0;
    EXPECT_NEAR(covered(image), 20 * 1 * pixels_per_d * pixels_per_d,
                0.01 * 20 * pixels_per_d * pixels_per_d);
  }
  // from the end: a disc of area pi/4
  camera.backward = {-1, 0, 0};
  const Image disc = render(fabric, camera, small(View::left, 240, 240));
  EXPECT_NEAR(covered(disc), 3.14159265 / 4 * 40 * 40, 0.012 * 3.14159265 / 4 * 40 * 40);
}

TEST_F(Render, EveryViewShowsTheWholePieceInTheMiddle) {
  const Fabric fabric = test::plain_piece(6, 5, 8);
  for (const View view : {View::front, View::back, View::left, View::top, View::corner}) {
    const Image image = render(fabric, small(view));
    EXPECT_GT(covered(image), view == View::left || view == View::top ? 1500 : 6000);
    // no yarn is cut off by the edge, and it comes near to one
    int left = image.width, right = -1, top = image.height, bottom = -1;
    for (int y = 0; y < image.height; ++y)
      for (int x = 0; x < image.width; ++x)
        if (image.at(x, y)[3] > 0)
          left = std::min(left, x), right = std::max(right, x), top = std::min(top, y),
          bottom = std::max(bottom, y);
    EXPECT_GT(left, 0);
    EXPECT_GT(top, 0);
    EXPECT_LT(right, image.width - 1);
    EXPECT_LT(bottom, image.height - 1);
    EXPECT_TRUE(right - left > 0.75 * image.width || bottom - top > 0.75 * image.height);
  }
}

// The same cloth from the other side: its outline is the mirror image.
TEST_F(Render, BackIsTheMirrorImageOfTheFront) {
  Fabric fabric = test::plain_piece(5, 4, 8);
  fabric.yarns.pop_back();
  fabric.yarns[0].control_points.resize(25);  // something that is not symmetric
  const Image front = render(fabric, small(View::front)), back = render(fabric, small(View::back));
  int differing = 0, yarn = 0, mirrored_differing = 0;
  for (int y = 0; y < front.height; ++y)
    for (int x = 0; x < front.width; ++x) {
      const int a = front.at(x, y)[3], b = back.at(front.width - 1 - x, y)[3], c = back.at(x, y)[3];
      yarn += a > 127 ? 1 : 0;
      differing += std::abs(a - b) > 100 ? 1 : 0;
      mirrored_differing += std::abs(a - c) > 100 ? 1 : 0;
    }
  EXPECT_LT(differing, yarn / 200);
  EXPECT_GT(mirrored_differing, yarn / 20) << "the piece is symmetric, so that this test shows nothing";
}

// Two crossing yarns: the upper one shows its colour at the crossing, from either side.
TEST_F(Render, NearerYarnHidesTheOther) {
  Fabric fabric = test::straight_yarn(10);
  fabric.yarns.push_back(fabric.yarns[0]);
  for (Vec3& q : fabric.yarns[1].control_points) q = {5, q.x - 5, 1.2};
  fabric.yarns[0].colour = "#ff0000";
  fabric.yarns[1].colour = "#0000ff";
  const auto middle = [&](View view) { return render(fabric, small(view)).at(160, 120); };
  EXPECT_GT(middle(View::front)[2], middle(View::front)[0] + 40);
  EXPECT_GT(middle(View::back)[0], middle(View::back)[2] + 40);
}

TEST_F(Render, ShadowFallsAwayFromTheLight) {
  // the light is at the upper left of the viewer: a yarn above another darkens it to the lower right of the
  // crossing
  Fabric fabric = test::straight_yarn(20);
  fabric.yarns.push_back(fabric.yarns[0]);
  for (Vec3& q : fabric.yarns[1].control_points) q = {10, q.x - 10, 1.6};
  Camera camera;
  camera.target = {10, 0, 0};
  camera.height = 8;
  RenderOptions options = small(View::front, 400, 400);
  options.look.occlusion = false;
  const Image with = render(fabric, camera, options);
  options.style.shadows = false;
  const Image without = render(fabric, camera, options);
  // beside the upper yarn, on the lit half of the lower one
  double right = 0, left = 0;
  for (int x = 0; x < 25; ++x)
    for (int y = 184; y < 204; ++y) {
      right += lightness(without, 230 + x, y) - lightness(with, 230 + x, y);
      left += std::abs(lightness(without, 169 - x, y) - lightness(with, 169 - x, y));
    }
  EXPECT_GT(right, 25 * 20 * 20.0);
  EXPECT_LT(left, 0.1 * right);
}

TEST_F(Render, PeriodicCellIsRepeated) {
  const Fabric cell = test::plain_cell(8);
  EXPECT_EQ(drawn_repeats(cell, {0, 0}), (std::array<int, 2>{6, 6}));
  EXPECT_EQ(drawn_repeats(cell, {2, 0}), (std::array<int, 2>{2, 6}));
  EXPECT_EQ(drawn_repeats(test::plain_piece(2, 2), {5, 5}), (std::array<int, 2>{1, 1}));
  Camera camera;
  camera.target = {test::plain_wale_spacing * 1.5 + 2, test::plain_course_spacing, 0};
  camera.height = 14;
  RenderOptions options = small(View::front);
  // a piece of 3 x 3 loops made of cells covers what the same piece made of open yarns covers
  options.repeats = {3, 3};
  const double cells = covered(render(cell, camera, options)),
               piece = covered(render(test::plain_piece(3, 3, 8), camera, options));
  EXPECT_NEAR(cells, piece, 0.008 * piece);  // polygons stand at other angles
}

TEST_F(Render, PicturesAreEqualEachTimeAndHaveABackground) {
  const Fabric fabric = test::plain_piece(4, 4, 8);
  RenderOptions options = small(View::corner);
  options.style.transparent = false;
  const Image a = render(fabric, options), b = render(fabric, options);
  EXPECT_EQ(a.pixels, b.pixels);
  EXPECT_EQ(a.at(0, 0), (std::array<std::uint8_t, 4>{246, 245, 242, 255}));
  for (std::size_t i = 3; i < a.pixels.size(); i += 4) ASSERT_EQ(a.pixels[i], 255);
}

TEST_F(Render, PngReadsBack) {
  const Image image = render(test::plain_piece(3, 3, 8), small(View::front));
  write_png(in_folder("a.png"), image);
  png_image header{};
  header.version = PNG_IMAGE_VERSION;
  ASSERT_NE(png_image_begin_read_from_file(&header, in_folder("a.png").c_str()), 0);
  header.format = PNG_FORMAT_RGBA;
  std::vector<std::uint8_t> pixels(PNG_IMAGE_SIZE(header));
  ASSERT_NE(png_image_finish_read(&header, nullptr, pixels.data(), 0, nullptr), 0);
  EXPECT_EQ(header.width, 320U);
  EXPECT_EQ(pixels, image.pixels);
}

TEST_F(Render, WrongCallsAreRefused) {
  EXPECT_THROW(render(Fabric{}), std::invalid_argument);
  EXPECT_THROW(render(test::straight_yarn(3), small(View::front, 5, 5)), std::invalid_argument);
  Fabric broken = test::plain_piece(2, 2);
  broken.yarns[0].control_points[4].y = std::numeric_limits<double>::infinity();
  EXPECT_THROW(render(broken), std::invalid_argument);
}

TEST(Camera, FrontLooksAtTheFaceWithWalesUp) {
  const Bounds box{{0, 0, -1}, {30, 20, 1}};
  const Camera front = fitted_camera(View::front, box, 4.0 / 3),
               back = fitted_camera(View::back, box, 4.0 / 3);
  EXPECT_LT(distance(front.right(), {1, 0, 0}), 1e-12);
  EXPECT_LT(distance(back.right(), {-1, 0, 0}), 1e-12);
  EXPECT_LT(distance(fitted_camera(View::left, box, 1).right(), {0, 0, 1}), 1e-12);
  EXPECT_NEAR(front.height, 30.0 / (4.0 / 3) * 1.06, 1e-9);
  EXPECT_EQ(view_named("corner"), View::corner);
  EXPECT_EQ(view_named("below"), std::nullopt);
}

TEST(Camera, PerspectiveAndOrthographicAgreeAtTheTarget) {
  Camera camera;
  camera.target = {1, 2, 3};
  camera.height = 8;
  const auto clip_y = [&](double fov) {
    camera.field_of_view_deg = fov;
    const Matrix4 m = camera.projection(1.5) * camera.view();
    const Vec3 p = camera.target + camera.up * 4.0;  // upper edge of the picture
    const double y = m[1] * p.x + m[5] * p.y + m[9] * p.z + m[13],
                 w = m[3] * p.x + m[7] * p.y + m[11] * p.z + m[15];
    return y / w;
  };
  EXPECT_NEAR(clip_y(0), 1, 1e-6);
  EXPECT_NEAR(clip_y(30), 1, 1e-5);
}

// An infinite thin strip of width w, straight above at height h and seen broadside along its whole length,
// hides the share w / (2 h) of the cosine-weighted sky: the integral of cos a / (pi D^2) w cos a dx with cos
// a = h / D.
TEST(Sky, ThinYarnHidesItsFormFactor) {
  Fabric fabric = test::straight_yarn(12, 600, 0.02);
  // the reach is 2.6 diameters of the thickest yarn: a thick one far away makes it long enough
  fabric.yarns.push_back(fabric.yarns[0]);
  fabric.yarns[1].diameter = 3;
  for (Vec3& q : fabric.yarns[1].control_points) q.y += 1000;
  const Sky sky(fabric);
  std::vector<SkySample> near;
  sky.gather({6, 0, -1}, near);
  ASSERT_FALSE(near.empty());
  const double open = Sky::open_share({6, 0, -1}, {0, 0, 1}, near);
  EXPECT_NEAR(-std::log(open), 0.02 / 2, 2e-4);
  EXPECT_NEAR(Sky::open_share({6, 0, -1}, {0, 0, -1}, near), 1, 1e-12);
}

TEST(DrawnColour, OwnColourElsePaletteByCarrier) {
  Fabric fabric = test::plain_piece(2, 3);
  EXPECT_EQ(drawn_colour(fabric, 0), drawn_colour(fabric, 1));
  fabric.yarns[1].carrier = CarrierId(1);
  EXPECT_NE(drawn_colour(fabric, 0), drawn_colour(fabric, 1));
  fabric.yarns[1].colour = "#12aBfF";
  EXPECT_EQ(drawn_colour(fabric, 1), (std::array<std::uint8_t, 3>{0x12, 0xab, 0xff}));
  EXPECT_EQ(parsed_colour("red", {1, 2, 3}), (std::array<std::uint8_t, 3>{1, 2, 3}));
  EXPECT_EQ(parsed_colour("#12345g", {1, 2, 3}), (std::array<std::uint8_t, 3>{1, 2, 3}));
}

}  // namespace
}  // namespace loopwright
