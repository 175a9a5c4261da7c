#include "topology/courses.hpp"

#include <algorithm>
#include <map>

namespace loopwright {

std::vector<int> course_numbers(const YarnGraph& graph) {
  std::map<int, std::vector<const Loop*>> passes;
  for (const Loop& loop : graph.loops) passes[loop.pass].push_back(&loop);
  std::map<int, int> course_of_pass;
  int before = 0;
  for (const auto& [pass, loops] : passes) {
    int course = -1;
    for (const Loop* loop : loops)
      for (const LoopId parent : loop->parents)
        if (const auto below = course_of_pass.find(graph.loop(parent).pass); below != course_of_pass.end())
          course = std::max(course, below->second + 1);
    before = course_of_pass[pass] = course >= 0 ? course : before;
  }
  std::vector<int> courses;
  courses.reserve(graph.loops.size());
  for (const Loop& loop : graph.loops) courses.push_back(course_of_pass[loop.pass]);
  return courses;
}

}  // namespace loopwright
