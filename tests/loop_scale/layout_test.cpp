// Real programmes and a tube relaxed at loop scale: shape, widths, enclosed volume, interlacings.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "geometry/pieces.hpp"
#include "loop_scale/relaxed_layout.hpp"
#include "loop_scale/tube_walls.hpp"

namespace loopwright {
namespace {

int intact(const Piece& piece, const RelaxedLayout& layout) {
  return check_interlacings(fit_fabric(layout.curves, piece.graph, layout.model.geometry)).intact;
}

// Tube of n needles on each bed: to the right on the front, back to the left on the rear.
std::string tube_programme(int n, int rounds) {
  std::string text = ";!knitout-2\n;;Carriers: 1\ninhook 1\n";
  for (int round = 0; round < rounds; ++round)
    for (const char bed : {'f', 'b'})
      for (int k = 0; k < n; ++k)
        text += std::string("knit ") + (bed == 'f' ? '+' : '-') + ' ' + bed +
                std::to_string(bed == 'f' ? k : n - 1 - k) + " 1\n";
  return text + "outhook 1\n";
}

TEST(relaxed_layout, tube_opens_and_stays_knitted) {
  const Piece piece = piece_of_text(tube_programme(10, 10));
  const RelaxedLayout layout = relaxed_layout(piece.graph, piece.program);
  EXPECT_TRUE(layout.result.settled);
  const std::vector<RoundMeasure> rounds = round_measures(piece.graph, layout);
  ASSERT_EQ(rounds.size(), 10U);
  const double l = layout.model.yarn.loop_length;
  for (const RoundMeasure& round : rounds) {
    EXPECT_EQ(round.loops, 20);
    EXPECT_GT(round.roundness, 0.7);
    EXPECT_NEAR(round.perimeter / l, 20 * 0.2456, 0.05 * 20 * 0.2456);
  }
  EXPECT_EQ(intact(piece, layout), static_cast<int>(piece.graph.interlacings.size()));
}

// Rib in the round on half gauge: both walls on both beds, the one on even, the other on odd needles.
std::string rib_tube_programme(int n, int rounds) {
  std::string text = ";!knitout-2\n;;Carriers: 1\ninhook 1\n";
  const auto rib = [](int k) { return k / 2 % 2 == 0; };
  const auto each = [&](bool front, bool back_again, const auto& write) {
    for (int k = 0; k < n; ++k) {
      const int needle = front ? 2 * k : 2 * (back_again ? n - 1 - k : k) + 1;
      write(needle, rib(needle / 2 * 2));
    }
  };
  const auto transfer = [&](bool front, bool away) {  // every other stitch of a wall to the other bed
    each(front, false, [&](int needle, bool stays) {
      const std::string near = (front ? "f" : "b") + std::to_string(needle),
                        far = (front ? "b" : "f") + std::to_string(needle);
      if (!stays) text += "xfer " + (away ? near + ' ' + far : far + ' ' + near) + '\n';
    });
  };
  for (int round = 0; round < rounds; ++round)
    for (const bool front : {true, false}) {
      if (round > 0) transfer(front, true);
      each(front, true, [&](int needle, bool stays) {
        const bool on_front = round == 0 ? front : front == stays;
        text += std::string("knit ") + (front ? "+ " : "- ") + (on_front ? 'f' : 'b') +
                std::to_string(needle) + " 1\n";
      });
      if (round > 0) transfer(front, false);
    }
  return text + "outhook 1\n";
}

TEST(relaxed_layout, rib_tube_on_every_other_needle_is_round) {
  const Piece piece = piece_of_text(rib_tube_programme(12, 10));
  const RelaxedLayout layout = relaxed_layout(piece.graph, piece.program);
  const std::vector<RoundMeasure> rounds = round_measures(piece.graph, layout);
  EXPECT_GE(rounds.size(), 9U);
  double volume = 0;
  for (std::size_t k = 0; k < rounds.size(); ++k) {
    EXPECT_EQ(rounds[k].loops, 24);
    if (k > 0) volume += norm(rounds[k].area) * distance(rounds[k].centre, rounds[k - 1].centre);
  }
  EXPECT_NEAR(enclosed_volume(rounds), volume, 0.3 * volume);
  EXPECT_GT(volume, 0);
}

TEST(relaxed_layout, flat_cast_on_every_other_needle_is_no_tube) {
  std::string text = ";!knitout-2\n;;Carriers: 1\ninhook 1\n";
  for (int k = 11; k > 0; k -= 2) text += "tuck - f" + std::to_string(k) + " 1\n";
  for (int k = 0; k < 12; k += 2) text += "tuck + f" + std::to_string(k) + " 1\n";
  for (int row = 0; row < 6; ++row)
    for (int k = 0; k < 12; ++k)
      text += std::string("knit ") +
              (row % 2 == 0 ? "- f" + std::to_string(11 - k) : "+ f" + std::to_string(k)) + " 1\n";
  const Piece piece = piece_of_text(text + "outhook 1\n");
  const RelaxedLayout layout = relaxed_layout(piece.graph, piece.program);
  EXPECT_TRUE(round_measures(piece.graph, layout).empty());
  EXPECT_EQ(intact(piece, layout), static_cast<int>(piece.graph.interlacings.size()));
}

TEST(relaxed_layout, flat_tube_encloses_less) {
  const Piece piece = piece_of_text(tube_programme(10, 10));
  RelaxedLayout start = relaxed_layout(piece.graph, piece.program);
  start.state = state_at_rest(start.model.start);
  for (const RoundMeasure& round : round_measures(piece.graph, start)) EXPECT_LT(round.roundness, 0.4);
}

// Knitted twice as wide as it comes to rest: if the sheet folded while it contracts, its stitches would come
// to lie on either side.
TEST(relaxed_layout, rib_stays_flat_with_its_stitches_on_their_sides) {
  for (const std::vector<std::string>& chart : {std::vector<std::string>{"fb"}, {"fb", "bf"}, {"ffbb"}}) {
    const Piece piece = piece_of_text(chart_programme(chart, 24, 16));
    const RelaxedLayout layout = relaxed_layout(piece.graph, piece.program);
    EXPECT_TRUE(layout.result.settled);
    EXPECT_EQ(intact(piece, layout), static_cast<int>(piece.graph.interlacings.size())) << chart.front();
    EXPECT_EQ(layout.wrong, 0);
    const auto [rear, front] = std::minmax_element(layout.state.z.begin(), layout.state.z.end());
    EXPECT_LT(*front - *rear, 0.5 * layout.model.yarn.loop_length) << chart.front();
  }
}

// Two tubes on half gauge with interlock waste between them: every course of the waste goes to and fro
// between the two walls, and its wales hold each other only by the floats that pass them.
std::string tubes_with_waste(int n, int rounds, int waste) {
  std::string text = ";!knitout-2\n;;Carriers: 1\ninhook 1\n";
  const auto knit = [&](bool right, char bed, int needle) {
    text += std::string("knit ") + (right ? '+' : '-') + ' ' + bed + std::to_string(needle) + " 1\n";
  };
  const auto tube = [&] {
    for (int round = 0; round < rounds; ++round) {
      for (int k = 0; k < n; ++k) knit(true, 'f', 2 * k);
      for (int k = n - 1; k >= 0; --k) knit(false, 'b', 2 * k + 1);
    }
  };
  tube();
  for (int course = 0; course < waste; ++course) {
    for (int k = 0; k < n; k += 2) knit(true, 'f', 2 * k), knit(true, 'b', 2 * k + 1);
    for (int k = n - 1; k > 0; k -= 2) knit(false, 'b', 2 * k + 1), knit(false, 'f', 2 * k);
  }
  tube();
  return text + "outhook 1\n";
}

TEST(relaxed_layout, waste_between_tubes_is_flat_and_the_tubes_close_toward_it) {
  constexpr int n = 12, rounds = 24, waste = 12;
  const Piece piece = piece_of_text(tubes_with_waste(n, rounds, waste));
  const RelaxedLayout layout = relaxed_layout(piece.graph, piece.program);
  EXPECT_TRUE(layout.result.settled);
  EXPECT_EQ(layout.wrong, 0);
  EXPECT_EQ(intact(piece, layout), static_cast<int>(piece.graph.interlacings.size()));
  const std::vector<std::int8_t> walls = tube_walls(piece.graph, rounds_of(piece.graph, layout.model.points));
  // but for a course where one goes over into the other
  const std::size_t course = 2 * n, tube_end = course * rounds, waste_end = tube_end + course * waste;
  for (std::size_t k = 0; k < walls.size(); ++k) {
    const bool in_waste = k > tube_end + course && k + course < waste_end;
    if (in_waste || k + course < tube_end || k > waste_end + course) {
      EXPECT_EQ(walls[k] == 0, in_waste) << k;
    }
  }
  const std::vector<RoundMeasure> measures = round_measures(piece.graph, layout);
  ASSERT_GE(measures.size(), 2U * rounds - 2);
  EXPECT_GT(measures[rounds / 2].roundness, 0.6);
  EXPECT_LT(measures[rounds - 1].roundness, 0.5 * measures[rounds / 2].roundness);
}

struct Programme {
  const char* file;
  int broken;  // interlacings that the layout leaves, of all (the first geometry's own beside it)
};

// Named beside each test so that a failure says which programme it was.
class real_layout : public testing::TestWithParam<Programme> {};

TEST_P(real_layout, widths_follow_stitch_counts) {
  const std::filesystem::path file = corpus() / "files" / GetParam().file;
  if (!std::filesystem::exists(file)) GTEST_SKIP() << "the corpus of real programmes is not here";
  const Piece piece = piece_of_text(text_of(file));
  const RelaxedLayout layout = relaxed_layout(piece.graph, piece.program);
  EXPECT_TRUE(layout.result.settled);
  // courses of even stitches on neighbouring needles: each as wide as its stitches at rest
  int ordinary = 0;
  double most = 0;
  for (const CourseMeasure& course : course_measures(piece.graph, layout)) {
    if (course.stitches < 10) continue;
    const double share = course.width / layout.model.yarn.loop_length / (course.stitches - 1) / 0.2456;
    if (share > 1.5) continue;  // knitted on every other needle: a cast-on
    ++ordinary;
    most = std::max(most, std::abs(share - 1));
  }
  EXPECT_GT(ordinary, 10);
  EXPECT_LT(most, 0.1);
  EXPECT_GE(intact(piece, layout), static_cast<int>(piece.graph.interlacings.size()) - GetParam().broken);
}

INSTANTIATE_TEST_SUITE_P(corpus, real_layout,
                         testing::Values(Programme{"rectangle.knitout", 0}, Programme{"diamond.k", 0}),
                         [](const testing::TestParamInfo<Programme>& of) {
                           std::string name = of.param.file;
                           std::replace_if(
                               name.begin(), name.end(), [](char c) { return !std::isalnum(c); }, '_');
                           return name;
                         });

// Sharp folds, heads moved by several needles, stacks; and a bind-off of split stitches.
class ruffled_layout : public testing::TestWithParam<const char*> {};

TEST_P(ruffled_layout, has_all_interlacings) {
  const std::filesystem::path file = corpus() / "files" / GetParam();
  if (!std::filesystem::exists(file)) GTEST_SKIP() << "the corpus of real programmes is not here";
  const Piece piece = piece_of_text(text_of(file));
  const RelaxedLayout layout = relaxed_layout(piece.graph, piece.program);
  EXPECT_TRUE(layout.result.settled);
  EXPECT_EQ(layout.wrong, 0);
  EXPECT_EQ(intact(piece, layout), static_cast<int>(piece.graph.interlacings.size()));
}

INSTANTIATE_TEST_SUITE_P(corpus, ruffled_layout,
                         testing::Values("hyperbolic-plane.knitout", "single_color_brioche.k"),
                         [](const testing::TestParamInfo<const char*>& of) {
                           std::string name = of.param;
                           std::replace_if(
                               name.begin(), name.end(), [](char c) { return !std::isalnum(c); }, '_');
                           return name;
                         });

TEST(relaxed_layout, diamond_grows_and_shrinks) {
  const std::filesystem::path file = corpus() / "files" / "diamond.k";
  if (!std::filesystem::exists(file)) GTEST_SKIP() << "the corpus of real programmes is not here";
  const Piece piece = piece_of_text(text_of(file));
  const RelaxedLayout layout = relaxed_layout(piece.graph, piece.program);
  std::vector<CourseMeasure> courses = course_measures(piece.graph, layout);
  std::erase_if(courses, [](const CourseMeasure& c) { return c.stitches < 3; });
  const auto widest = std::max_element(courses.begin(), courses.end(),
                                       [](const auto& a, const auto& b) { return a.width < b.width; });
  // widest in the middle, narrow at both ends, and higher courses are higher
  EXPECT_GT(widest - courses.begin(), 10);
  EXPECT_GT(courses.end() - widest, 10);
  EXPECT_LT(courses.front().width, 0.2 * widest->width);
  EXPECT_LT(courses.back().width, 0.2 * widest->width);
  EXPECT_GT(courses.back().height, widest->height);
  EXPECT_GT(widest->height, courses.front().height);
}

}  // namespace
}  // namespace loopwright
