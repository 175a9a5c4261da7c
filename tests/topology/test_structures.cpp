// The library of structures against real programmes of the same structure: both give the same yarn graph,
// loop by loop.
#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <tuple>

#include "machine/corpus.hpp"
#include "notation/read_program.hpp"
#include "topology/graph_of.hpp"

namespace loopwright {
namespace {

YarnGraph graph_of_file(const std::filesystem::path& file) {
  Diagnostics diagnostics(file.filename());
  FabricOptions options;
  const Program program = read_program(file, diagnostics, options);
  return build_yarn_graph(program, run_machine(program, diagnostics), diagnostics);
}

// A real programme that knits the structure somewhere. Its needles may be every second one (`stride`), and
// its first course may go the other way: then the structure is compared in a mirror.
struct Twin {
  const char* structure;
  const char* file;
  int wales, passes;  // how much is compared: at least two repeats each way
  int stride = 1;
  bool mirrored = false;
};

void PrintTo(const Twin& twin, std::ostream* out) { *out << twin.structure; }

// A loop by its place: pass among the passes that form loops, bed, needle on the common axis.
using Place = std::tuple<int, int, int>;

class PlacedGraph {
 public:
  PlacedGraph(const YarnGraph& graph, int stride, bool mirrored) : graph_(graph) {
    std::set<int> passes;
    for (const Loop& loop : graph.loops) passes.insert(loop.pass);
    std::map<int, int> rank;
    for (const int pass : passes) rank.emplace(pass, static_cast<int>(rank.size()));
    for (const Loop& loop : graph.loops) {
      // an all-needle racking puts a rear needle between two front needles, by a quarter or a half
      const double slot = mirrored ? -loop.slot : loop.slot;
      const int needle = static_cast<int>(std::floor(slot / stride));
      places_.emplace_back(rank[loop.pass], is_front(loop.bed) ? 0 : 1, needle);
      if (needle < least_) least_ = needle;
      if (needle > most_) most_ = needle;
    }
    for (const LegCrossing& crossing : graph.leg_crossings) over_.emplace(crossing.front, crossing.back);
    passes_ = static_cast<int>(passes.size());
    mirrored_ = mirrored;
    for (std::size_t i = 0; i < places_.size(); ++i) by_place_[places_[i]].push_back(i);
  }

  // All that the loops formed in a window are: place, kind, side, direction, yarn, whom they are drawn
  // through and who through them, the loop that the yarn comes from. Empty where a place holds two loops.
  // With `wanted` only as far as it agrees.
  std::vector<std::string> window(int pass, int passes, int needle, int wales,
                                  const std::vector<std::string>* wanted = nullptr) const {
    std::vector<std::string> all;
    std::map<int, int> yarns;  // named in the order in which they come
    for (auto at = by_place_.lower_bound({pass, -1, 0}); at != by_place_.end(); ++at) {
      const auto [p, bed, n] = at->first;
      if (p >= pass + passes) break;
      for (const std::size_t i : at->second)
        yarns.emplace(graph_.yarns[graph_.loops[i].yarn.position()].carrier.value,
                      static_cast<int>(yarns.size()));
      if (n < needle || n >= needle + wales) continue;
      if (at->second.size() != 1) return {};
      all.push_back(words(at->second.front(), yarns, pass, needle));
      if (wanted && (all.size() > wanted->size() || all.back() != (*wanted)[all.size() - 1])) return all;
    }
    return all;
  }

  int passes() const { return passes_; }
  int least() const { return least_; }
  int most() const { return most_; }

 private:
  std::string relative(LoopId id, int pass, int needle) const {
    if (!id.valid()) return "none";
    const auto [p, bed, n] = places_[id.position()];
    return std::to_string(p - pass) + (bed == 0 ? "f" : "b") + std::to_string(n - needle);
  }

  std::string words(std::size_t i, const std::map<int, int>& yarns, int pass, int needle) const {
    const Loop& loop = graph_.loops[i];
    const GraphYarn& yarn = graph_.yarns[loop.yarn.position()];
    std::string text = relative(LoopId(i), pass, needle) + " kind " +
                       std::to_string(static_cast<int>(loop.kind)) + " side " +
                       std::to_string(static_cast<int>(loop.side)) + " yarn " +
                       std::to_string(yarns.at(yarn.carrier.value)) + " going " +
                       std::to_string((mirrored_ ? -1 : 1) * static_cast<int>(loop.direction)) + " through";
    // stacked heads in their order, since it says which way a decrease leans
    for (const LoopId parent : loop.parents) text += ' ' + relative(parent, pass, needle);
    std::vector<std::string> children;
    for (const LoopId child : loop.children) children.push_back(relative(child, pass, needle));
    std::sort(children.begin(), children.end());
    text += " holding";
    for (const std::string& child : children) text += ' ' + child;
    const auto order = static_cast<std::size_t>(loop.order);
    text += " after " + (order > 0 ? relative(yarn.loops[order - 1], pass, needle) : "nothing");
    std::vector<std::string> crossed;
    for (auto [at, end] = over_.equal_range(LoopId(i)); at != end; ++at)
      crossed.push_back(relative(at->second, pass, needle));
    std::sort(crossed.begin(), crossed.end());
    for (const std::string& other : crossed) text += " over " + other;
    return text;
  }

  const YarnGraph& graph_;
  std::vector<Place> places_;                           // by loop
  std::map<Place, std::vector<std::size_t>> by_place_;  // loops formed there
  std::multimap<LoopId, LoopId> over_;                  // leg crossings by the loop in front
  int passes_ = 0, least_ = 1'000'000, most_ = -1'000'000;
  bool mirrored_ = false;
};

class Structures : public testing::TestWithParam<Twin> {};

TEST_P(Structures, HaveTheYarnGraphOfARealProgramme) {
  SKIP_WITHOUT_CORPUS();
  const Twin& twin = GetParam();
  const YarnGraph ours = graph_of_file(std::filesystem::path(LOOPWRIGHT_SOURCE_DIR) / "examples" /
                                       "structures" / (std::string(twin.structure) + ".verm"));
  const YarnGraph theirs = graph_of_file(corpus_folder() / "files" / twin.file);
  const PlacedGraph a(ours, 1, twin.mirrored), b(theirs, twin.stride, false);
  // a window in the middle of ours, with neighbours on all sides; it is looked for in the real programme
  const int needle = a.least() + (a.most() - a.least() + 1 - twin.wales) / 2;
  const int pass = (a.passes() - twin.passes) / 2;
  const auto wanted = a.window(pass, twin.passes, needle, twin.wales);
  ASSERT_GE(wanted.size(), 20u);
  int found = 0;
  std::size_t most_alike = 0;
  std::string last;
  for (int p = 1; p + twin.passes < b.passes() && p < 200; ++p) {
    // near the left edge, but not at it
    for (int n = b.least() + 2; n < b.least() + 32 && n + twin.wales <= b.most(); ++n) {
      const auto there = b.window(p, twin.passes, n, twin.wales, &wanted);
      found += there == wanted;
      if (there.size() > most_alike) {
        most_alike = there.size();
        last = there.back();
      }
    }
  }
  EXPECT_GT(found, 0) << "of " << wanted.size() << " loops number " << most_alike << " is\n"
                      << last << "\nand not\n"
                      << wanted[std::min(most_alike, wanted.size()) - 1];
}

INSTANTIATE_TEST_SUITE_P(
    Library, Structures,
    testing::Values(Twin{"plain", "singlejersey.knitout", 8, 8}, Twin{"rib", "rib-1x1.knitout", 8, 6},
                    Twin{"rib_2x2", "rib-2x2.knitout", 8, 6}, Twin{"garter", "garter.knitout", 8, 6, 1, true},
                    Twin{"interlock", "interlock.knitout", 6, 6},
                    Twin{"half_milano", "halfmilano.knitout", 6, 6},
                    Twin{"milano", "MilanoRib.knitout", 6, 12},
                    Twin{"full_cardigan", "single_color_brioche.k", 6, 6, 2, true},
                    Twin{"swiss_double_pique", "1-color-swiss-weaveknit.k", 6, 8, 1, true},
                    Twin{"spacer", "spacer.k", 6, 12}, Twin{"tube", "tube.k", 6, 8},
                    Twin{"rope_cable", "cable_swatch_2_cable.k", 14, 12},
                    Twin{"pointelle", "lace.knitout", 12, 10}),
    [](const auto& twin) { return std::string(twin.param.structure); });

// The comparison can fail: structures that look alike on one side are told apart.
TEST(StructuresApart, SwissIsNotFrench) {
  SKIP_WITHOUT_CORPUS();
  const auto folder = std::filesystem::path(LOOPWRIGHT_SOURCE_DIR) / "examples" / "structures";
  const YarnGraph swiss = graph_of_file(folder / "swiss_double_pique.verm");
  const YarnGraph french = graph_of_file(folder / "french_double_pique.verm");
  const YarnGraph real = graph_of_file(corpus_folder() / "files" / "1-color-swiss-weaveknit.k");
  const PlacedGraph b(real, 1, false);
  int found = 0;
  for (const YarnGraph* graph : {&swiss, &french}) {
    const PlacedGraph a(*graph, 1, true);
    const auto wanted = a.window(6, 8, a.least() + 4, 6);
    bool here = false;
    for (int p = 1; p < 40; ++p)
      for (int n = b.least() + 2; n < b.least() + 20; ++n)
        here = here || b.window(p, 8, n, 6, &wanted) == wanted;
    found += here ? 1 : 0;
    EXPECT_TRUE(graph == &swiss || !here);
  }
  EXPECT_EQ(found, 1);
}

}  // namespace
}  // namespace loopwright
