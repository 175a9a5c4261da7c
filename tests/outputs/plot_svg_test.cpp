#include "outputs/write_plot_svg.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <limits>
#include <sstream>
#include <stdexcept>

namespace loopwright {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

TEST(PlotSvg, TicksAreRound) {
  EXPECT_THAT(round_ticks(0, 1, 5),
              ElementsAre(0, 0.2, testing::DoubleEq(0.4), testing::DoubleNear(0.6, 1e-12), 0.8, 1));
  EXPECT_THAT(round_ticks(-30, 71, 5), ElementsAre(-20, 0, 20, 40, 60));
  EXPECT_THAT(round_ticks(0.011, 0.019, 4),
              ElementsAre(testing::DoubleNear(0.012, 1e-12), testing::DoubleNear(0.014, 1e-12),
                          testing::DoubleNear(0.016, 1e-12), testing::DoubleNear(0.018, 1e-12)));
}

TEST(PlotSvg, DrawsCurvesAndMarksAndBreaksLinesAtWhatIsNotANumber) {
  const std::filesystem::path file = std::filesystem::path(testing::TempDir()) / "plot.svg";
  const double nan = std::numeric_limits<double>::quiet_NaN();
  write_plot_svg(file,
                 {"a < b",
                  "strain",
                  "N/m",
                  {{"line", {0, 1, 2, 3}, {0, 1, nan, 2}, false}, {"measured", {1, 2}, {1, 1.5}, true}}});
  std::ifstream in(file);
  std::ostringstream all;
  all << in.rdbuf();
  const std::string text = all.str();
  EXPECT_THAT(text, HasSubstr("a &lt; b"));
  EXPECT_THAT(text, HasSubstr("measured"));
  const std::size_t line = text.find("fill=\"none\" stroke=\"#");
  ASSERT_NE(line, std::string::npos);
  const std::string path = text.substr(text.rfind("<path", line), line - text.rfind("<path", line));
  EXPECT_EQ(std::count(path.begin(), path.end(), 'M'), 2) << path;
  EXPECT_EQ(std::count(path.begin(), path.end(), 'L'), 1) << path;
}

TEST(PlotSvg, RefusesWhatCannotBeDrawn) {
  EXPECT_THROW(write_plot_svg("/tmp/none.svg", {"", "", "", {{"a", {1}, {}, false}}}), std::invalid_argument);
  EXPECT_THROW(write_plot_svg("/tmp/none.svg", {"", "", "", {}}), std::invalid_argument);
}

}  // namespace
}  // namespace loopwright
