// A knitout programme as it is looked at: its passes, made when they are asked for, where they lie in the
// text, and its needle acts in the order in which the machine does them.
#pragma once
#include <cstdint>
#include <list>
#include <memory>
#include <string>
#include <unordered_map>
#include <vector>

#include "notation/program_diagram.hpp"
#include "pipeline.hpp"

namespace loopwright {

// Lines of the text that one pass takes, both included; its first line stays when it is folded.
struct Fold {
  int first_line = 0, last_line = 0;
  std::string label;  // what the pass does, in a few words
};

class KnitoutPasses {
 public:
  explicit KnitoutPasses(std::shared_ptr<const Knitting> knitting);

  const ProgramDiagram& diagram() const { return diagram_; }
  const std::vector<Fold>& folds() const { return folds_; }  // of passes of two lines or more
  int acts() const { return static_cast<int>(acts_.size()); }
  int instruction(int act) const { return acts_[static_cast<std::size_t>(act)]; }
  SourceLocation place(int act) const;
  std::size_t pass_of(int act) const;  // into the diagram
  double slot(int act) const;

 private:
  const Instruction& at(int act) const;
  std::shared_ptr<const Knitting> knitting_;
  ProgramDiagram diagram_;
  std::vector<std::int32_t> acts_;  // instructions
  std::vector<Fold> folds_;
};

// The passes that were asked for last.
class PassCache {
 public:
  static constexpr std::size_t most_kept = 512;
  // Stays valid until `most_kept` others were asked for.
  const DiagramPass& pass(const ProgramDiagram& diagram, std::size_t k);
  void clear();
  std::size_t kept() const { return order_.size(); }

 private:
  std::list<std::pair<std::size_t, DiagramPass>> order_;  // the latest first
  std::unordered_map<std::size_t, std::list<std::pair<std::size_t, DiagramPass>>::iterator> places_;
};

}  // namespace loopwright
