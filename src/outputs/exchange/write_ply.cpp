#include "outputs/exchange/write_ply.hpp"

#include <limits>
#include <ostream>
#include <stdexcept>
#include <string>

#include "outputs/atomic_file.hpp"
#include "outputs/exchange/bytes.hpp"
#include "outputs/exchange/yarn_points.hpp"
#include "outputs/exchange/yarn_skin.hpp"
#include "outputs/yarn_scene.hpp"

namespace loopwright {
namespace {

void put_header(std::ostream& out, const Fabric& fabric, std::size_t vertices, std::size_t faces) {
  out << "ply\nformat binary_little_endian 1.0\ncomment Loopwright: yarn tubes; unit: millimetre\n"
      << "comment yarn diameter: " << number_text(fabric.diameter_mm) << " mm\n"
      << "element vertex " << vertices << '\n';
  for (const char* name : {"x", "y", "z", "nx", "ny", "nz", "s", "t"})
    out << "property float " << name << '\n';
  for (const char* name : {"red", "green", "blue"}) out << "property uchar " << name << '\n';
  for (const char* name : {"yarn", "loop", "line"}) out << "property int " << name << '\n';
  out << "element face " << faces << "\nproperty list uchar int vertex_indices\nend_header\n";
}

void append_vector(std::string& bytes, const Vec3& v) {
  for (int c = 0; c < 3; ++c) append_bytes(bytes, static_cast<float>(v[c]));
}

}  // namespace

void write_ply(const std::filesystem::path& path, const Fabric& fabric, const ExportOptions& options) {
  check_tube_options(options);
  const std::size_t cells = cell_count(fabric, options);
  std::size_t vertices = 0, triangles = 0;
  for (const FabricYarn& yarn : fabric.yarns) {
    vertices += skin_vertices(yarn, options) * cells;
    triangles += skin_triangles(yarn, options) * cells;
  }
  if (vertices > std::size_t{std::numeric_limits<std::int32_t>::max()})
    throw std::invalid_argument(
        "PLY numbers its vertices with 31 bits and this fabric has more: take fewer --sides or "
        "--per-segment");
  AtomicFile file(path);
  std::ostream& out = file.stream();
  put_header(out, fabric, vertices, triangles);

  const std::vector<std::vector<int>> loops = loops_of_yarns(fabric);
  std::string bytes;
  for (std::size_t y = 0; y < fabric.yarns.size(); ++y) {
    const FabricYarn& yarn = fabric.yarns[y];
    const YarnSkin skin = yarn_skin(fabric, yarn, options);
    const std::vector<int> of_ring = loops_at_points(fabric, y, loops[y], options.per_segment);
    const std::array<std::uint8_t, 3> rgb = drawn_colour(fabric, y);
    for_each_cell(fabric, options, [&](int, int, const Vec3& moved) {
      bytes.clear();
      for (const YarnSkin::Vertex& vertex : skin.vertices) {
        append_vector(bytes, vertex.place_mm + moved * fabric.diameter_mm);
        append_vector(bytes, vertex.normal);
        append_bytes(bytes, static_cast<float>(vertex.u));
        append_bytes(bytes, static_cast<float>(vertex.v));
        append_bytes(bytes, rgb);
        const int loop = of_ring[vertex.ring];
        append_bytes(bytes, static_cast<std::int32_t>(y));
        append_bytes(bytes, static_cast<std::int32_t>(loop));
        const int line = loop < 0 ? 0 : fabric.loops[static_cast<std::size_t>(loop)].at.line;
        append_bytes(bytes, static_cast<std::int32_t>(line));
      }
      out.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
    });
  }
  std::size_t first = 0;
  for (const FabricYarn& yarn : fabric.yarns) {
    const YarnSkin skin = yarn_skin(fabric, yarn, options);
    for (std::size_t cell = 0; cell < cells; ++cell, first += skin.vertices.size()) {
      bytes.clear();
      for (const auto& triangle : skin.triangles) {
        append_bytes(bytes, std::uint8_t{3});
        for (const std::uint32_t corner : triangle)
          append_bytes(bytes, static_cast<std::int32_t>(first + corner));
      }
      out.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
    }
  }
  file.commit();
}

}  // namespace loopwright
