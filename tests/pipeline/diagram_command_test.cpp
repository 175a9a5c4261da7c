// loopwright diagram as a user meets it: what it draws, what it refuses, and that nothing half-written is
// left.
#include <gmock/gmock.h>

#include "run_command.hpp"

namespace loopwright {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

constexpr const char* rib = ";!vermiculation-1\n;;Size: 24 x 24\nge\n";
constexpr const char* knitout =
    ";!knitout-2\n;;Carriers: 1\nin 1\nknit + f1 1\nknit + f2 1\nknit - f2 1\nknit - f1 1\nxfer f1 b1\nout "
    "1\n";

TEST(DiagramCommand, DrawsFabricFilesAndKnitout) {
  const TemporaryFolder folder;
  folder.write("rib.verm", rib);
  folder.write("two.k", knitout);
  EXPECT_EQ(run_command({"diagram", "rib.verm", "-o", "rib.svg"}, folder).status, 0);
  EXPECT_THAT(file_content(folder.file("rib.svg")), testing::StartsWith("<svg "));
  const CommandOutcome whole = run_command({"diagram", "rib.verm", "-o", "-", "--whole"}, folder);
  EXPECT_EQ(whole.status, 0);
  EXPECT_THAT(whole.out, HasSubstr("course 24</title>"));
  const CommandOutcome passes =
      run_command({"diagram", "two.k", "-o", "-", "--first", "2", "--passes", "1"}, folder);
  EXPECT_EQ(passes.status, 0);
  EXPECT_THAT(passes.out, HasSubstr("line 6: course 2</title>"));
  EXPECT_THAT(passes.out, testing::Not(HasSubstr("line 4")));
  EXPECT_THAT(passes.err, HasSubstr("1 of 3 passes are drawn"));
}

TEST(DiagramCommand, SaysWhatIsWrongAndWritesNothing) {
  const TemporaryFolder folder;
  folder.write("letter.verm", ";!vermiculation-1\ngq\n");
  folder.write("facing.verm", ";!vermiculation-1\n;;Gating: opposite\ng/e\n");
  folder.write("two.k", knitout);
  const auto said = [&](const std::vector<std::string>& request) {
    std::vector<std::string> arguments{"diagram", "-o", "out.svg"};
    for (const std::string& argument : request) arguments.push_back(argument);
    const CommandOutcome outcome = run_command(arguments, folder);
    EXPECT_EQ(outcome.status, 1) << outcome.err;
    return outcome.err;
  };
  EXPECT_THAT(said({"letter.verm"}), HasSubstr("letter.verm:2:2: error: unknown letter 'q'"));
  EXPECT_THAT(said({"facing.verm"}), HasSubstr("both take yarn in one pass"));
  EXPECT_THAT(said({"missing.verm"}), HasSubstr("there is no such file"));
  EXPECT_THAT(said({"two.k", "--size", "4x4"}), HasSubstr("knitout has no repeat"));
  EXPECT_THAT(said({"two.k", "--first", "9"}), HasSubstr("there is no pass to draw"));
  EXPECT_THAT(folder.names(), ElementsAre("facing.verm", "letter.verm", "two.k"));
  EXPECT_THAT(run_command({"diagram", "two.k", "-o", "missing/out.svg"}, folder).err,
              HasSubstr("missing/out.svg"));
}

}  // namespace
}  // namespace loopwright
