// Real knitout files that others wrote. They are read where they lie and never copied.
#include <gmock/gmock.h>

#include <chrono>
#include <map>
#include <set>
#include <tuple>

#include "notation/scan.hpp"
#include "notation/write_knitout.hpp"
#include "notation_test.hpp"

namespace loopwright {
namespace {

std::vector<std::filesystem::path> knitout_files() {
  std::vector<std::filesystem::path> files;
  for (const char* folder : {"files", "knitdb"}) {
    if (!std::filesystem::is_directory(corpus() / folder)) continue;
    for (const auto& entry : std::filesystem::directory_iterator(corpus() / folder)) {
      const std::string suffix = entry.path().extension().string();
      if (suffix == ".k" || suffix == ".knitout") files.push_back(entry.path());
    }
  }
  std::sort(files.begin(), files.end());
  return files;
}

// Files that the manifest calls wrong in form: tagged so, or refused by the established converter for their
// first line.
std::set<std::string> wrong_in_form() {
  std::set<std::string> names;
  std::istringstream manifest(text_of(corpus() / "MANIFEST.tsv"));
  std::string line;
  while (std::getline(manifest, line)) {
    // a missing Carriers header alone is a warning to readers (docs/knitout.md)
    if (line.find("'Carriers:' header is required") != line.npos) continue;
    if (line.find("\tINVALID: syntax/header\t") != line.npos ||
        line.find("not a valid knitout magic") != line.npos) {
      names.insert(line.substr(0, line.find('\t')));
    }
  }
  return names;
}

// Counts first words with iostreams alone, as `sed 's/;.*//' | awk '{print $1}' | sort | uniq -c` would.
std::map<std::string, int> counted_by_hand(const std::string& text) {
  std::map<std::string, int> counts;
  std::istringstream lines(text);
  std::string line;
  while (std::getline(lines, line)) {
    std::istringstream words(line.substr(0, line.find(';')));
    std::string first;
    if (words >> first) ++counts[first.starts_with("x-") ? "extension" : first];
  }
  return counts;
}

std::map<std::string, int> counted(const Program& program) {
  std::map<std::string, int> counts;
  for (const Instruction& instruction : program.instructions) ++counts[std::string(name_of(instruction.op))];
  return counts;
}

class Corpus : public testing::Test {
 protected:
  void SetUp() override {
    files_ = knitout_files();
    if (files_.empty()) GTEST_SKIP() << "the corpus of real programmes is absent: " << corpus();
  }
  std::vector<std::filesystem::path> files_;
};

TEST_F(Corpus, IsComplete) { EXPECT_EQ(files_.size(), 114u); }

TEST_F(Corpus, ReadsWithoutAnErrorUnlessTheManifestCallsItWrongInForm) {
  const std::set<std::string> wrong = wrong_in_form();
  EXPECT_EQ(wrong.size(), 4u);
  for (const auto& file : files_) {
    Diagnostics diagnostics(file.filename());
    read_program(file, diagnostics);
    EXPECT_EQ(diagnostics.ok(), !wrong.contains("files/" + file.filename().string())) << said(diagnostics);
  }
}

TEST_F(Corpus, CountsOfOperationsAgreeWithAnIndependentCount) {
  int operations = 0;
  for (const auto& file : files_) {
    const std::string text = text_of(file);
    Diagnostics diagnostics(file.filename());
    const Program program = read_knitout(text, diagnostics);
    EXPECT_EQ(counted(program), counted_by_hand(text)) << file;
    operations += static_cast<int>(program.instructions.size());
  }
  EXPECT_GT(operations, 1'000'000);
}

TEST_F(Corpus, WritesWhatItRead) {
  for (const auto& file : files_) {
    if (std::filesystem::file_size(file) > 200'000) continue;
    Diagnostics diagnostics(file.filename()), again(file.filename());
    const Program program = read_knitout(text_of(file), diagnostics);
    if (!diagnostics.ok()) continue;
    const Program copy = read_knitout(write_knitout(program), again);
    EXPECT_EQ(said(again).find("error"), std::string::npos) << said(again);
    EXPECT_EQ(listing(copy, 0, 100'000'000), listing(program, 0, 100'000'000)) << file;
  }
}

TEST_F(Corpus, FiftyThousandLinesTakeWellUnderAFifthOfASecond) {
  const std::string text = text_of(corpus() / "files" / "entrelac.knitout");
  const auto lines = std::count(text.begin(), text.end(), '\n');
  ASSERT_GT(lines, 50'000);
  double best = 1e9;
  for (int i = 0; i < 3; ++i) {
    const auto start = std::chrono::steady_clock::now();
    Diagnostics diagnostics("entrelac.knitout");
    const Program program = read_knitout(text, diagnostics);
    const std::chrono::duration<double> wall = std::chrono::steady_clock::now() - start;
    best = std::min(best, wall.count());
    EXPECT_GT(program.instructions.size(), 50'000u);
  }
  RecordProperty("milliseconds", std::to_string(best * 1e3));
  EXPECT_LT(best, 0.2);
}

}  // namespace
}  // namespace loopwright
