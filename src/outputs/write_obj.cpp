#include "outputs/write_obj.hpp"

#include <array>
#include <charconv>
#include <ostream>

#include "outputs/atomic_file.hpp"
#include "outputs/tube_mesh.hpp"

namespace loopwright {
namespace {

// Nine digits for places: a metre of cloth to a nanometre. Directions need fewer.
void put(std::ostream& out, const char* keyword, const Vec3& v, int digits = 9) {
  std::array<char, 128> line{};
  char* end = line.data();
  for (const char* c = keyword; *c != 0; ++c) *end++ = *c;
  for (int i = 0; i < 3; ++i) {
    *end++ = ' ';
    end = std::to_chars(end, line.data() + line.size(), v[i] + 0.0, std::chars_format::general, digits).ptr;
  }
  *end++ = '\n';
  out.write(line.data(), end - line.data());
}

// A name may hold anything that a user typed; a comment ends at the line's end.
std::string one_line(std::string text) {
  for (char& c : text)
    if (static_cast<unsigned char>(c) < ' ') c = ' ';
  return text;
}

void put_header(std::ostream& out, const Fabric& fabric, const char* what) {
  out << "# Loopwright: " << what << '\n';
  if (!fabric.name.empty()) out << "# fabric: " << one_line(fabric.name) << '\n';
  out << "# unit: millimetre; x along a course, y along a wale, z toward the front bed\n";
  out << "# yarn diameter: " << number_text(fabric.diameter_mm) << " mm\n";
  if (fabric.periodic)
    out << "# periodic cell: a1 = (" << number_text(fabric.width * fabric.diameter_mm) << " 0 0) mm, a2 = ("
        << number_text(fabric.skew * fabric.diameter_mm) << ' '
        << number_text(fabric.height * fabric.diameter_mm) << " 0) mm\n";
}

template <class PutYarn>
void for_each_copy(const Fabric& fabric, const ExportOptions& options, std::ostream& out, PutYarn put_yarn) {
  const int columns = fabric.periodic ? options.repeats[0] : 1,
            rows = fabric.periodic ? options.repeats[1] : 1;
  for (std::size_t y = 0; y < fabric.yarns.size(); ++y)
    for (int n = 0; n < rows; ++n)
      for (int m = 0; m < columns; ++m) {
        out << "o yarn_" << y;
        if (columns * rows > 1) out << "_cell_" << m << '_' << n;
        out << "\n# diameter: " << number_text(fabric.yarns[y].diameter * fabric.diameter_mm) << " mm\n";
        put_yarn(fabric.yarns[y], fabric.lattice(m, n));
      }
}

}  // namespace

void write_obj_lines(const std::filesystem::path& path, const Fabric& fabric, const ExportOptions& options) {
  AtomicFile file(path);
  std::ostream& out = file.stream();
  put_header(out, fabric, "yarn centrelines");
  std::size_t first = 1;  // OBJ counts from 1
  for_each_copy(fabric, options, out, [&](const FabricYarn& yarn, const Vec3& offset) {
    const std::vector<Vec3> points = polyline(fabric, yarn, options.per_segment);
    for (const Vec3& p : points) put(out, "v", (p + offset) * fabric.diameter_mm);
    out << 'l';
    for (std::size_t k = 0; k < points.size(); ++k) out << ' ' << first + k;
    out << '\n';
    first += points.size();
  });
  file.commit();
}

void write_obj_tubes(const std::filesystem::path& path, const Fabric& fabric, const ExportOptions& options) {
  AtomicFile file(path);
  std::ostream& out = file.stream();
  put_header(out, fabric, "yarn tubes");
  std::size_t first = 1, first_normal = 1;
  for_each_copy(fabric, options, out, [&](const FabricYarn& yarn, const Vec3& offset) {
    const TubeMesh mesh = tube_mesh(fabric, yarn, options.per_segment, options.sides);
    for (const Vec3& p : mesh.positions) put(out, "v", (p + offset) * fabric.diameter_mm);
    for (const Vec3& n : mesh.normals) put(out, "vn", n, 5);
    for (const TubeMesh::Triangle& t : mesh.triangles) {
      out << 'f';
      for (std::size_t k = 0; k < 3; ++k)
        out << ' ' << first + t.position[k] << "//" << first_normal + t.normal[k];
      out << '\n';
    }
    first += mesh.positions.size();
    first_normal += mesh.normals.size();
  });
  file.commit();
}

}  // namespace loopwright
