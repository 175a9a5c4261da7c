#include "outputs/write_vtk.hpp"

#include "outputs/atomic_file.hpp"

namespace loopwright {
namespace {

template <class Values, class Text>
void array(std::ostream& out, const char* type, const char* name, int components, const Values& values,
           const Text& text) {
  out << "<DataArray type=\"" << type << "\" Name=\"" << name << "\" NumberOfComponents=\"" << components
      << "\" format=\"ascii\">\n";
  for (const auto& v : values) out << text(v) << '\n';
  out << "</DataArray>\n";
}

std::string text_of(const Vec3& v) {
  return number_text(v.x) + ' ' + number_text(v.y) + ' ' + number_text(v.z);
}

// Cells of one sort: point numbers, and where each cell's list ends.
struct Cells {
  std::vector<std::size_t> points, ends;

  void write(std::ostream& out, const char* sort) const {
    const auto number = [](std::size_t n) { return std::to_string(n); };
    out << '<' << sort << ">\n";
    array(out, "Int64", "connectivity", 1, points, number);
    array(out, "Int64", "offsets", 1, ends, number);
    out << "</" << sort << ">\n";
  }
};

}  // namespace

void write_vtp(const std::filesystem::path& path, const LoopModel& model, const NetState& state) {
  const double mm = model.geometry.diameter_mm;
  std::vector<Vec3> points, velocities;
  std::vector<int> kinds;
  std::vector<double> extensions;
  Cells verts, lines;
  for (std::size_t i = 0; i < state.size(); ++i) {
    points.push_back(state.position(i) * mm);
    velocities.push_back(state.velocity(i) * mm);
    verts.points.push_back(i);
    verts.ends.push_back(i + 1);
    kinds.push_back(0);
    extensions.push_back(0);
  }
  for (const Spring& s : model.net.springs) {
    lines.points.push_back(static_cast<std::size_t>(s.a));
    lines.points.push_back(static_cast<std::size_t>(s.b));
    lines.ends.push_back(lines.points.size());
    kinds.push_back(1 + static_cast<int>(s.kind));
    const double rest = norm(s.rest);
    extensions.push_back(rest > 0 ? extension(s, state) / rest : 0);
  }
  for (const CurveYarn& yarn : curves_at(model, state).yarns) {
    for (const TypePoint& point : yarn.points) {
      lines.points.push_back(points.size());
      points.push_back(point.position * mm);
      velocities.push_back({});
    }
    lines.ends.push_back(lines.points.size());
    kinds.push_back(5);
    extensions.push_back(0);
  }
  AtomicFile file(path);
  std::ostream& out = file.stream();
  out << "<?xml version=\"1.0\"?>\n<VTKFile type=\"PolyData\" version=\"0.1\" byte_order=\"LittleEndian\">\n"
      << "<PolyData>\n<Piece NumberOfPoints=\"" << points.size() << "\" NumberOfVerts=\"" << verts.ends.size()
      << "\" NumberOfLines=\"" << lines.ends.size() << "\" NumberOfStrips=\"0\" NumberOfPolys=\"0\">\n";
  out << "<PointData>\n";
  array(out, "Float64", "velocity", 3, velocities, text_of);
  out << "</PointData>\n<CellData>\n";
  array(out, "Int32", "kind", 1, kinds, [](int k) { return std::to_string(k); });
  array(out, "Float64", "extension", 1, extensions, number_text);
  out << "</CellData>\n<Points>\n";
  array(out, "Float64", "place", 3, points, text_of);
  out << "</Points>\n";
  verts.write(out, "Verts");
  lines.write(out, "Lines");
  out << "</Piece>\n</PolyData>\n</VTKFile>\n";
  file.commit();
}

void write_pvd(const std::filesystem::path& path, const std::vector<std::pair<double, std::string>>& frames) {
  AtomicFile file(path);
  std::ostream& out = file.stream();
  out << "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"0.1\" "
         "byte_order=\"LittleEndian\">\n"
      << "<Collection>\n";
  for (const auto& [time, name] : frames)
    out << "<DataSet timestep=\"" << number_text(time) << "\" part=\"0\" file=\"" << name << "\"/>\n";
  out << "</Collection>\n</VTKFile>\n";
  file.commit();
}

}  // namespace loopwright
