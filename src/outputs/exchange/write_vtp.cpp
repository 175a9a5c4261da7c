#include "outputs/exchange/write_vtp.hpp"

#include <cstdint>
#include <functional>
#include <ostream>
#include <string>

#include "outputs/atomic_file.hpp"
#include "outputs/exchange/bytes.hpp"
#include "outputs/exchange/yarn_points.hpp"

namespace loopwright {
namespace {

struct Line {
  std::size_t yarn = 0, first_point = 0;
  Vec3 offset_mm;
};

// One array of the file: what it is called, and how the bytes of one line's points (or of one line) are made.
struct Column {
  const char* type;
  std::string name;
  int components;
  std::size_t bytes_each, entries;  // bytes an entry; entries in all
  std::function<void(const Line&, const YarnPoints&, std::string&)> append;
  std::size_t offset = 0;  // of its length field, in the appended data

  std::size_t bytes() const { return bytes_each * entries; }
};

// Entries of an array that has one for each point, as 32-bit numbers.
template <class T, class Value>
auto each_point(Value value) {
  return [value](const Line&, const YarnPoints& points, std::string& bytes) {
    for (std::size_t k = 0; k < points.arc_mm.size(); ++k)
      append_bytes(bytes, static_cast<T>(value(points, k)));
  };
}

std::vector<Column> point_data(const Fabric& fabric, const PointSource& source, std::size_t points) {
  std::vector<Column> columns;
  const auto add_float = [&](const std::string& name, auto value) {
    columns.push_back({"Float32", name, 1, 4, points, each_point<float>(value)});
  };
  const auto add_integer = [&](const std::string& name, auto value) {
    columns.push_back({"Int32", name, 1, 4, points, each_point<std::int32_t>(value)});
  };
  add_float("arc_mm", [](const YarnPoints& p, std::size_t k) { return p.arc_mm[k]; });
  add_float("curvature_per_mm", [](const YarnPoints& p, std::size_t k) { return p.curvature_per_mm[k]; });
  if (!fabric.loops.empty()) {
    add_integer("loop", [](const YarnPoints& p, std::size_t k) { return p.loop[k]; });
    for (const LoopColumn& column : loop_columns) {
      const auto value = [&fabric, &column](const YarnPoints& p, std::size_t k) {
        return loop_value(fabric, column, p.loop[k]);
      };
      if (column.none == column.none)
        add_integer(column.name, value);
      else
        add_float(column.name, value);  // NaN where there is no loop
    }
  }
  if (source.forces()) {
    add_float(source.forces()->tension_name, [](const YarnPoints& p, std::size_t k) { return p.tension[k]; });
    add_float(source.forces()->contact_name, [](const YarnPoints& p, std::size_t k) { return p.contact[k]; });
  }
  return columns;
}

std::vector<Column> cell_data(const Fabric& fabric, std::size_t lines) {
  const auto integer = [](auto value) {
    return [value](const Line& line, const YarnPoints&, std::string& bytes) {
      append_bytes(bytes, static_cast<std::int32_t>(value(line)));
    };
  };
  return {{"Int32", "yarn", 1, 4, lines, integer([](const Line& line) { return line.yarn; })},
          {"Int32", "carrier", 1, 4, lines,
           integer([&fabric](const Line& line) { return fabric.yarns[line.yarn].carrier.value; })},
          {"Float64", "diameter", 1, 8, lines,
           [&fabric](const Line& line, const YarnPoints&, std::string& bytes) {
             append_bytes(bytes, fabric.yarns[line.yarn].diameter * fabric.diameter_mm);
           }}};
}

Column places(std::size_t points) {
  return {"Float64", "place", 3, 24, points, [](const Line& line, const YarnPoints& p, std::string& bytes) {
            for (const Vec3& place : p.place_mm) append_bytes(bytes, place + line.offset_mm);
          }};
}

std::vector<Column> connectivity(std::size_t points, std::size_t lines) {
  return {{"Int64", "connectivity", 1, 8, points,
           [](const Line& line, const YarnPoints& p, std::string& bytes) {
             for (std::size_t k = 0; k < p.arc_mm.size(); ++k)
               append_bytes(bytes, static_cast<std::int64_t>(line.first_point + k));
           }},
          {"Int64", "offsets", 1, 8, lines, [](const Line& line, const YarnPoints& p, std::string& bytes) {
             append_bytes(bytes, static_cast<std::int64_t>(line.first_point + p.arc_mm.size()));
           }}};
}

void put_headers(std::ostream& out, const char* group, std::vector<Column>& columns, std::size_t& offset) {
  out << '<' << group << ">\n";
  for (Column& column : columns) {
    column.offset = offset;
    out << "<DataArray type=\"" << column.type << "\" Name=\"" << column.name << "\" NumberOfComponents=\""
        << column.components << "\" format=\"appended\" offset=\"" << offset << "\"/>\n";
    offset += sizeof(std::uint64_t) + column.bytes();
  }
  out << "</" << group << ">\n";
}

}  // namespace

void write_vtp(const std::filesystem::path& path, const State& state, const ExportOptions& options) {
  const Fabric& fabric = state.fabric;
  const PointSource source(state, options.per_segment);
  const std::size_t cells = cell_count(fabric, options), points = source.count() * cells,
                    lines = fabric.yarns.size() * cells;
  std::vector<std::vector<Column>> groups{point_data(fabric, source, points),
                                          cell_data(fabric, lines),
                                          {places(points)},
                                          connectivity(points, lines)};
  AtomicFile file(path);
  std::ostream& out = file.stream();
  out << "<?xml version=\"1.0\"?>\n<VTKFile type=\"PolyData\" version=\"1.0\" byte_order=\"LittleEndian\" "
         "header_type=\"UInt64\">\n<PolyData>\n<Piece NumberOfPoints=\""
      << points << "\" NumberOfVerts=\"0\" NumberOfLines=\"" << lines
      << "\" NumberOfStrips=\"0\" NumberOfPolys=\"0\">\n";
  std::size_t offset = 0;
  constexpr std::array<const char*, 4> names{"PointData", "CellData", "Points", "Lines"};
  for (std::size_t g = 0; g < groups.size(); ++g) put_headers(out, names[g], groups[g], offset);
  out << "</Piece>\n</PolyData>\n<AppendedData encoding=\"raw\">\n_";

  // Every array has its place in the file, so one yarn after the other is written, each into all arrays.
  const auto start = out.tellp();
  std::vector<std::size_t> next;
  std::string bytes;
  const auto put_at = [&](std::size_t place) {
    out.seekp(start + static_cast<std::streamoff>(place));
    out.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
    place += bytes.size();
    bytes.clear();
    return place;
  };
  for (const auto& group : groups)
    for (const Column& column : group) {
      append_bytes(bytes, static_cast<std::uint64_t>(column.bytes()));
      next.push_back(put_at(column.offset));
    }
  Line line;
  for (std::size_t yarn = 0; yarn < fabric.yarns.size(); ++yarn) {
    const YarnPoints of_yarn = source.of(yarn);
    for_each_cell(fabric, options, [&](int, int, const Vec3& moved) {
      line.yarn = yarn;
      line.offset_mm = moved * fabric.diameter_mm;
      std::size_t array = 0;
      for (const auto& group : groups)
        for (const Column& column : group) {
          column.append(line, of_yarn, bytes);
          next[array] = put_at(next[array]);
          ++array;
        }
      line.first_point += of_yarn.arc_mm.size();
    });
  }
  out.seekp(start + static_cast<std::streamoff>(offset));
  out << "\n</AppendedData>\n</VTKFile>\n";
  file.commit();
}

}  // namespace loopwright
