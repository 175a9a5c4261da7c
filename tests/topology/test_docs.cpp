// The programmes shown in the documentation of these two stages are right.
#include <gtest/gtest.h>

#include <fstream>
#include <sstream>

#include "notation/read_knitout.hpp"
#include "topology/graph_of.hpp"

namespace loopwright {
namespace {

TEST(Documentation, programmes_that_it_shows_run_without_error) {
  int shown = 0;
  for (const char* page : {"/docs/machine.md", "/docs/topology.md"}) {
    std::ifstream in(std::string(LOOPWRIGHT_SOURCE_DIR) + page);
    ASSERT_TRUE(in) << page;
    std::ostringstream text;
    text << in.rdbuf();
    const std::string whole = text.str(), fence = "```knitout\n";
    for (std::size_t at = whole.find(fence); at != std::string::npos; at = whole.find(fence, at + 1)) {
      const std::size_t begin = at + fence.size();
      Diagnostics diagnostics(page);
      const Program program =
          read_knitout(whole.substr(begin, whole.find("```", begin) - begin), diagnostics);
      const KnittingRecord record = run_machine(program, diagnostics);
      const YarnGraph graph = build_yarn_graph(program, record, diagnostics);
      EXPECT_TRUE(diagnostics.ok()) << diagnostics;
      EXPECT_EQ(diagnostics.warnings(), 0) << diagnostics;
      EXPECT_TRUE(validate_yarn_graph(graph).empty());
      EXPECT_FALSE(graph.loops.empty());
      ++shown;
    }
  }
  EXPECT_EQ(shown, 2);
}

}  // namespace
}  // namespace loopwright
