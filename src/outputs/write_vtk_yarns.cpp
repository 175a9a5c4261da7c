#include "outputs/write_vtk_yarns.hpp"

#include "outputs/atomic_file.hpp"

namespace loopwright {

void write_vtp(const std::filesystem::path& path, const Fabric& fabric, int points_per_segment) {
  const double mm = fabric.diameter_mm;
  std::vector<std::vector<Vec3>> lines;
  std::size_t points = 0;
  for (const FabricYarn& yarn : fabric.yarns) {
    lines.push_back(polyline(fabric, yarn, points_per_segment));
    points += lines.back().size();
  }
  AtomicFile file(path);
  std::ostream& out = file.stream();
  const auto open = [&out](const char* type, const char* name, int components) {
    out << "<DataArray type=\"" << type << "\" Name=\"" << name << "\" NumberOfComponents=\"" << components
        << "\" format=\"ascii\">\n";
  };
  const auto close = [&out] { out << "</DataArray>\n"; };
  out << "<?xml version=\"1.0\"?>\n<VTKFile type=\"PolyData\" version=\"0.1\" byte_order=\"LittleEndian\">\n"
      << "<PolyData>\n<Piece NumberOfPoints=\"" << points << "\" NumberOfVerts=\"0\" NumberOfLines=\""
      << lines.size() << "\" NumberOfStrips=\"0\" NumberOfPolys=\"0\">\n<CellData>\n";
  open("Int32", "yarn", 1);
  for (std::size_t y = 0; y < lines.size(); ++y) out << y << '\n';
  close();
  open("Float64", "diameter", 1);
  for (const FabricYarn& yarn : fabric.yarns) out << number_text(yarn.diameter * mm) << '\n';
  close();
  out << "</CellData>\n<Points>\n";
  open("Float64", "place", 3);
  for (const auto& line : lines)
    for (const Vec3& p : line)
      out << number_text(p.x * mm) << ' ' << number_text(p.y * mm) << ' ' << number_text(p.z * mm) << '\n';
  close();
  out << "</Points>\n<Lines>\n";
  open("Int64", "connectivity", 1);
  for (std::size_t i = 0; i < points; ++i) out << i << '\n';
  close();
  open("Int64", "offsets", 1);
  std::size_t end = 0;
  for (const auto& line : lines) out << (end += line.size()) << '\n';
  close();
  out << "</Lines>\n</Piece>\n</PolyData>\n</VTKFile>\n";
  file.commit();
}

}  // namespace loopwright
