// The needle diagram of a programme: its instructions, pass by pass, each line of graph made when it is asked
// for, so that a programme of many thousand passes can be looked at where somebody looks.
#pragma once
#include <cstddef>
#include <vector>

#include "notation/needle_diagram.hpp"
#include "notation/program_passes.hpp"

namespace loopwright {

class ProgramDiagram {
 public:
  /// `program` must outlive it.
  explicit ProgramDiagram(const Program& program, std::size_t first_pass = 0,
                          std::size_t most_passes = static_cast<std::size_t>(-1));

  /// Everything but the passes.
  const NeedleDiagram& frame() const { return frame_; }
  std::size_t size() const { return runs_.size(); }
  std::size_t passes_in_all() const { return passes_in_all_; }
  const std::vector<ProgramPass>& runs() const { return runs_; }
  /// O(wales and instructions of the pass).
  DiagramPass pass(std::size_t k) const;

 private:
  const Program& program_;
  std::vector<ProgramPass> runs_;
  NeedleDiagram frame_;
  std::size_t passes_in_all_ = 0;
};

}  // namespace loopwright
