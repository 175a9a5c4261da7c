#include "experiments/piece_size.hpp"

#include <algorithm>
#include <vector>

namespace loopwright {
namespace {

struct CourseExtent {
  int loops = 0;
  double left = 0, right = 0, sum_y = 0;
};

// Runs of loops of one yarn and direction, in the order of the yarns.
std::vector<CourseExtent> courses_of(const Fabric& fabric) {
  std::vector<const LoopSpan*> spans;
  for (const LoopSpan& span : fabric.loops) spans.push_back(&span);
  std::sort(spans.begin(), spans.end(), [](const LoopSpan* a, const LoopSpan* b) {
    return a->yarn != b->yarn ? a->yarn < b->yarn : a->apex < b->apex;
  });
  std::vector<CourseExtent> courses;
  const LoopSpan* before = nullptr;
  for (const LoopSpan* span : spans) {
    const Vec3 head = position(fabric, fabric.yarns[static_cast<std::size_t>(span->yarn)], span->apex);
    if (before == nullptr || before->yarn != span->yarn || before->direction != span->direction)
      courses.push_back({0, head.x, head.x, 0});
    CourseExtent& course = courses.back();
    ++course.loops;
    course.left = std::min(course.left, head.x);
    course.right = std::max(course.right, head.x);
    course.sum_y += head.y;
    before = span;
  }
  return courses;
}

}  // namespace

PieceSize piece_size(const Fabric& fabric) {
  std::vector<CourseExtent> courses = courses_of(fabric);
  int most = 0;
  for (const CourseExtent& course : courses) most = std::max(most, course.loops);
  std::erase_if(courses, [most](const CourseExtent& course) { return 10 * course.loops < 9 * most; });

  PieceSize size{fabric.width, fabric.height};
  if (most > 1) {
    double sum = 0;
    for (const CourseExtent& course : courses)
      sum += (course.right - course.left) * course.loops / (course.loops - 1);
    size.width = sum / static_cast<double>(courses.size());
  }
  if (courses.size() > 1) {
    const auto level = [](const CourseExtent& course) { return course.sum_y / course.loops; };
    const auto [low, high] = std::minmax_element(
        courses.begin(), courses.end(),
        [&](const CourseExtent& a, const CourseExtent& b) { return level(a) < level(b); });
    // Fabric::courses counts short rows and layers as geometry does; one distance more than there are between
    // them
    const double counted = std::max(2.0, fabric.courses);
    size.height = (level(*high) - level(*low)) * counted / (counted - 1);
  }
  return size;
}

}  // namespace loopwright
