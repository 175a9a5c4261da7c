// Every example and every block of docs/notation.md is read, and what it makes is compared.
#include <gmock/gmock.h>

#include "notation_test.hpp"

namespace loopwright {
namespace {

std::vector<std::filesystem::path> examples() {
  std::vector<std::filesystem::path> files;
  for (const char* folder : {"", "structures"}) {
    for (const auto& entry : std::filesystem::directory_iterator(source_dir() / "examples" / folder)) {
      const std::string suffix = entry.path().extension().string();
      if (suffix == ".verm" || suffix == ".k") files.push_back(entry.path());
    }
  }
  std::sort(files.begin(), files.end());
  return files;
}

Program example(const std::filesystem::path& file, std::optional<Edges> edges = {}) {
  Diagnostics diagnostics(file.filename());
  FabricOptions options;
  options.edges = edges;
  Program program = read_program(file, diagnostics, options);
  EXPECT_EQ(said(diagnostics), "");
  return program;
}

Program structure(const std::string& name) {
  return example(source_dir() / "examples" / "structures" / name);
}

// How many operations of the wanted piece are of that kind.
int wanted(const Program& program, Op op) {
  int count = 0;
  for (int i = 0; i < static_cast<int>(program.instructions.size()); ++i) {
    const Instruction& each = program.instructions[static_cast<std::size_t>(i)];
    const ProgramWindow& window = program.window;
    const bool inside = window.needles == 0 || (i >= window.first_instruction &&
                                                i < window.first_instruction + window.instructions &&
                                                each.needle.index >= window.first_needle &&
                                                each.needle.index < window.first_needle + window.needles);
    if (inside && each.op == op) ++count;
  }
  return count;
}

TEST(Examples, AreReadWithoutAWord) {
  EXPECT_GE(examples().size(), 29u);
  for (const auto& file : examples()) {
    const Program program = example(file);
    EXPECT_GT(wanted(program, Op::knit), 40) << file;
  }
}

bool is_no_cell(const std::filesystem::path& file) {
  return file.filename() == "tube.verm" || file.filename() == "intarsia.verm";
}

TEST(Examples, CloseToPeriodicCells) {
  for (const auto& file : examples()) {
    // a tube has no sides to close, a field of intarsia ends beside another, knitout has no repeat
    if (file.extension() != ".verm" || is_no_cell(file)) continue;
    const Program program = example(file, Edges::periodic);
    EXPECT_GT(program.window.needles, 0) << file;
    EXPECT_EQ(program.window.needles % program.settings.repeat_wales, 0) << file;
  }
}

TEST(Examples, HaveTheLoopsOfTheirStructure) {
  EXPECT_EQ(wanted(structure("plain.verm"), Op::knit), 16 * 16);
  EXPECT_EQ(wanted(structure("garter.verm"), Op::xfer),
            16 * 16);  // every loop changes over, once in each course
  EXPECT_EQ(wanted(structure("moss.verm"), Op::xfer), 16 * 16);
  EXPECT_EQ(wanted(structure("half_cardigan.verm"), Op::knit), 12 * (8 * 2 + 8));
  EXPECT_EQ(wanted(structure("half_cardigan.verm"), Op::tuck), 12 * 8);
  EXPECT_EQ(wanted(structure("full_cardigan.verm"), Op::tuck), 12 * 16);
  EXPECT_EQ(wanted(structure("full_cardigan.verm"), Op::knit), 12 * 16);
  EXPECT_EQ(wanted(structure("interlock.verm"), Op::knit), 12 * 16);
  EXPECT_EQ(wanted(structure("half_milano.verm"), Op::knit), 12 * (8 * 2 + 8));
  EXPECT_EQ(wanted(structure("milano.verm"), Op::knit), 12 * 6 * 4);
  EXPECT_EQ(wanted(structure("derby_rib.verm"), Op::knit), 16 * (6 + 3) * 2);
  EXPECT_EQ(wanted(structure("cable.verm"), Op::xfer),
            2 * 3 * 4 * 2);  // two cables, three crossings, there and back
  EXPECT_EQ(wanted(structure("lace.verm"), Op::xfer), 3 * 4 * 2 * 2);
  EXPECT_EQ(wanted(structure("tube.verm"), Op::knit), 12 * 2 * 12);
  EXPECT_EQ(wanted(structure("birdseye_jacquard.verm"), Op::knit), 12 * 16 * 2);
}

TEST(Examples, AreWrittenAsKnitoutAndReadBack) {
  for (const auto& file : examples()) {
    const Program program = example(file);
    Diagnostics diagnostics(file.filename());
    const Program copy = read_knitout(write_knitout(program), diagnostics);
    EXPECT_TRUE(diagnostics.ok()) << said(diagnostics);
    EXPECT_EQ(listing(copy), listing(program)) << file;
    EXPECT_EQ(copy.settings.loop_length_mm, program.settings.loop_length_mm);
    EXPECT_EQ(copy.settings.gauge_npi, program.settings.gauge_npi);
    for (std::size_t i = 0; i < program.yarns.size(); ++i) {
      EXPECT_EQ(copy.yarns[i].bend_stiffness_mN_mm2, program.yarns[i].bend_stiffness_mN_mm2);
      EXPECT_EQ(copy.yarns[i].material, program.yarns[i].material);
      EXPECT_EQ(copy.yarns[i].colour, program.yarns[i].colour);
    }
  }
}

struct Block {
  std::string language, text;
  int line = 0;
};

std::vector<Block> blocks_of_the_page() {
  std::vector<Block> blocks;
  std::istringstream lines(text_of(source_dir() / "docs" / "notation.md"));
  bool inside = false;
  int number = 0;
  for (std::string line; std::getline(lines, line);) {
    ++number;
    if (line.starts_with("```")) {
      inside = !inside;
      if (inside) blocks.push_back({line.substr(3), "", number});
    } else if (inside) {
      blocks.back().text += line + "\n";
    }
  }
  return blocks;
}

TEST(NotationPage, EveryBlockIsReadAndMakesWhatThePageSays) {
  int compared = 0, fabric_files = 0;
  const std::vector<Block> blocks = blocks_of_the_page();
  for (std::size_t i = 0; i < blocks.size(); ++i) {
    const Block& block = blocks[i];
    Diagnostics diagnostics("docs/notation.md block at " + std::to_string(block.line));
    if (block.language == "knitout-file") {
      EXPECT_FALSE(read_knitout(block.text, diagnostics).instructions.empty());
    } else if (block.language == "verm") {
      ++fabric_files;
      const bool whole = block.text.starts_with(";!");
      const Program program =
          read_vermiculation((whole ? "" : ";!vermiculation-1\n;;Edges: free\n") + block.text, diagnostics);
      EXPECT_FALSE(program.instructions.empty());
      if (i + 1 < blocks.size() && blocks[i + 1].language == "knitout") {
        std::string written = write_knitout(program);
        written.erase(0, written.find("in A"));
        EXPECT_EQ(written, blocks[i + 1].text) << "block at line " << block.line;
        ++compared;
      }
    }
    EXPECT_EQ(said(diagnostics), "");
  }
  EXPECT_GE(fabric_files, 10);
  EXPECT_GE(compared, 6);
}

}  // namespace
}  // namespace loopwright
