// Damaged and hostile input: the readers come back in time, say where things are wrong, and never more than
// they know.
#include <gmock/gmock.h>

#include <chrono>
#include <random>

#include "notation_test.hpp"

namespace loopwright {
namespace {

using testing::HasSubstr;

std::vector<std::string> seeds() {
  std::vector<std::string> texts;
  std::vector<std::filesystem::path> files;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(source_dir() / "examples"))
    if (entry.path().extension() == ".verm" || entry.path().extension() == ".k")
      files.push_back(entry.path());
  for (const char* name : {"icord-bind-off.k", "cross-test.k", "crlf.k", "split_pocket.k", "bad_ko.k"}) {
    if (std::filesystem::exists(corpus() / "files" / name)) files.push_back(corpus() / "files" / name);
  }
  std::sort(files.begin(), files.end());
  for (const auto& file : files) {
    if (std::filesystem::is_regular_file(file)) texts.push_back(text_of(file).substr(0, 20'000));
  }
  return texts;
}

// What must hold for any text: places lie in it, indices in their ranges, no error means something to knit.
void expect_sound(const std::string& text, const Program& program, const Diagnostics& diagnostics) {
  const auto lines = 1 + std::count(text.begin(), text.end(), '\n');
  for (const Diagnostic& each : diagnostics.list()) {
    ASSERT_LE(each.at.line, lines) << each.message;
    ASSERT_LE(each.at.column, static_cast<int>(text.size()) + 1) << each.message;
    ASSERT_LT(each.message.size(), 2000u);
    for (const char c : each.message) ASSERT_TRUE(c != '\0' && c != '\n') << each.message;
  }
  ASSERT_EQ(program.carriers.size(), program.yarns.size());
  for (const Instruction& each : program.instructions) {
    for (const CarrierId id : each.carriers) ASSERT_LT(id.position(), program.carriers.size());
    ASSERT_LE(each.at.line, lines);
  }
  ASSERT_LE(program.window.first_instruction + program.window.instructions,
            static_cast<int>(program.instructions.size()));
}

void read_both_ways(const std::string& text) {
  FabricOptions options;
  options.most_instructions = 50'000;
  Diagnostics as_knitout("x.k"), as_fabric("x.verm"), by_magic("x");
  expect_sound(text, read_knitout(text, as_knitout), as_knitout);
  expect_sound(text, read_vermiculation(text, as_fabric, options), as_fabric);
  expect_sound(text, read_program_text(text, "", by_magic, options), by_magic);
}

TEST(Robustness, TruncatedTexts) {
  for (const std::string& seed : seeds()) {
    const std::size_t step = 1 + seed.size() / 60;
    for (std::size_t size = 0; size < seed.size(); size += step) read_both_ways(seed.substr(0, size));
  }
}

TEST(Robustness, FlippedBits) {
  std::mt19937 random(7);
  for (const std::string& seed : seeds()) {
    for (int round = 0; round < 40; ++round) {
      std::string text = seed;
      for (int flips = 1 + round % 8; flips > 0; --flips) {
        text[random() % text.size()] ^= static_cast<char>(1u << (random() % 8));
      }
      read_both_ways(text);
    }
  }
}

TEST(Robustness, LinesTornOutAndSwapped) {
  std::mt19937 random(11);
  for (const std::string& seed : seeds()) {
    std::vector<std::string> lines;
    std::istringstream stream(seed);
    for (std::string line; std::getline(stream, line);) lines.push_back(line);
    for (int round = 0; round < 20; ++round) {
      std::vector<std::string> torn = lines;
      for (int swaps = 0; swaps < 4; ++swaps)
        std::swap(torn[random() % torn.size()], torn[random() % torn.size()]);
      torn.erase(torn.begin() + static_cast<std::ptrdiff_t>(random() % torn.size()));
      std::string text;
      for (const std::string& line : torn) text += line + "\n";
      read_both_ways(text);
    }
  }
}

TEST(Robustness, Noise) {
  std::mt19937 random(13);
  const std::string letters = "gevnTtRr0123456789.-()*/&:<>[]+; \n\tA=";
  for (int round = 0; round < 300; ++round) {
    std::string bytes(random() % 600, '\0'), notation = ";!vermiculation-1\n";
    for (char& c : bytes) c = static_cast<char>(random() % 256);
    read_both_ways(bytes);
    read_both_ways(";!knitout-2\n;;Carriers: 1\n" + bytes);
    for (int i = 0; i < 60; ++i) notation += letters[random() % letters.size()];
    read_both_ways(notation);
  }
}

double seconds_to_read(const std::string& text, Diagnostics& diagnostics) {
  const auto start = std::chrono::steady_clock::now();
  read_program_text(text, ".k", diagnostics);
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

TEST(Robustness, VeryLongLinesTakeLinearTime) {
  const std::size_t size = 10'000'000;
  const std::string fabric = ";!vermiculation-1\n", knitout = ";!knitout-2\n;;Carriers: 1\n";
  const auto repeated = [&](const std::string& unit) {
    std::string text;
    while (text.size() < size) text += unit;
    return text;
  };
  const std::vector<std::string> texts{
      fabric + std::string(size, 'g'),         fabric + std::string(size, '?'),
      fabric + std::string(size, '('),         fabric + repeated("g&"),
      fabric + repeated("A+") + ": g",         fabric + ";;Yarn-A: " + repeated("a="),
      fabric + ";;Size: " + repeated("9"),     fabric + repeated("R1"),
      knitout + std::string(size, 'x'),        knitout + "knit + f1 " + repeated("1 "),
      knitout + "knit + f" + repeated("9"),    knitout + ";;Carriers: " + repeated("a "),
      knitout + ";;Yarn-1: " + repeated("="),  knitout + "x-" + repeated("y "),
      knitout + ";" + std::string(size, '\0'), knitout + "rack " + repeated("1"),
  };
  for (const std::string& text : texts) {
    Diagnostics diagnostics("long");
    EXPECT_LT(seconds_to_read(text, diagnostics), 10) << text.substr(0, 40);
    for (const Diagnostic& each : diagnostics.list()) EXPECT_LT(each.message.size(), 2000u);
  }
}

TEST(Robustness, ManyErrorsAreCountedAndNotKept) {
  std::string text = ";!knitout-2\n;;Carriers: 1\n";
  for (int i = 0; i < 200'000; ++i) text += "purl + f1 1\n";
  Diagnostics diagnostics("many.k");
  EXPECT_LT(seconds_to_read(text, diagnostics), 5);
  EXPECT_EQ(diagnostics.errors(), 200'000);
  EXPECT_EQ(diagnostics.list().size(), static_cast<std::size_t>(Diagnostics::most_kept));
}

TEST(Robustness, ReadingGoesOnAfterAnError) {
  Diagnostics diagnostics("on.k");
  const Program program = read_knitout(
      ";!knitout-2\n;;Carriers: 1\nin 1\nknit + f1 1\npurl + f2 1\nknit * f3 1\nknit + f4 1\nout 1\n",
      diagnostics);
  EXPECT_EQ(listing(program), "in 1; knit + f1 1; knit + f4 1; out 1");
  EXPECT_EQ(diagnostics.errors(), 2);
}

TEST(Robustness, MessagesShowNoControlBytes) {
  Diagnostics diagnostics("x.k");
  read_knitout(std::string(";!knitout-2\n;;Carriers: 1\nkn\0it\x1b[31m + f1 1\n", 46), diagnostics);
  EXPECT_THAT(said(diagnostics), HasSubstr("unknown operation 'kn\\x00it\\x1b[31m'"));
}

}  // namespace
}  // namespace loopwright
