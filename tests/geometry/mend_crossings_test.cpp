// Crossings that the template leaves wrong are drawn anew; those that are right stay as they are.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "geometry/assemble.hpp"
#include "geometry/mend_crossings.hpp"
#include "geometry/pieces.hpp"

namespace loopwright {
namespace {

Piece plain() { return piece_of_text(chart_programme({"f"}, 10, 12)); }

TEST(mend_crossings, right_layout_is_left_alone) {
  const Piece piece = plain();
  const Layout flat = lay_out(piece.graph, piece.options);
  const MendedLayout mended = mended_layout(piece.graph, piece.options, flat, flat);
  EXPECT_EQ(mended.wrong_before, 0);
  EXPECT_EQ(mended.rounds, 0);
  EXPECT_EQ(mended.layout.y_scale_lower, flat.y_scale_lower);
  EXPECT_EQ(mended.layout.x_scale_upper, flat.x_scale_upper);
}

// Feet twice as far apart as the heads that they go through.
TEST(mend_crossings, crossing_without_room_gets_its_interlacings_back) {
  const Piece piece = plain();
  const Layout flat = lay_out(piece.graph, piece.options);
  Layout spoilt = flat;
  for (std::size_t i = 60; i < 64; ++i) spoilt.x_scale_lower[i] = 2;
  ASSERT_GT(wrong_interlacings(piece.graph, piece.options, flat, spoilt), 0);
  const MendedLayout mended = mended_layout(piece.graph, piece.options, flat, spoilt);
  EXPECT_GT(mended.wrong_before, 0);
  EXPECT_EQ(mended.wrong, 0);
  EXPECT_EQ(wrong_interlacings(piece.graph, piece.options, flat, mended.layout), 0);
  // no place was moved, and what is far away is as it was
  for (std::size_t i = 0; i < flat.lower.size(); ++i)
    EXPECT_EQ(norm(mended.layout.lower[i] - flat.lower[i]), 0);
  EXPECT_EQ(mended.layout.y_scale_lower[5], flat.y_scale_lower[5]);
}

TEST(mend_crossings, the_same_every_time) {
  const Piece piece = plain();
  const Layout flat = lay_out(piece.graph, piece.options);
  Layout spoilt = flat;
  for (std::size_t i = 60; i < 64; ++i) spoilt.x_scale_lower[i] = 2;
  const MendedLayout one = mended_layout(piece.graph, piece.options, flat, spoilt);
  const MendedLayout other = mended_layout(piece.graph, piece.options, flat, spoilt);
  EXPECT_EQ(one.layout.x_scale_lower, other.layout.x_scale_lower);
  EXPECT_EQ(one.rounds, other.rounds);
}

// Bind-offs and stacked chains of programmes that others wrote: wrong as the template has them.
class real_bind_off : public testing::TestWithParam<const char*> {};

TEST_P(real_bind_off, first_curves_are_all_interlaced) {
  const std::filesystem::path file = corpus() / "files" / GetParam();
  if (!std::filesystem::exists(file)) GTEST_SKIP() << "the corpus of real programmes is not here";
  const Piece piece = piece_of_text(text_of(file));
  const PlacedPiece placed = mended_piece(piece.graph, piece.options);
  const YarnCurves curves = assemble_runs(piece.graph, piece.options, placed, whole_yarns(piece.graph));
  const InterlacingCheck check = check_interlacings(fabric_of(piece, curves));
  EXPECT_EQ(check.intact, check.expected);
  EXPECT_EQ(check.expected, static_cast<int>(piece.graph.interlacings.size()));
}

INSTANTIATE_TEST_SUITE_P(corpus, real_bind_off,
                         testing::Values("single_color_brioche.k", "stockenette_tube.k", "purl.k"),
                         [](const testing::TestParamInfo<const char*>& of) {
                           std::string name = of.param;
                           std::replace_if(
                               name.begin(), name.end(), [](char c) { return !std::isalnum(c); }, '_');
                           return name;
                         });

// A cast-on of tucks: they lie on no loop's legs, and stand no wider than heads, else their legs lie on the
// sinkers of their children.
TEST(type_points, tucks_of_a_cast_on_stand_no_wider_than_heads) {
  std::string text = ";!knitout-2\n;;Carriers: 1\ninhook 1\n";
  for (int k = 9; k > 0; k -= 2) text += "tuck - f" + std::to_string(k) + " 1\n";
  for (int k = 0; k < 10; k += 2) text += "tuck + f" + std::to_string(k) + " 1\n";
  for (int row = 0; row < 3; ++row)
    for (int k = 0; k < 10; ++k)
      text += std::string("knit ") +
              (row % 2 == 0 ? "- f" + std::to_string(9 - k) : "+ f" + std::to_string(k)) + " 1\n";
  text += "tuck + f4 1\nknit - f5 1\nknit - f4 1\nouthook 1\n";
  const Piece piece = piece_of_text(text);
  int cast_on = 0, laid = 0;
  for (std::size_t i = 0; i < piece.graph.loops.size(); ++i) {
    const Loop& loop = piece.graph.loops[i];
    if (loop.kind != LoopKind::tuck) continue;
    double wide = 0;
    for (const TypePoint& point : piece.placed.loops[i].points)
      wide = std::max(wide, std::abs(point.position.x - piece.placed.layout.upper[i].x));
    const double unit = piece.options.wale_pitch / 8;
    (loop.pass < 2 ? cast_on : laid) += 1;
    if (loop.pass < 2)
      EXPECT_LT(wide, 3 * unit);
    else
      EXPECT_GT(wide, 3 * unit);
  }
  EXPECT_EQ(cast_on, 10);
  EXPECT_EQ(laid, 1);
}

}  // namespace
}  // namespace loopwright
