// From what the machine did to which yarn goes through which loop.
#pragma once
#include <string>
#include <vector>

#include "topology/yarn_graph.hpp"

namespace loopwright {

// `record` must be what run_machine gave for `program`. Loops that were dropped with nothing drawn through
// them are told as warnings: they will run. Time linear in instructions and in the held loops that floats
// pass.
YarnGraph build_yarn_graph(const Program& program, const KnittingRecord& record, Diagnostics& diagnostics);

// What is inconsistent in a graph, one sentence a fault; empty for every graph that build_yarn_graph makes.
std::vector<std::string> validate_yarn_graph(const YarnGraph& graph);

}  // namespace loopwright
