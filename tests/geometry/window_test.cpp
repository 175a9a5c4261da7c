#include "geometry/window.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>

#include "geometry/pieces.hpp"

namespace loopwright {
namespace {

YarnCurves window_of(const Piece& piece, int wales, int courses) {
  return cut_window(piece.graph, piece.options, piece.placed,
                    middle_window(piece.graph, piece.placed.layout, wales, courses));
}

TEST(window, takes_so_many_wales_and_courses_from_the_middle) {
  const Piece piece = piece_of_text(chart_programme({"f"}, 20, 21));
  const LoopSelection selection = middle_window(piece.graph, piece.placed.layout, 6, 5);
  EXPECT_EQ(std::accumulate(selection.begin(), selection.end(), 0), 30);
  for (std::size_t i = 0; i < selection.size(); ++i) {
    const Loop& loop = piece.graph.loops[i];
    EXPECT_EQ(selection[i] != 0, loop.slot >= 7 && loop.slot <= 12 && loop.pass >= 8 && loop.pass <= 12);
  }
  const YarnCurves curves = window_of(piece, 6, 5);
  EXPECT_EQ(curves.yarns.size(), 5u);
  EXPECT_EQ(curves.interlacings.size(), 24u);
  EXPECT_DOUBLE_EQ(curves.wales, 6);
  EXPECT_DOUBLE_EQ(curves.courses, 5);
  EXPECT_NEAR(curves.width, 6 * piece.options.wale_pitch, 1e-9);
  EXPECT_NEAR(curves.height, 5 * piece.options.course_pitch, 1e-4);
}

TEST(window, holds_cut_yarn_heads_and_feet_at_the_border_and_nothing_else) {
  const Piece piece = piece_of_text(chart_programme({"f"}, 20, 21));
  const YarnCurves curves = window_of(piece, 6, 5);
  int ends = 0, heads = 0, feet = 0, others = 0;
  for (const CurveYarn& yarn : curves.yarns)
    for (const TypePoint& point : yarn.points) {
      if (!point.held) continue;
      const int pass = piece.graph.loop(point.loop).pass;
      if (&point == &yarn.points.front() || &point == &yarn.points.back()) {
        ++ends;
      } else if (point.part == LoopPart::head) {
        ++heads;
        EXPECT_EQ(pass, 12);
      } else if (point.part == LoopPart::foot) {
        ++feet;
        EXPECT_EQ(pass, 8);
      } else {
        ++others;
      }
    }
  EXPECT_EQ(ends, 10);
  EXPECT_EQ(heads, 6);
  EXPECT_EQ(feet, 12);
  EXPECT_EQ(others, 0);
}

TEST(window, a_tube_is_taken_whole_round) {
  std::string text = ";!knitout-2\n;;Carriers: 1\ninhook 1\n";
  for (int round = 0; round < 12; ++round) {
    for (int k = 0; k < 10; ++k) text += "knit + f" + std::to_string(k) + " 1\n";
    for (int k = 9; k >= 0; --k) text += "knit - b" + std::to_string(k) + " 1\n";
  }
  const Piece piece = piece_of_text(text + "outhook 1\n");
  const YarnCurves curves = window_of(piece, 4, 5);
  EXPECT_NEAR(curves.courses, 5, 0.6);
  EXPECT_DOUBLE_EQ(curves.wales, 10);
  const Fabric fabric = fabric_of(piece, curves);
  const InterlacingCheck check = check_interlacings(fabric);
  EXPECT_EQ(check.intact, check.expected);
  EXPECT_GT(min_clearance(fabric).distance, 0.4);
}

TEST(window, what_a_fabric_file_asks_for) {
  const Piece piece = piece_of_text(chart_programme({"fb"}, 12, 12));
  ProgramWindow window;
  window.first_needle = 4;
  window.needles = 4;
  const std::vector<int> starts = course_starts(piece.graph, 1);
  ASSERT_EQ(starts.size(), 12u);
  window.first_instruction = starts.at(3);
  window.instructions = starts.at(7) - starts.at(3);
  const LoopSelection selection = program_window(piece.graph, window);
  for (std::size_t i = 0; i < selection.size(); ++i) {
    const Loop& loop = piece.graph.loops[i];
    const int course = static_cast<int>(i) / 12;
    EXPECT_EQ(selection[i] != 0, loop.slot >= 4 && loop.slot <= 7 && course >= 3 && course < 7);
  }
  const LoopSelection all = program_window(piece.graph, ProgramWindow{});
  EXPECT_EQ(std::count(all.begin(), all.end(), 1), 144);
}

TEST(window, curves_have_the_yarn_that_was_asked_for) {
  const Piece piece = piece_of_text(chart_programme({"ffb", "fbf"}, 12, 12));
  const YarnCurves curves = build_yarn_curves(piece.graph, piece.options);
  double rest = 0;
  for (const CurveYarn& yarn : curves.yarns) {
    ASSERT_EQ(yarn.rest_length.size(), yarn.points.size() - 1);
    for (const double length : yarn.rest_length) {
      EXPECT_GT(length, 0);
      rest += length;
    }
  }
  EXPECT_NEAR(rest, 144 * piece.options.loop_length, 1e-6);
  const Fabric fabric = fabric_of(piece, curves);
  double segments = 0;
  for (const FabricYarn& yarn : fabric.yarns) segments += yarn.segments() * yarn.segment_rest_length;
  EXPECT_NEAR(segments, rest, 1e-6);
  EXPECT_NEAR(arc_length(fabric, fabric.yarns[0]) / segments, 1, 0.15);
  ASSERT_EQ(fabric.loops.size(), 144u);
  for (const LoopSpan& span : fabric.loops) {
    EXPECT_LT(span.begin, span.apex);
    EXPECT_LT(span.apex, span.end);
    EXPECT_EQ(span.at, piece.graph.loop(span.loop).at);
  }
}

}  // namespace
}  // namespace loopwright
