#include "outputs/atomic_file.hpp"

#include <gmock/gmock.h>

#include <limits>

#include "outputs/image.hpp"
#include "outputs/write_csv.hpp"
#include "outputs/write_fabric.hpp"
#include "outputs/write_json.hpp"
#include "outputs/write_obj.hpp"
#include "plain_fabric.hpp"
#include "temporary_folder.hpp"

namespace loopwright {
namespace {

using test::content;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

class AtomicFileTest : public test::TemporaryFolder {};

template <class Call>
std::string message_of(Call call) {
  try {
    call();
  } catch (const std::exception& error) {
    return error.what();
  }
  return "no error";
}

TEST_F(AtomicFileTest, AppearsOnlyAtCommit) {
  const auto path = in_folder("a.txt");
  {
    AtomicFile file(path);
    file.stream() << "new";
    file.stream().flush();
    EXPECT_FALSE(std::filesystem::exists(path));
    file.commit();
    EXPECT_EQ(content(path), "new");
  }
  EXPECT_THAT(names(), ElementsAre("a.txt"));
}

TEST_F(AtomicFileTest, WithoutCommitTheOldFileStaysAndNothingElse) {
  const auto path = in_folder("a.txt");
  std::ofstream(path) << "old";
  {
    AtomicFile file(path);
    file.stream() << "half of the new";
  }
  EXPECT_EQ(content(path), "old");
  EXPECT_THAT(names(), ElementsAre("a.txt"));
}

TEST_F(AtomicFileTest, SaysWhatIsWrongWithThePlace) {
  EXPECT_THAT(message_of([&] { AtomicFile file(in_folder("missing/a.txt")); }), HasSubstr("does not exist"));
  EXPECT_THAT(message_of([&] { AtomicFile file(folder_); }), HasSubstr("it is a folder"));
  EXPECT_THAT(message_of([&] { AtomicFile file(""); }), HasSubstr("no file name"));
  std::ofstream(in_folder("file")) << "x";
  EXPECT_THAT(message_of([&] { AtomicFile file(in_folder("file") / "a.txt"); }), HasSubstr("cannot write"));
}

// A full disk: /dev/full takes no byte. The link makes it look like a plain path to the writer.
TEST_F(AtomicFileTest, FullDiskIsAnErrorAndLeavesNothing) {
  if (!std::filesystem::exists("/dev/full")) GTEST_SKIP() << "This system has no /dev/full.";
  const auto path = in_folder("full.obj");
  std::filesystem::create_symlink("/dev/full", path);
  EXPECT_THROW(write_obj_lines(path, test::straight_yarn(10)), FileError);
  EXPECT_THAT(names(), ElementsAre("full.obj"));
  EXPECT_TRUE(std::filesystem::is_character_file("/dev/full"));
}

TEST_F(AtomicFileTest, FollowsLinksAndWritesToDevices) {
  std::ofstream(in_folder("real.txt")) << "old";
  std::filesystem::create_symlink("real.txt", in_folder("link.txt"));
  AtomicFile file(in_folder("link.txt"));
  file.stream() << "new";
  file.commit();
  EXPECT_EQ(content(in_folder("real.txt")), "new");
  EXPECT_TRUE(std::filesystem::is_symlink(in_folder("link.txt")));
  write_obj_lines("/dev/null", test::straight_yarn(10));
  EXPECT_TRUE(std::filesystem::is_character_file("/dev/null"));
}

TEST_F(AtomicFileTest, NoWriterLeavesAnythingWhereItFails) {
  Fabric broken = test::plain_piece(2, 2);
  broken.yarns[0].control_points[3].x = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(write_fabric(in_folder("a.h5"), broken), std::invalid_argument);
  EXPECT_THROW(write_obj_tubes(in_folder("a.tubes.obj"), test::straight_yarn(5), {1, 2, {1, 1}}),
               std::invalid_argument);
  EXPECT_THROW(write_csv(in_folder("a.csv"), {{"a", "b"}, {{1.0}}}), std::invalid_argument);
  EXPECT_THROW(write_png(in_folder("a.png"), Image{}), FileError);
  EXPECT_THAT(names(), IsEmpty());
}

TEST_F(AtomicFileTest, UnknownSuffixListsTheKnownOnes) {
  const std::string message = message_of([&] { write_fabric(in_folder("a.xyz"), test::straight_yarn(5)); });
  for (const char* suffix : {".obj", ".tubes.obj", ".h5", ".loop", "a.xyz"})
    EXPECT_THAT(message, HasSubstr(suffix));
  EXPECT_EQ(fabric_format("A.TUBES.OBJ"), FabricFormat::obj_tubes);
  EXPECT_EQ(fabric_format("tubes.obj"), FabricFormat::obj_lines);
  EXPECT_EQ(fabric_format("x/swatch.loop"), FabricFormat::state);
  EXPECT_THAT(names(), IsEmpty());
}

TEST_F(AtomicFileTest, JsonKeepsOrderAndBits) {
  const double third = 1.0 / 3, tiny = 5e-324;
  const JsonObject results{{"loops", 12},
                           {"width_mm", third},
                           {"smallest", tiny},
                           {"residual", std::numeric_limits<double>::quiet_NaN()},
                           {"yarn_m", std::vector<double>{1.5, 2}},
                           {"yarns", JsonArray{JsonObject{{"name", "A"}, {"m", 0.1}}, nullptr}},
                           {"converged", true},
                           {"a", "quote \" and line\n"}};
  write_json(in_folder("r.json"), results);
  const std::string text = content(in_folder("r.json"));
  EXPECT_EQ(text,
            "{\n  \"loops\": 12,\n  \"width_mm\": 0.3333333333333333,\n  \"smallest\": 5e-324,\n  "
            "\"residual\": null,\n"
            "  \"yarn_m\": [\n    1.5,\n    2.0\n  ],\n  \"yarns\": [\n    {\n      \"name\": \"A\",\n      "
            "\"m\": 0.1\n"
            "    },\n    null\n  ],\n  \"converged\": true,\n  \"a\": \"quote \\\" and line\\n\"\n}\n");
  EXPECT_EQ(std::stod("0.3333333333333333"), third);
}

TEST_F(AtomicFileTest, CsvQuotesNamesAndLeavesNaNEmpty) {
  write_csv(in_folder("t.csv"),
            {{"strain", "stress, warp"}, {{0.1, 2.5e-7}, {0.2, std::numeric_limits<double>::quiet_NaN()}}});
  EXPECT_EQ(content(in_folder("t.csv")), "strain,\"stress, warp\"\n0.1,2.5e-07\n0.2,\n");
}

}  // namespace
}  // namespace loopwright
