// A fabric file made knittable: the machines take it, and it is whole. (That the pattern keeps its yarn graph
// is for tests/topology to say.)
#include <gmock/gmock.h>

#include <filesystem>
#include <fstream>
#include <sstream>

#include "machine/knittable.hpp"
#include "machine/machine_of.hpp"
#include "machine/review.hpp"
#include "notation/read_program.hpp"
#include "notation/write_knitout.hpp"

namespace loopwright {
namespace {

std::string text_of(const std::filesystem::path& file) {
  std::ostringstream text;
  text << std::ifstream(file, std::ios::binary).rdbuf();
  return text.str();
}

std::vector<std::filesystem::path> fabric_files() {
  std::vector<std::filesystem::path> files;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(LOOPWRIGHT_SOURCE_DIR "/examples"))
    if (entry.path().extension() == ".verm") files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  return files;
}

struct Written {
  Diagnostics said{"x.k"};
  Program program;
  KnittingRecord record;
};

// As whoever gets the file reads it.
Written read_back(const std::string& text, MachineKind machine) {
  Written written;
  written.program = read_knitout(text, written.said);
  written.record = run_machine(written.program, written.said);
  check_machine_rules(written.program, machine, written.said);
  return written;
}

void expect_knittable(const std::string& text, Edges edges, MachineKind machine, const std::string& name) {
  SCOPED_TRACE(name + (machine == MachineKind::shima ? " on a Shima" : " on a Kniterate") +
               (edges == Edges::free ? "" : ", bound off"));
  Diagnostics said;
  FabricOptions options;
  options.edges = edges;
  const Program fabric = read_program_text(text, ".verm", said, options);
  ASSERT_TRUE(said.ok()) << said;
  const KnittableProgram knittable = make_knittable(fabric, machine, said);
  ASSERT_TRUE(said.ok()) << said;
  Written written = read_back(write_knitout(knittable.program), machine);
  ASSERT_TRUE(written.said.ok()) << written.said;
  EXPECT_EQ(written.program.instructions.size(), knittable.program.instructions.size());

  // It is whole: nothing is left, every needle that it casts on is knitted off, each loop holds.
  EXPECT_TRUE(written.record.held.empty());
  for (const CarrierPlace& carrier : written.record.carriers) EXPECT_FALSE(carrier.in);
  for (const LoopRecord& loop : written.record.loops) {
    if (loop.instruction < knittable.pattern_begin) {
      EXPECT_EQ(loop.fate, LoopFate::cast_off) << to_string(loop.formed().needle);
    }
  }
  review(written.program, written.record, written.said);
  for (const Diagnostic& d : written.said.list()) {
    EXPECT_EQ(d.message.find("neighbouring empty needles"), std::string::npos) << d.message;
    EXPECT_EQ(d.message.find("hook"), std::string::npos) << d.message;
  }
}

bool is_plated(const Program& fabric) {
  for (const Instruction& each : fabric.instructions)
    if (each.op >= Op::knit && each.carriers.size() > 1) return true;
  return false;
}

TEST(Knittable, every_example_is_taken_by_both_machines) {
  int found = 0;
  for (const std::filesystem::path& file : fabric_files()) {
    Diagnostics said;
    const std::string text = text_of(file);
    const bool plated = is_plated(read_program_text(text, ".verm", said));
    for (const Edges edges : {Edges::free, Edges::bound_off}) {
      expect_knittable(text, edges, MachineKind::shima, file.filename());
      if (!plated) expect_knittable(text, edges, MachineKind::kniterate, file.filename());
    }
    ++found;
  }
  EXPECT_GE(found, 15);
}

std::string knitout_of(const std::string& courses, MachineKind machine, Edges edges = Edges::free) {
  Diagnostics said;
  FabricOptions options;
  options.edges = edges;
  const Program fabric =
      read_program_text(";!vermiculation-1\n;;Yarn-A: wool 2/28 Nm\n" + courses, ".verm", said, options);
  const std::string text = write_knitout(make_knittable(fabric, machine, said).program);
  EXPECT_TRUE(said.ok()) << said;
  // the body without the marks of where each line came from
  std::string body;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);)
    if (!line.starts_with(";")) body += line.substr(0, line.find(" ;!source")) + "; ";
  return body;
}

TEST(Knittable, plain_is_tucked_on_there_and_back) {
  EXPECT_EQ(knitout_of(";;Size: 4 wales x 1 courses\ng\n", MachineKind::shima),
            "inhook 1; tuck - f3 1; tuck - f1 1; tuck + f0 1; tuck + f2 1; releasehook 1; knit - f3 1; "
            "knit - f2 1; knit - f1 1; knit - f0 1; knit + f0 1; knit + f1 1; knit + f2 1; knit + f3 1; "
            "outhook 1; drop f0; drop f1; drop f2; drop f3; ");
  EXPECT_EQ(knitout_of(";;Size: 4 wales x 1 courses\ng\n", MachineKind::kniterate),
            "in 1; tuck + f0 1; tuck + f2 1; tuck - f3 1; tuck - f1 1; knit + f0 1; knit + f1 1; "
            "knit + f2 1; knit + f3 1; out 1; drop f0; drop f1; drop f2; drop f3; ");
}

TEST(Knittable, each_machine_gets_its_all_needle_position) {
  EXPECT_THAT(
      knitout_of(";;Size: 2 wales x 1 courses\ng/e\n", MachineKind::shima),
      testing::HasSubstr("rack 0.25; inhook 1; tuck - b1 1; tuck - f0 1; tuck + b0 1; tuck + f1 1; "));
  EXPECT_THAT(knitout_of(";;Size: 2 wales x 1 courses\ng/e\n", MachineKind::kniterate),
              testing::HasSubstr("rack 0.5; in 1; knit + f0 1; knit + b1 1; knit - f1 1; knit - b0 1; "));
}

TEST(Knittable, a_tube_stays_open) {
  EXPECT_THAT(knitout_of(";;Size: 2 wales x 1 courses\n> g/. & < ./e\n", MachineKind::kniterate),
              testing::StartsWith("in 1; tuck + f0 1; tuck - b1 1; tuck + f1 1; tuck - b0 1; knit + f0 1; "));
}

TEST(Knittable, a_needle_that_waits_for_a_transfer_is_not_cast_on) {
  EXPECT_EQ(knitout_of(";;Size: 2 wales x 2 courses\ng\ne\n", MachineKind::kniterate),
            "in 1; tuck + f0 1; tuck - f1 1; knit + f0 1; knit + f1 1; xfer f0 b0; xfer f1 b1; knit - b1 1; "
            "knit - b0 1; out 1; drop b0; drop b1; ");
}

TEST(Knittable, a_second_yarn_is_held_before_it_is_used) {
  const std::string text =
      knitout_of(";;Yarn-B: wool 2/28 Nm\n;;Size: 6 wales x 2 courses\nA: g\nB: g\n", MachineKind::shima);
  EXPECT_THAT(text, testing::HasSubstr("inhook 2; tuck - f5 2; tuck - f1 2; releasehook 2; "));
  EXPECT_THAT(text, testing::HasSubstr("outhook 1; outhook 2; drop f0; "));
}

TEST(Knittable, a_bind_off_ends_with_stitches_that_hold_its_last_loop) {
  const std::string text =
      knitout_of(";;Size: 2 wales x 2 courses\ng\n", MachineKind::kniterate, Edges::bound_off);
  EXPECT_THAT(text, testing::EndsWith("knit + f1 1; knit - f1 1; knit + f1 1; knit - f1 1; knit + f1 1; "
                                      "knit - f1 1; knit + f1 1; out 1; drop f1; "));
}

TEST(Knittable, what_a_machine_cannot_do_is_told) {
  std::string yarns, courses;
  for (char name = 'A'; name <= 'G'; ++name) {
    yarns += std::string(";;Yarn-") + name + ": wool 2/28 Nm\n";
    courses += std::string(1, name) + ": g\n";
  }
  Diagnostics said;
  const Program seven = read_program_text(";!vermiculation-1\n" + yarns + courses, ".verm", said);
  make_knittable(seven, MachineKind::kniterate, said);
  EXPECT_TRUE(says(said, Severity::error, 0, "the machine has 6 carriers, the fabric takes 7 yarns")) << said;
}

}  // namespace
}  // namespace loopwright
