#include "geometry/layout.hpp"

#include <gtest/gtest.h>

#include "geometry/held_events.hpp"
#include "geometry/pieces.hpp"

namespace loopwright {
namespace {

TEST(layout, plain_is_a_grid_of_pitches) {
  const Piece piece = piece_of_text(chart_programme({"f"}, 7, 9));
  const Layout& layout = piece.placed.layout;
  const Vec3 first = layout.lower[0];
  for (std::size_t i = 0; i < piece.graph.loops.size(); ++i) {
    const double course = static_cast<double>(i / 7);
    EXPECT_NEAR(layout.lower[i].x, piece.graph.loops[i].slot * piece.options.wale_pitch, 1e-12);
    EXPECT_NEAR(layout.lower[i].y - first.y, course * piece.options.course_pitch, 1e-5);
    EXPECT_EQ(layout.lower[i].z, 0);
    EXPECT_NEAR(layout.upper[i].y - layout.lower[i].y, piece.options.course_pitch, 1e-5);
    for (const LoopId child : piece.graph.loops[i].children)
      EXPECT_EQ(layout.upper[i], layout.lower[child.position()]);
  }
}

TEST(layout, two_beds_lie_apart) {
  const Piece rib = piece_of_text(chart_programme({"fb"}, 8, 6));
  const double z0 = 2.5 * rib.options.shape_radius();  // twice the thickness, as the first paper starts it
  for (std::size_t i = 0; i < rib.graph.loops.size(); ++i) {
    const double z = is_front(rib.graph.loops[i].bed) ? z0 : -z0;
    EXPECT_DOUBLE_EQ(rib.placed.layout.lower[i].z, z);
    EXPECT_DOUBLE_EQ(rib.placed.layout.upper[i].z, z);
  }
  const Piece garter = piece_of_text(chart_programme({"f", "b"}, 8, 6));
  for (std::size_t i = 0; i + 8 < garter.graph.loops.size(); ++i)
    EXPECT_DOUBLE_EQ(garter.placed.layout.lower[i].z, -garter.placed.layout.upper[i].z);
}

TEST(layout, half_milano_shares_the_height) {
  // All needles, then the front ones only: rear loops span two courses, front ones one.
  std::string text = ";!knitout-2\n;;Carriers: 1\ninhook 1\n";
  for (int course = 0; course < 16; ++course) {
    const bool right = course % 2 == 0, all = (course / 2) % 2 == 0;
    for (int k = 0; k < 20; ++k) {
      const int place = right ? k : 19 - k;
      const std::string needle = std::to_string(place / 2);
      if (place % 2 == 0) text += std::string("knit ") + (right ? '+' : '-') + " f" + needle + " 1\n";
      if (place % 2 == 1 && all) text += std::string("knit ") + (right ? '+' : '-') + " b" + needle + " 1\n";
    }
  }
  const Piece piece = piece_of_text(text + "outhook 1\n");
  double front = 0, back = 0, front_count = 0, back_count = 0;
  for (std::size_t i = 100; i < 160; ++i) {
    const Loop& loop = piece.graph.loops[i];
    if (loop.children.empty()) continue;
    const double height = piece.placed.layout.upper[i].y - piece.placed.layout.lower[i].y;
    (is_front(loop.bed) ? front : back) += height;
    (is_front(loop.bed) ? front_count : back_count) += 1;
  }
  front /= front_count;
  back /= back_count;
  EXPECT_GT(back, 1.2 * front);
  EXPECT_GT(front, 0.5 * piece.options.course_pitch);
}

TEST(layout, short_rows_make_the_piece_longer_where_they_are) {
  std::string text = ";!knitout-2\n;;Carriers: 1\ninhook 1\n";
  const auto course = [&](int from, int to) {
    for (int k = from; from < to ? k <= to : k >= to; k += from < to ? 1 : -1)
      text += std::string("knit ") + (from < to ? '+' : '-') + " f" + std::to_string(k) + " 1\n";
  };
  course(0, 15);
  course(15, 0);
  for (int k = 0; k < 4; ++k) {
    course(0, 5);
    course(5, 0);
  }
  course(0, 15);
  course(15, 0);
  const Piece piece = piece_of_text(text + "outhook 1\n");
  const auto height = [&](std::size_t wale) {  // from the first course to the last
    const std::size_t n = piece.graph.loops.size();
    return piece.placed.layout.lower[n - 1 - wale].y - piece.placed.layout.lower[wale].y;
  };
  EXPECT_GT(height(1), height(14) + 2 * piece.options.course_pitch);
}

TEST(layout, half_gauge_lies_as_wide_as_its_wales) {
  std::string text = ";!knitout-2\n;;Carriers: 1\ninhook 1\n";
  for (int course = 0; course < 6; ++course)
    for (int k = 0; k < 10; ++k)
      text += course % 2 == 0 ? "knit + f" + std::to_string(2 * k) + " 1\n"
                              : "knit - f" + std::to_string(18 - 2 * k) + " 1\n";
  const Piece piece = piece_of_text(text + "outhook 1\n");
  EXPECT_DOUBLE_EQ(slots_per_wale(piece.graph), 2);
  EXPECT_NEAR(piece.placed.layout.lower[1].x - piece.placed.layout.lower[0].x, piece.options.wale_pitch,
              1e-12);
}

// A second yarn knits two courses, waits at the left edge while the first knits ten more, and goes on there.
TEST(layout, a_yarn_that_waits_runs_up_outside_the_edge) {
  constexpr int needles = 12, wait = 10;
  std::string text = ";!knitout-2\n;;Carriers: 1 2\n";
  const auto course = [&](int carrier, bool right) {
    for (int k = 0; k < needles; ++k)
      text += std::string("knit ") + (right ? "+ f" : "- f") + std::to_string(right ? k : needles - 1 - k) +
              ' ' + std::to_string(carrier) + '\n';
  };
  const auto pair = [&](int carrier) { course(carrier, true), course(carrier, false); };
  text += "inhook 1\n", pair(1), text += "inhook 2\n", pair(2);
  for (int k = 0; k < wait; k += 2) pair(1);
  pair(2), pair(1);
  const Piece piece = piece_of_text(text + "outhook 2\nouthook 1\n");
  const Fabric fabric = whole_fabric(piece);
  const InterlacingCheck check = check_interlacings(fabric);
  EXPECT_EQ(check.intact, check.expected);

  const GraphYarn& second = piece.graph.yarns[1];
  const LoopId last = second.loops[2 * needles - 1], next = second.loops[2 * needles];
  EXPECT_EQ(rows_waited(piece.graph, last, next), wait);
  const PlacedSinker& sinker = piece.placed.sinkers[1][2 * needles];
  const double edge = piece.placed.layout.lower[last.position()].x;
  EXPECT_LT(sinker.points[sinker.middle].position.x, edge - 0.75 * piece.options.wale_pitch);
  EXPECT_GT(sinker.extra_length, 0.9 * wait * piece.options.course_pitch);
  // the rows in between are as high as others, and all wales as tall as one another
  const Layout& layout = piece.placed.layout;
  for (const LoopId id : piece.graph.yarns[0].loops)
    EXPECT_NEAR(layout.step(id).y, piece.options.course_pitch, 0.05 * piece.options.course_pitch);
}

TEST(geometry_options, defaults_and_what_a_file_says) {
  Program program;
  program.settings.gauge_npi = 15;
  GeometryOptions options = make_geometry_options(program);
  EXPECT_NEAR(options.loop_length * options.diameter_mm, 4.2 * 25.4 / 15,
              1e-12);  // 7.11 mm: the KnitDB machine
  EXPECT_NEAR(options.loop_length, 17, 1e-12);
  EXPECT_NEAR(options.shape_radius(), 0.5, 1e-12);
  EXPECT_NEAR(options.needle_pitch * options.diameter_mm, 25.4 / 15, 1e-12);

  program.settings.loop_length_mm = 6;
  program.settings.tuck_length_mm = 4;
  program.settings.bed_change_mm = 1.5;
  program.yarns.resize(2);
  program.yarns[0].diameter_mm = 0.3;
  program.yarns[1].diameter_mm = 0.4;
  options = make_geometry_options(program);
  EXPECT_DOUBLE_EQ(options.diameter_mm, 0.4);
  EXPECT_DOUBLE_EQ(options.loop_length, 15);
  EXPECT_DOUBLE_EQ(options.tuck_length, 10);
  EXPECT_DOUBLE_EQ(options.bed_change, 3.75);
  EXPECT_DOUBLE_EQ(options.yarn_diameters[0], 0.75);
  EXPECT_DOUBLE_EQ(options.wale_pitch, 15 / 4.05);
}

}  // namespace
}  // namespace loopwright
