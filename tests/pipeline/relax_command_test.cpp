// loopwright relax as a user meets it: a saved state says what it was knitted from, also after it went on.
#include <gtest/gtest.h>

#include "outputs/state.hpp"
#include "piece.hpp"
#include "pipeline/run_command.hpp"

namespace loopwright {
namespace {

TEST(RelaxCommand, StatesKeepTheirNotation) {
  const std::string plain =
      ";!vermiculation-1\n;;Yarn-A: wool 2/28 Nm\n;;Loop-Length: 5.9 mm\n;;Size: 8 wales x 6 courses\ng\n";
  const TemporaryFolder folder;
  folder.write("plain.verm", plain);
  ASSERT_EQ(run_command({"relax", "plain.verm", "--periodic", "-o", "one.h5"}, folder).status, 0);
  ASSERT_EQ(run_command({"relax", "one.h5", "-o", "two.h5"}, folder).status, 0);
  for (const char* name : {"one.h5", "two.h5"}) {
    const State state = read_state(folder.file(name));
    ASSERT_TRUE(state.texts.contains(state_notation)) << name;
    EXPECT_EQ(state.texts.at(state_notation), plain);
    EXPECT_EQ(state.texts.at(state_notation_suffix), ".verm");
  }
}

}  // namespace
}  // namespace loopwright
