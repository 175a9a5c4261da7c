#include "outputs/exchange/write_curves.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <limits>
#include <ostream>
#include <stdexcept>
#include <string>

#include "geometry/linking.hpp"
#include "outputs/atomic_file.hpp"
#include "outputs/exchange/bytes.hpp"
#include "outputs/exchange/yarn_points.hpp"
#include "outputs/yarn_scene.hpp"

namespace loopwright {
namespace {

void append_place(std::string& bytes, const Vec3& p, const Fabric& fabric) {
  for (int c = 0; c < 3; ++c) append_bytes(bytes, static_cast<float>(p[c] * fabric.diameter_mm));
}

// Points whose Catmull-Rom curve is the centreline: those on it, and before and behind an open one the mirror
// image of the second and the last but one, or the next ones where the yarn goes on in another cell.
std::vector<Vec3> catmull_rom_points(const Fabric& fabric, const FabricYarn& yarn, int per_segment) {
  std::vector<Vec3> points;
  const double step = 1.0 / per_segment;
  const int last = yarn.segments() * per_segment;
  if (is_closed(yarn)) {
    for (int k = 0; k < last; ++k) points.push_back(position(fabric, yarn, k * step));
    return points;
  }
  const auto mirrored = [&](double end, double next) {
    return position(fabric, yarn, end) * 2 - position(fabric, yarn, next);
  };
  const double end = yarn.segments();
  points.push_back(yarn.periodic ? position(fabric, yarn, -step) : mirrored(0, step));
  for (int k = 0; k <= last; ++k) points.push_back(position(fabric, yarn, k * step));
  points.push_back(yarn.periodic ? position(fabric, yarn, end + step) : mirrored(end, end - step));
  return points;
}

// Control points of the yarn; of one that goes on in another cell, with those that close its last segments.
std::vector<Vec3> bspline_points(const Fabric& fabric, const FabricYarn& yarn) {
  std::vector<Vec3> points = yarn.control_points;
  if (yarn.periodic && !is_closed(yarn))
    for (int k = 0; k < 3; ++k) points.push_back(control_point(fabric, yarn, yarn.segments() + k));
  return points;
}

template <class PointsOf>
void write_bcc_file(const std::filesystem::path& path, const Fabric& fabric, const ExportOptions& options,
                    const char* kind, PointsOf points_of) {
  AtomicFile file(path);
  std::ostream& out = file.stream();
  std::array<char, 40> text{};
  std::snprintf(text.data(), text.size(), "Loopwright mm diameter %.9g", fabric.diameter_mm);
  std::string bytes("BCC\x44", 4);
  bytes += kind;
  append_bytes(bytes, std::uint8_t{3});
  append_bytes(bytes, std::uint8_t{1});  // y is up
  append_bytes(bytes, std::uint64_t{fabric.yarns.size() * cell_count(fabric, options)});
  const std::size_t total_at = bytes.size();
  append_bytes(bytes, std::uint64_t{0});
  append_bytes(bytes, text);
  out.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  std::uint64_t total = 0;
  for (const FabricYarn& yarn : fabric.yarns) {
    const std::vector<Vec3> points = points_of(yarn);
    for_each_cell(fabric, options, [&](int, int, const Vec3& moved) {
      bytes.clear();
      const auto count = static_cast<std::int32_t>(points.size());
      append_bytes(bytes, is_closed(yarn) ? -count : count);
      for (const Vec3& p : points) append_place(bytes, p + moved, fabric);
      out.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
      total += points.size();
    });
  }
  bytes.clear();
  append_bytes(bytes, total);
  out.seekp(static_cast<std::streamoff>(total_at));
  out.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  file.commit();
}

// A polygon whose quadratic B-spline follows the points to fourth order: P = p - p''/8. Ends stay.
std::vector<Vec3> quadratic_polygon(const Fabric& fabric, const FabricYarn& yarn, int per_segment) {
  const std::vector<Vec3> points = polyline(fabric, yarn, per_segment);
  std::vector<Vec3> polygon = points;
  const std::size_t n = points.size();
  for (std::size_t k = 0; k < n; ++k) {
    if (!is_closed(yarn) && (k == 0 || k + 1 == n)) continue;
    const Vec3& before = points[k > 0 ? k - 1 : n - 2];
    const Vec3& after = points[k + 1 < n ? k + 1 : 1];
    polygon[k] = (points[k] * 10 - before - after) / 8;
  }
  return polygon;
}

std::string chunk(const char* letters, const std::string& content) {
  std::string bytes(letters, 4);
  if (content.size() > std::numeric_limits<std::uint32_t>::max())
    throw std::invalid_argument(
        ".yarns holds 4 GiB a chunk and this fabric needs more: take a smaller --per-segment");
  append_bytes(bytes, static_cast<std::uint32_t>(content.size()));
  return bytes + content;
}

// The format's parts, filled yarn by yarn.
struct YarnsFile {
  std::string places, lines, yarns, checkpoints;
  std::uint32_t points = 0;

  // Checkpoints where loops begin: the unloaded length from each to the next, and none after the last point.
  void add_checkpoints(const Fabric& fabric, const FabricYarn& yarn, const std::vector<int>& loops,
                       int per_segment) {
    std::vector<int> marks{0, yarn.segments() * per_segment};
    for (const int k : loops)
      marks.push_back(
          static_cast<int>(std::lround(fabric.loops[static_cast<std::size_t>(k)].begin * per_segment)));
    std::sort(marks.begin(), marks.end());
    marks.erase(std::unique(marks.begin(), marks.end()), marks.end());
    std::erase_if(marks, [&](int mark) { return mark < 0 || mark > yarn.segments() * per_segment; });
    const double step_mm = yarn.segment_rest_length / per_segment * fabric.diameter_mm;
    for (std::size_t k = 0; k < marks.size(); ++k) {
      const int steps = k + 1 < marks.size() ? marks[k + 1] - marks[k] : 0;
      append_bytes(checkpoints, points + static_cast<std::uint32_t>(marks[k]));
      append_bytes(checkpoints, static_cast<float>(steps * step_mm));
      append_bytes(checkpoints, std::uint32_t{0});
    }
  }

  void add(const Fabric& fabric, std::size_t number, const std::vector<int>& loops, int per_segment,
           const Vec3& moved) {
    const FabricYarn& yarn = fabric.yarns[number];
    const std::vector<Vec3> polygon = quadratic_polygon(fabric, yarn, per_segment);
    add_checkpoints(fabric, yarn, loops, per_segment);
    std::uint32_t line = 0;
    for (std::size_t k = 0; k < polygon.size(); ++k) {
      append_place(places, polygon[k] + moved, fabric);
      // of the piece that follows; the last point has that of the one before it
      const int loop = loop_at(fabric, loops, (static_cast<double>(k) + 0.5) / per_segment);
      if (k + 1 < polygon.size())
        line = loop < 0 ? 0
                        : static_cast<std::uint32_t>(
                              std::max(0, fabric.loops[static_cast<std::size_t>(loop)].at.line));
      append_bytes(lines, line);
    }
    append_bytes(yarns, points);
    points += static_cast<std::uint32_t>(polygon.size());
    append_bytes(yarns, points);
    append_bytes(yarns, static_cast<float>(0.5 * yarn.diameter * fabric.diameter_mm));
    append_bytes(yarns, drawn_colour(fabric, number));
    append_bytes(yarns, std::uint8_t{255});
  }
};

}  // namespace

void write_bcc(const std::filesystem::path& path, const Fabric& fabric, const ExportOptions& options) {
  write_bcc_file(path, fabric, options, "C0", [&](const FabricYarn& yarn) {
    return catmull_rom_points(fabric, yarn, options.per_segment);
  });
}

void write_bcc_bspline(const std::filesystem::path& path, const Fabric& fabric,
                       const ExportOptions& options) {
  write_bcc_file(path, fabric, options, "BS",
                 [&](const FabricYarn& yarn) { return bspline_points(fabric, yarn); });
}

void write_yarns(const std::filesystem::path& path, const Fabric& fabric, const ExportOptions& options) {
  const std::vector<std::vector<int>> loops = loops_of_yarns(fabric);
  YarnsFile parts;
  for (std::size_t y = 0; y < fabric.yarns.size(); ++y)
    for_each_cell(fabric, options, [&](int, int, const Vec3& moved) {
      parts.add(fabric, y, loops[y], options.per_segment, moved);
    });
  std::string unit;  // the unit "1", whose name is all of the strings
  append_bytes(unit, std::uint32_t{0});
  append_bytes(unit, std::uint32_t{1});
  append_bytes(unit, 1.0F);
  AtomicFile file(path);
  file.stream() << chunk("f3..", parts.places) << chunk("src.", parts.lines) << chunk("yarn", parts.yarns)
                << chunk("strs", "1") << chunk("unit", unit) << chunk("chk.", parts.checkpoints);
  file.commit();
}

}  // namespace loopwright
