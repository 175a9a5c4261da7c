// A fabric file made knittable keeps its yarn graph: what the pattern's instructions knit is what the fabric
// file knits, loop by loop and float by float, on both machines.
#include <gmock/gmock.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <map>
#include <random>
#include <sstream>

#include "machine/knittable.hpp"
#include "machine/racking.hpp"
#include "machine/run_machine.hpp"
#include "notation/read_knitout.hpp"
#include "notation/read_program.hpp"
#include "notation/write_knitout.hpp"
#include "topology/build_yarn_graph.hpp"

namespace loopwright {
namespace {

// A graph's loops that instructions [begin, end) formed, told in words without their places in the file: each
// loop, each float between two of them, each crossing. Loops from elsewhere are not mentioned.
class PatternWords {
 public:
  PatternWords(const YarnGraph& graph, const Program& program, int begin, int end)
      : graph_(graph), program_(program) {
    for (std::size_t k = 0; k < graph.loops.size(); ++k)
      if (graph.loops[k].instruction >= begin && graph.loops[k].instruction < end)
        number_.emplace(LoopId(k), static_cast<int>(number_.size()));
  }

  std::vector<std::string> words() const {
    std::vector<std::string> all;
    for (const auto& [id, own] : number_) all.push_back(loop(id, own));
    for (const GraphYarn& yarn : graph_.yarns) {
      std::vector<std::string> floats;
      for (const Float& each : yarn.floats)
        if (number_.count(each.from) && number_.count(each.to)) floats.push_back(float_words(yarn, each));
      all.insert(all.end(), floats.begin(), floats.end());
    }
    for (const LegCrossing& crossing : graph_.leg_crossings)
      if (number_.count(crossing.front) && number_.count(crossing.back))
        all.push_back(std::to_string(number_.at(crossing.front)) + " over " +
                      std::to_string(number_.at(crossing.back)));
    for (const Interlacing& each : graph_.interlacings)
      if (number_.count(each.parent) && number_.count(each.child))
        all.push_back(std::to_string(number_.at(each.child)) + " through " +
                      std::to_string(number_.at(each.parent)) + (each.sign > 0 ? " from behind" : ""));
    std::sort(all.begin(), all.end());
    return all;
  }
  std::size_t loops() const { return number_.size(); }

 private:
  // Places in half pitches, so that a quarter and a half pitch are one.
  static long long half_pitches(double slot) {
    return static_cast<long long>(std::floor(slot) + std::ceil(slot));
  }
  std::string numbers(const std::vector<LoopId>& loops) const {
    std::string text;
    for (LoopId id : loops)
      if (number_.count(id)) text += ' ' + std::to_string(number_.at(id));
    return text;
  }
  std::string loop(LoopId id, int own) const {
    const Loop& loop = graph_.loop(id);
    std::ostringstream words;
    words << "loop " << own << " of "
          << program_.carriers[graph_.yarns[loop.yarn.position()].carrier.position()]
          << (loop.kind == LoopKind::tuck ? " tuck" : "") << (loop.direction == Direction::left ? " -" : " +")
          << (is_front(loop.bed) ? " f" : " b") << half_pitches(loop.slot) << " parents"
          << numbers(loop.parents) << " children" << numbers(loop.children);
    // where its head was when the pattern drew something through it
    if (!numbers(loop.children).empty())
      words << " head" << (is_front(loop.head_bed) ? " f" : " b") << half_pitches(loop.head_slot);
    return words.str();
  }
  std::string float_words(const GraphYarn& yarn, const Float& each) const {
    std::ostringstream words;
    words << "float " << program_.carriers[yarn.carrier.position()] << ' ' << number_.at(each.from) << ' '
          << number_.at(each.to) << " past";
    for (const PassedLoop& passed : each.passed)
      if (number_.count(passed.loop))
        words << ' ' << number_.at(passed.loop) << (is_front(passed.bed) ? 'f' : 'b');
    words << " missed";
    for (const Needle& needle : each.missed) words << ' ' << to_string(needle);
    return words.str();
  }

  const YarnGraph& graph_;
  const Program& program_;
  std::map<LoopId, int> number_;
};

YarnGraph knitted(const Program& program, Diagnostics& said) {
  const YarnGraph graph = build_yarn_graph(program, run_machine(program, said), said);
  EXPECT_EQ(validate_yarn_graph(graph), std::vector<std::string>{});
  return graph;
}

// Nothing if the fabric itself cannot be knitted.
std::optional<std::size_t> expect_same_pattern(const std::string& text, Edges edges, MachineKind machine) {
  Diagnostics said;
  FabricOptions options;
  options.edges = edges;
  Program fabric = read_program_text(text, ".verm", said, options);
  if (!said.ok()) return std::nullopt;
  const KnittableProgram knittable = make_knittable(fabric, machine, said);
  for (std::size_t k = 0; k < fabric.carriers.size(); ++k) fabric.carriers[k] = std::to_string(k + 1);
  const YarnGraph wanted = knitted(fabric, said);
  Diagnostics of_result;
  const Program program = read_knitout(write_knitout(knittable.program), of_result);
  const YarnGraph graph = knitted(program, of_result);
  EXPECT_TRUE(of_result.ok()) << of_result << text;
  const PatternWords pattern(graph, program, knittable.pattern_begin, knittable.pattern_end);
  EXPECT_EQ(pattern.words(), PatternWords(wanted, fabric, 0, fabric.repeat_starts.back()).words()) << text;
  return pattern.loops();
}

TEST(KnittableGraph, every_example_keeps_the_yarn_graph_of_its_pattern) {
  int found = 0;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(LOOPWRIGHT_SOURCE_DIR "/examples")) {
    if (entry.path().extension() != ".verm") continue;
    SCOPED_TRACE(entry.path());
    std::ostringstream text;
    text << std::ifstream(entry.path(), std::ios::binary).rdbuf();
    for (const Edges edges : {Edges::free, Edges::bound_off})
      for (const MachineKind machine : {MachineKind::shima, MachineKind::kniterate})
        EXPECT_GT(expect_same_pattern(text.str(), edges, machine).value_or(0), 15u);
    ++found;
  }
  EXPECT_GE(found, 15);
}

// Random notations: letters, rackings, feeders, both beds.
TEST(KnittableGraph, random_fabrics_keep_theirs) {
  int knitted_ones = 0;
  for (unsigned seed = 1; seed <= 300; ++seed) {
    std::mt19937 random(seed);
    const auto pick = [&](const std::string& letters) { return letters[random() % letters.size()]; };
    const auto row = [&](const std::string& letters, int width) {
      std::string text;
      for (int k = 0; k < width; ++k) text += pick(letters);
      return text;
    };
    std::string text = ";!vermiculation-1\n;;Yarn-A: wool 2/28 Nm\n;;Yarn-B: wool 2/28 Nm\n;;Size: " +
                       std::to_string(2 + random() % 7) + " wales x " + std::to_string(2 + random() % 6) +
                       " courses\n";
    const int courses = 1 + static_cast<int>(random() % 4), width = 1 + static_cast<int>(random() % 4);
    for (int c = 0; c < courses; ++c) {
      const std::string feeder = random() % 3 == 0 ? "B: " : "";
      switch (random() % 4) {
        case 0:
          text += feeder + row("ggge", width) + "\n";
          break;
        case 1:
          text += feeder + row("ggev.n", width) + "\n";
          break;
        case 2:
          text += feeder + row("g.v-", width) + " / " + row("e.n-", width) + "\n";
          break;
        default:
          text += feeder + row("gge", width) + "\n" + row("..t", width) + "\nR" + pick("01") + " " +
                  row("..T", width) + "\n";
      }
    }
    for (const MachineKind machine : {MachineKind::shima, MachineKind::kniterate}) {
      const auto loops = expect_same_pattern(text, seed % 2 == 0 ? Edges::free : Edges::bound_off, machine);
      if (loops && *loops > 0) ++knitted_ones;
      if (testing::Test::HasFailure()) return;
    }
  }
  EXPECT_GT(knitted_ones, 200);
}

}  // namespace
}  // namespace loopwright
