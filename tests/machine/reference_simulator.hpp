// A second V-bed, written apart from the machine and in another way, to compare with: it works on the text of
// valid knitout with maps from needle names, without a Program, carriers' hooks, diagnostics or any care for
// speed.
#pragma once
#include <algorithm>
#include <cmath>
#include <map>
#include <sstream>
#include <string>
#include <vector>

namespace loopwright {

struct ReferenceStep {
  int line = 0;
  std::string carrier, needle, from;  // from: needle beside which the carrier stood before
};

struct ReferenceState {
  std::map<std::string, std::vector<int>> held;  // needle name -> loops, first in the hook first
  std::vector<std::vector<int>> parents;         // by loop
  std::vector<int> line;                         // by loop, of the instruction that formed it
  std::vector<std::string> ended_on;             // by loop: needle on which it was last
  std::vector<ReferenceStep> steps;              // every loop and miss of every carrier
  std::map<std::string, std::string> stands_at;  // carriers that are in -> needle
  int misaligned = 0;                            // transfers between needles that do not face each other
};

// Front number that a needle faces at racking R; the number of a front needle is its own.
inline double faced(const std::string& needle, double racking) {
  const double number = std::stod(needle.substr(needle[1] == 's' ? 2 : 1));
  return needle[0] == 'f' ? number : number + racking;
}

inline std::vector<std::string> words_of(const std::string& line) {
  std::vector<std::string> words;
  for (std::size_t begin = 0, end = 0; (begin = line.find_first_not_of(" \t", end)) != std::string::npos;) {
    end = std::min(line.find_first_of(" \t", begin), line.size());
    words.push_back(line.substr(begin, end - begin));
  }
  return words;
}

inline ReferenceState reference_run(const std::string& text) {
  ReferenceState state;
  double racking = 0;
  const auto move = [&](const std::string& from, const std::string& to) {
    if (from[0] == to[0] || faced(from, racking) != faced(to, racking) || racking != std::floor(racking))
      ++state.misaligned;
    std::vector<int>& source = state.held[from];
    while (!source.empty()) {
      state.held[to].push_back(source.back());
      state.ended_on[static_cast<std::size_t>(source.back())] = to;
      source.pop_back();
    }
  };
  std::istringstream lines(text);
  std::string line;
  for (int number = 1; std::getline(lines, line); ++number) {
    const std::vector<std::string> word = words_of(line.substr(0, line.find_first_of(";\r")));
    if (word.empty()) continue;
    std::string op = word[0];
    if (op == "rack") racking = std::stod(word[1]);
    if (op == "out" || op == "outhook")
      for (std::size_t k = 1; k < word.size(); ++k) state.stands_at.erase(word[k]);

    // knit D N CS, tuck D N CS, miss D N CS, split D N N2 CS; without CS they are drop, nothing and xfer.
    const bool split = op == "split";
    if (op == "knit" || op == "tuck" || op == "miss" || split) {
      const std::vector<std::string> set(word.begin() + (split ? 4 : 3), word.end());
      const std::string needle = word[2];
      if (set.empty() && op == "knit") state.held[needle].clear();
      if (op == "miss" || !set.empty()) {
        std::vector<int> old;
        if (op == "knit" || split) old = state.held[needle];
        if (op == "knit") state.held[needle].clear();
        if (split) move(needle, word[3]);
        for (const std::string& carrier : set) {
          const std::string from = state.stands_at.count(carrier) ? state.stands_at[carrier] : needle;
          state.steps.push_back({number, carrier, needle, from});
          if (op == "miss") continue;
          state.held[needle].push_back(static_cast<int>(state.parents.size()));
          state.parents.push_back(old);
          state.line.push_back(number);
          state.ended_on.push_back(needle);
        }
      } else if (split) {
        move(needle, word[3]);
      }
      if (split)
        for (auto& [carrier, at] : state.stands_at)
          if (at == needle) at = word[3];
      for (const std::string& carrier : set) state.stands_at[carrier] = needle;
    }
    if (op == "drop") state.held[word[1]].clear();
    if (op == "xfer") {
      move(word[1], word[2]);
      for (auto& [carrier, at] : state.stands_at)
        if (at == word[1]) at = word[2];
    }
  }
  return state;
}

}  // namespace loopwright
