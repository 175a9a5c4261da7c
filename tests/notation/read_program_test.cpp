#include "notation/read_program.hpp"

#include <gmock/gmock.h>
#include <unistd.h>

#include "notation_test.hpp"

namespace loopwright {
namespace {

using testing::HasSubstr;

class Folder : public testing::Test {
 protected:
  Folder()
      : path_(std::filesystem::temp_directory_path() / ("loopwright_notation_" + std::to_string(getpid()))) {
    std::filesystem::create_directories(path_);
  }
  ~Folder() override { std::filesystem::remove_all(path_); }

  std::filesystem::path file(const std::string& name, const std::string& text) const {
    std::ofstream(path_ / name, std::ios::binary) << text;
    return path_ / name;
  }
  static std::string said_of(const std::filesystem::path& file) {
    Diagnostics diagnostics("file");
    EXPECT_TRUE(read_program(file, diagnostics).instructions.empty());
    EXPECT_FALSE(diagnostics.ok());
    return said(diagnostics);
  }

  std::filesystem::path path_;
};

TEST_F(Folder, TheMagicLineDecidesBeforeTheSuffix) {
  const std::string plain = ";!vermiculation-1\n;;Edges: free\ng\n";
  for (const char* name : {"a.verm", "a.k", "a.txt", "a"}) {
    Diagnostics diagnostics(name);
    const Program program = read_program(file(name, plain), diagnostics);
    EXPECT_EQ(listing(program), "in A; knit + f0 A; out A") << name << said(diagnostics);
    EXPECT_EQ(program.file, (path_ / name).string());
  }
  Diagnostics diagnostics("b.verm");
  EXPECT_EQ(listing(read_program(file("b.verm", ";!knitout-2\n;;Carriers: 1\nin 1\n"), diagnostics)), "in 1");
}

TEST_F(Folder, TheSuffixDecidesWithoutAMagicLine) {
  Diagnostics fabric("a.verm"), knitout("a.k");
  read_program(file("a.verm", "g\n"), fabric);
  EXPECT_THAT(said(fabric), HasSubstr(";!vermiculation-1"));
  read_program(file("a.k", "in 1\n"), knitout);
  EXPECT_THAT(said(knitout), HasSubstr(";!knitout-2"));
  EXPECT_THAT(said_of(file("a.txt", "hello\n")),
              HasSubstr("file:1:1: error: neither a fabric file nor a knitout file"));
}

TEST_F(Folder, FilesThatCannotBeRead) {
  EXPECT_THAT(said_of(path_ / "missing.k"), HasSubstr("error: there is no such file"));
  EXPECT_THAT(said_of(path_), HasSubstr("error: this is a folder"));
  EXPECT_THAT(said_of(file("empty.k", "")), HasSubstr("error: the file is empty"));
  EXPECT_THAT(said_of(file("empty.verm", "")), HasSubstr("error: the file is empty"));
}

TEST_F(Folder, HugeFilesAreRefused) {
  // a file with a hole: no disk is used
  const std::filesystem::path huge = file("huge.k", ";!knitout-2\n");
  std::filesystem::resize_file(huge, largest_file_bytes + 1);
  EXPECT_THAT(said_of(huge), HasSubstr("error: the file is larger than 512 MiB"));
}

}  // namespace
}  // namespace loopwright
