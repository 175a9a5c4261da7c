#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <sstream>

#include "base/diagnostics.hpp"

namespace loopwright {
namespace {

std::string printed(const Diagnostics& diagnostics) {
  std::ostringstream out;
  out << diagnostics;
  return out.str();
}

TEST(Diagnostics, PrintsInTheOrderOfTheFile) {
  Diagnostics d("a.verm");
  d.error({7, 2}, "second");
  d.warning({7, 1}, "first");
  d.error({9, 0}, "of the whole line");
  d.warning({}, "of the whole file");
  EXPECT_EQ(printed(d),
            "a.verm: warning: of the whole file\n"
            "a.verm:7:1: warning: first\n"
            "a.verm:7:2: error: second\n"
            "a.verm:9: error: of the whole line\n");
  EXPECT_EQ(d.errors(), 2);
  EXPECT_EQ(d.warnings(), 2);
  EXPECT_FALSE(d.ok());
}

TEST(Diagnostics, OneLocationKeepsTheOrderOfTelling) {
  Diagnostics d("a.k");
  for (const char* text : {"one", "two", "three"}) d.error({3, 3}, text);
  EXPECT_EQ(printed(d), "a.k:3:3: error: one\na.k:3:3: error: two\na.k:3:3: error: three\n");
}

TEST(Diagnostics, WarningsAreNoFailure) {
  Diagnostics d;
  EXPECT_TRUE(d.ok());
  d.warning({1, 1}, "careful");
  EXPECT_TRUE(d.ok());
  d.error({1, 1}, "no");
  EXPECT_FALSE(d.ok());
}

TEST(Diagnostics, AdviceIsNeitherErrorNorWarning) {
  Diagnostics d("a.k");
  d.advise({2, 1}, "look twice");
  EXPECT_TRUE(d.ok());
  EXPECT_EQ(d.warnings(), 0);
  EXPECT_EQ(d.advice(), 1);
  EXPECT_EQ(printed(d), "a.k:2:1: advice: look twice\n");
}

TEST(Diagnostics, AFloodIsCountedNotKept) {
  Diagnostics d("a.k");
  for (int i = 0; i < Diagnostics::most_kept + 500; ++i) d.warning({i + 1, 1}, "w");
  for (int i = 0; i < 3; ++i) d.error({i + 1, 1}, "e");
  EXPECT_EQ(d.warnings(), Diagnostics::most_kept + 500);
  EXPECT_EQ(d.errors(), 3) << "errors are kept after a flood of warnings";
  EXPECT_EQ(d.list().size(), static_cast<std::size_t>(Diagnostics::most_kept) + 3);
  EXPECT_THAT(printed(d), testing::EndsWith("a.k: 500 further diagnostics not shown\n"));
}

}  // namespace
}  // namespace loopwright
