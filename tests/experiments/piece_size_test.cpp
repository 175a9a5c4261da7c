// Sizes of pieces whose loops stand at known places.
#include "experiments/piece_size.hpp"

#include <gtest/gtest.h>

namespace loopwright {
namespace {

// A boustrophedon yarn with the apex of loop (i, j) at (3 i + sway, 2 j), one yarn for the whole piece.
Fabric piece(int wales, int courses, int short_course = -1) {
  Fabric fabric;
  fabric.wales = wales;
  fabric.courses = courses;
  fabric.width = 99;
  fabric.height = 77;
  FabricYarn yarn;
  for (int j = 0; j < courses; ++j) {
    const int loops = j == short_course ? wales / 2 : wales;
    for (int k = 0; k < loops; ++k) {
      const int i = j % 2 == 0 ? k : loops - 1 - k;
      LoopSpan span;
      span.direction = j % 2 == 0 ? Direction::right : Direction::left;
      // three equal control points put the curve on the point itself
      span.apex = static_cast<double>(yarn.control_points.size());
      for (int copy = 0; copy < 3; ++copy) yarn.control_points.push_back({3.0 * i + 0.1 * j, 2.0 * j, 0});
      span.begin = span.apex - 1, span.end = span.apex + 1;
      fabric.loops.push_back(span);
    }
  }
  yarn.control_points.push_back(yarn.control_points.back());
  fabric.yarns.push_back(std::move(yarn));
  return fabric;
}

TEST(PieceSize, PitchTimesWalesAndCourses) {
  const PieceSize size = piece_size(piece(8, 5));
  EXPECT_NEAR(size.width, 24, 1e-12);
  EXPECT_NEAR(size.height, 10, 1e-12);
}

TEST(PieceSize, ShortCoursesDoNotNarrowThePiece) { EXPECT_NEAR(piece_size(piece(8, 5, 2)).width, 24, 1e-12); }

TEST(PieceSize, OneLoopOrOneCourseKeepsTheFabricsOwn) {
  EXPECT_EQ(piece_size(piece(1, 5)).width, 99);
  EXPECT_EQ(piece_size(piece(6, 1)).height, 77);
}

}  // namespace
}  // namespace loopwright
