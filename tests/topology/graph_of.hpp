// Helpers of the topology tests: the graph of a few lines of knitout.
#pragma once
#include <gtest/gtest.h>

#include "machine/machine_of.hpp"
#include "topology/build_yarn_graph.hpp"

namespace loopwright {

struct GraphRun {
  MachineRun machine;
  YarnGraph graph;
  const Diagnostics& diagnostics() const { return machine.diagnostics; }
};

// `lines` as in machine_of. The programme must be right and its graph consistent.
inline GraphRun graph_of(const std::string& lines) {
  GraphRun run;
  run.machine = machine_of(lines);
  EXPECT_TRUE(run.diagnostics().ok()) << run.diagnostics();
  run.graph = build_yarn_graph(run.machine.program, run.machine.record, run.machine.diagnostics);
  for (const std::string& fault : validate_yarn_graph(run.graph)) ADD_FAILURE() << fault;
  return run;
}

}  // namespace loopwright
