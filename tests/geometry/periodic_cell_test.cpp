#include "geometry/periodic_cell.hpp"

#include <gtest/gtest.h>

#include "geometry/pieces.hpp"

namespace loopwright {
namespace {

TEST(periodic_cell, one_plain_loop) {
  const Fabric cell = chart_cell({"f"});
  EXPECT_TRUE(cell.periodic);
  ASSERT_EQ(cell.yarns.size(), 1u);
  EXPECT_TRUE(cell.yarns[0].periodic);
  EXPECT_EQ(std::abs(cell.yarns[0].shift[0]), 1);
  EXPECT_EQ(cell.yarns[0].shift[1], 0);
  EXPECT_DOUBLE_EQ(cell.wales, 1);
  EXPECT_DOUBLE_EQ(cell.courses, 1);
  EXPECT_NEAR(cell.width, 17 / 4.05, 1e-9);
  EXPECT_NEAR(cell.height, 17 / 5.3, 1e-5);
  EXPECT_NEAR(cell.skew, 0, 1e-9);
  EXPECT_EQ(cell.yarns[0].segments(), 12);
  EXPECT_NEAR(cell.yarns[0].segment_rest_length * 12, 17, 1e-9);
  ASSERT_EQ(cell.interlacings.size(), 1u);
  EXPECT_EQ(cell.interlacings[0].shift[1], 1);  // drawn through by its own image, one course on
}

TEST(periodic_cell, moss) {
  const Fabric cell = chart_cell({"fb", "bf"});
  EXPECT_EQ(cell.yarns.size(), 2u);
  EXPECT_DOUBLE_EQ(cell.wales, 2);
  EXPECT_DOUBLE_EQ(cell.courses, 2);
  EXPECT_EQ(cell.loops.size(), 4u);
  EXPECT_EQ(cell.yarns[0].shift[0] * cell.yarns[1].shift[0], -1);  // the courses go to and fro
}

TEST(periodic_cell, is_the_window_of_a_large_piece) {
  // The curve of the cell, unrolled, is that of the piece.
  const Piece piece = piece_of_text(chart_programme({"ffb"}, 15, 14));
  CellRange range;
  range.first_slot = 6;
  range.wales = 3;
  range.repeat_starts = course_starts(piece.graph, 1);
  range.repeat = 6;
  const YarnCurves cell = cut_periodic_cell(piece.graph, piece.options, piece.placed, range);
  ASSERT_EQ(cell.yarns.size(), 1u);
  std::size_t found = 0;
  for (const TypePoint& point : cell.yarns[0].points) {
    double nearest = 1e9;
    for (const PlacedLoop& loop : piece.placed.loops)
      for (const TypePoint& other : loop.points)
        nearest = std::min(nearest, distance(point.position, other.position));
    found += nearest < 1e-9;
  }
  EXPECT_GE(found + 3, cell.yarns[0].points.size());  // all but the three sinker points
}

TEST(periodic_cell, refuses_what_has_no_counterpart) {
  const Piece piece = piece_of_text(chart_programme({"f"}, 6, 6));
  CellRange range;
  range.repeat_starts = course_starts(piece.graph, 1);
  range.repeat = 2;
  range.first_slot = 20;  // no loops there
  EXPECT_THROW(cut_periodic_cell(piece.graph, piece.options, piece.placed, range), std::invalid_argument);
  range.first_slot = 0;
  range.repeat = 17;  // no such repeat
  EXPECT_THROW(cut_periodic_cell(piece.graph, piece.options, piece.placed, range), std::invalid_argument);
  EXPECT_THROW(cell_range(piece.program), std::invalid_argument);  // knitout has no repeat of its own
}

}  // namespace
}  // namespace loopwright
