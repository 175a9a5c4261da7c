// Knitout as a fabric file and back: what the notation can say makes the same yarn graph, loop by loop.
#include <gmock/gmock.h>

#include <algorithm>
#include <limits>

#include "machine/corpus.hpp"
#include "machine/run_machine.hpp"
#include "notation/read_knitout.hpp"
#include "notation/read_vermiculation.hpp"
#include "notation/write_knitout.hpp"
#include "notation/write_vermiculation.hpp"
#include "topology/build_yarn_graph.hpp"

namespace loopwright {
namespace {

struct Knitted {
  Program program;
  YarnGraph graph;
  int first = 0;  // left-most needle that holds a loop or gets one
};

Knitted knitted(Program program, Diagnostics& said) {
  Knitted result{std::move(program), {}, std::numeric_limits<int>::max()};
  const KnittingRecord record = run_machine(result.program, said);
  result.graph = build_yarn_graph(result.program, record, said);
  for (const LoopRecord& loop : record.loops)
    for (const Placement& place : loop.placements) result.first = std::min(result.first, place.needle.index);
  return result;
}

// Empty, or what is different first.
std::string difference(const Knitted& a, const Knitted& b) {
  if (a.graph.loops.size() != b.graph.loops.size()) return "number of loops";
  for (std::size_t i = 0; i < a.graph.loops.size(); ++i) {
    const Loop &x = a.graph.loops[i], &y = b.graph.loops[i];
    const std::string loop = "loop " + std::to_string(i) + ": ";
    if (x.yarn != y.yarn || x.order != y.order) return loop + "place in its yarn";
    if (x.kind != y.kind || x.side != y.side || x.direction != y.direction) return loop + "kind";
    if (x.slot - a.first != y.slot - b.first) return loop + "place";
    // a fabric file ends with the beds at home: it says nothing of a racking after its last act
    if (x.fate != LoopFate::held && x.head_slot - a.first != y.head_slot - b.first) return loop + "head";
    if (x.parents != y.parents || x.children != y.children) return loop + "parents and children";
    if (x.head_bed != y.head_bed || x.head_rank != y.head_rank || x.head_count != y.head_count)
      return loop + "stack";
    if (x.fate != y.fate) return loop + "fate";
  }
  if (a.graph.yarns.size() != b.graph.yarns.size()) return "number of yarns";
  for (std::size_t i = 0; i < a.graph.yarns.size(); ++i) {
    const GraphYarn &x = a.graph.yarns[i], &y = b.graph.yarns[i];
    const auto name = [](const Knitted& k, CarrierId id) { return k.program.carriers[id.position()]; };
    if (name(a, x.carrier) != name(b, y.carrier) || x.loops != y.loops) return "yarn " + std::to_string(i);
    for (std::size_t f = 0; f < x.floats.size(); ++f) {
      const auto &p = x.floats[f].passed, &q = y.floats[f].passed;
      if (!std::equal(p.begin(), p.end(), q.begin(), q.end(), [](const PassedLoop& s, const PassedLoop& t) {
            return s.loop == t.loop && s.bed == t.bed;
          }))
        return "float " + std::to_string(f) + " of yarn " + std::to_string(i);
    }
  }
  // transfers that share no needle may come in any order, and with them the crossings
  const auto crossings = [](const YarnGraph& graph) {
    std::vector<std::pair<std::size_t, std::size_t>> all;
    for (const LegCrossing& each : graph.leg_crossings)
      all.emplace_back(each.front.position(), each.back.position());
    std::sort(all.begin(), all.end());
    return all;
  };
  if (crossings(a.graph) != crossings(b.graph)) return "crossings";
  const auto same_interlacing = [](const Interlacing& x, const Interlacing& y) {
    return x.parent == y.parent && x.child == y.child && x.sign == y.sign;
  };
  if (!std::equal(a.graph.interlacings.begin(), a.graph.interlacings.end(), b.graph.interlacings.begin(),
                  b.graph.interlacings.end(), same_interlacing))
    return "interlacings";
  return {};
}

// What concerns no loop: how the carrier comes in, how tight the machine knits.
bool is_machine_setting(const std::string& message) {
  for (const char* word : {"yarn inserting hook", "machine settings", "'stitch'", "'pause'"})
    if (message.find(word) != std::string::npos) return true;
  return false;
}

TEST(VermiculationGraph, splits_and_drops_come_back_with_their_graph) {
  const char* text =
      ";!knitout-2\n;;Carriers: 3 6\nin 3\nknit + f4 3\nknit + f5 3\nknit + f6 3\nknit + f7 3\n"
      "split - f7 b7 3\nknit - f6 3\nsplit - f5 b5 3\nknit - f4 3\n"
      "rack 1\nsplit + f5 b4 3\nknit + f6 3\nrack 0\ndrop f6\nxfer b7 f7\nknit - f7 3\n"
      "in 6\nsplit - b4 f4 6\nmiss - f4 6\ndrop b5\nknit + f4 3\nsplit + f9 b9 3\nout 3\nout 6\n"
      "knit + f4\ndrop f7\n";
  Diagnostics said("k.k"), lost("k.k");
  const Knitted before = knitted(read_knitout(text, said), said);
  const std::string fabric = write_vermiculation(before.program, lost);
  ASSERT_TRUE(said.ok()) << said;
  EXPECT_TRUE(lost.list().empty()) << lost << fabric;
  const Knitted after = knitted(read_vermiculation(fabric, said), said);
  ASSERT_TRUE(said.ok()) << said << fabric;
  EXPECT_EQ(difference(before, after), "") << fabric;
  const std::string again = write_knitout(after.program);
  EXPECT_EQ(difference(before, knitted(read_knitout(again, said), said)), "") << fabric << again;
  // not to be had without the letters
  EXPECT_NE(fabric.find('s'), std::string::npos);
  EXPECT_NE(fabric.find('S'), std::string::npos);
  EXPECT_NE(fabric.find('d'), std::string::npos);
  EXPECT_NE(fabric.find('D'), std::string::npos);
}

TEST(VermiculationGraph, real_programmes_come_back_with_their_graph) {
  SKIP_WITHOUT_CORPUS();
  int same = 0, whole = 0, wrong = 0;
  for (const CorpusEntry& entry : corpus_knitout()) {
    Diagnostics said(entry.file), lost(entry.file), again("again.verm");
    const Knitted before = knitted(read_knitout(corpus_text(entry.file), said), said);
    if (!said.ok()) {
      ++wrong;
      continue;
    }
    const std::string fabric = write_vermiculation(before.program, lost);
    std::string reason;
    for (const Diagnostic& each : lost.list())
      if (reason.empty() && !is_machine_setting(each.message)) reason = each.message;
    if (!reason.empty()) {
      std::cout << "[   INFO   ] " << entry.file << ": " << reason << '\n';
      continue;
    }
    const Knitted after = knitted(read_vermiculation(fabric, again), again);
    ASSERT_TRUE(again.ok()) << entry.file << again;
    EXPECT_EQ(difference(before, after), "") << entry.file;
    EXPECT_EQ(difference(before, knitted(read_knitout(write_knitout(after.program), again), again)), "")
        << entry.file;
    ++same;
    if (lost.list().empty()) ++whole;
  }
  std::cout << "[   INFO   ] " << same << " with the same graph, " << whole
            << " of them without a word lost; wrong programmes: " << wrong << '\n';
  EXPECT_GE(same, 96);
}

}  // namespace
}  // namespace loopwright
