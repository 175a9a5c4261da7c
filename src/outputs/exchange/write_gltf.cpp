#include "outputs/exchange/write_gltf.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <ostream>
#include <sstream>
#include <stdexcept>

#include "outputs/atomic_file.hpp"
#include "outputs/exchange/bytes.hpp"
#include "outputs/exchange/yarn_points.hpp"
#include "outputs/exchange/yarn_skin.hpp"
#include "outputs/yarn_scene.hpp"

namespace loopwright {
namespace {

using Json = nlohmann::ordered_json;

constexpr int float_component = 5126, unsigned_component = 5125, array_buffer = 34962, element_buffer = 34963;
constexpr std::size_t vertex_bytes = 40;  // place, normal, u v, loop, line: ten floats

struct PlaceBounds {
  std::array<float, 3> low, high;
};

// What one yarn takes in the binary part: interleaved vertices, then triangles.
struct Stretch {
  std::size_t vertices = 0, triangles = 0, begin = 0;
  std::size_t vertex_length() const { return vertices * vertex_bytes; }
  std::size_t triangle_length() const { return triangles * 3 * sizeof(std::uint32_t); }
  std::size_t end() const { return begin + vertex_length() + triangle_length(); }
};

std::vector<Stretch> stretches(const Fabric& fabric, const ExportOptions& options) {
  std::vector<Stretch> all;
  std::size_t begin = 0;
  for (const FabricYarn& yarn : fabric.yarns) {
    all.push_back({skin_vertices(yarn, options), skin_triangles(yarn, options), begin});
    begin = all.back().end();
  }
  return all;
}

// Colours of files are sRGB, those of materials linear (IEC 61966-2-1).
double linear_light(std::uint8_t value) {
  const double c = value / 255.0;
  return c <= 0.04045 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4);
}

Json material_of(std::size_t number, const Fabric& fabric) {
  const std::array<std::uint8_t, 3> rgb = drawn_colour(fabric, number);
  Json material;
  material["name"] = "yarn_" + std::to_string(number);
  material["pbrMetallicRoughness"] = {
      {"baseColorFactor", {linear_light(rgb[0]), linear_light(rgb[1]), linear_light(rgb[2]), 1.0}},
      {"metallicFactor", 0.0},
      {"roughnessFactor", 0.9}};
  return material;
}

Json mesh_of(std::size_t number, const Fabric& fabric, const FabricYarn& yarn) {
  const std::size_t first = 6 * number;  // accessors of this yarn
  Json mesh;
  mesh["name"] = "yarn_" + std::to_string(number);
  mesh["primitives"] = Json::array({{{"attributes",
                                      {{"POSITION", first},
                                       {"NORMAL", first + 1},
                                       {"TEXCOORD_0", first + 2},
                                       {"_LOOP", first + 3},
                                       {"_LINE", first + 4}}},
                                     {"indices", first + 5},
                                     {"material", number}}});
  mesh["extras"] = {
      {"yarn", number},
      {"carrier", yarn.carrier.value},
      {"diameter_mm", yarn.diameter * fabric.diameter_mm},
      {"linear_density_tex", yarn.linear_density_tex > 0 ? Json(yarn.linear_density_tex) : Json(nullptr)},
      {"rest_length_mm", yarn.segment_rest_length * yarn.segments() * fabric.diameter_mm}};
  return mesh;
}

void add_accessors(Json& document, std::size_t number, const Stretch& stretch, const PlaceBounds& bounds) {
  const std::size_t view = 2 * number;
  Json& views = document["bufferViews"];
  views.push_back({{"buffer", 0},
                   {"byteOffset", stretch.begin},
                   {"byteLength", stretch.vertex_length()},
                   {"byteStride", vertex_bytes},
                   {"target", array_buffer}});
  views.push_back({{"buffer", 0},
                   {"byteOffset", stretch.begin + stretch.vertex_length()},
                   {"byteLength", stretch.triangle_length()},
                   {"target", element_buffer}});
  Json& accessors = document["accessors"];
  std::size_t offset = 0;
  for (const auto& [type, length] :
       {std::pair("VEC3", 12), {"VEC3", 12}, {"VEC2", 8}, {"SCALAR", 4}, {"SCALAR", 4}}) {
    accessors.push_back({{"bufferView", view},
                         {"byteOffset", offset},
                         {"componentType", float_component},
                         {"count", stretch.vertices},
                         {"type", type}});
    if (offset == 0) accessors.back()["min"] = bounds.low, accessors.back()["max"] = bounds.high;
    offset += static_cast<std::size_t>(length);
  }
  accessors.push_back({{"bufferView", view + 1},
                       {"byteOffset", 0},
                       {"componentType", unsigned_component},
                       {"count", 3 * stretch.triangles},
                       {"type", "SCALAR"}});
}

Json description(const Fabric& fabric, const ExportOptions& options, const std::vector<Stretch>& all,
                 const std::vector<PlaceBounds>& bounds) {
  const double metre = fabric.diameter_mm * 1e-3;  // of a d
  Json document;
  document["asset"] = {{"version", "2.0"}, {"generator", "Loopwright"}};
  document["asset"]["extras"] = {{"fabric", fabric.name}, {"yarn_diameter_mm", fabric.diameter_mm}};
  if (fabric.periodic) {
    document["asset"]["extras"]["lattice_mm"] = {
        {fabric.width * fabric.diameter_mm, 0, 0},
        {fabric.skew * fabric.diameter_mm, fabric.height * fabric.diameter_mm, 0}};
  }
  document["scene"] = 0;
  Json nodes = Json::array(), children = Json::array();
  for (std::size_t y = 0; y < all.size(); ++y)
    for_each_cell(fabric, options, [&](int m, int n, const Vec3& moved) {
      Json node{{"name", "yarn_" + std::to_string(y)}, {"mesh", y}};
      if (m != 0 || n != 0) {
        node["name"] = "yarn_" + std::to_string(y) + "_cell_" + std::to_string(m) + "_" + std::to_string(n);
        node["translation"] = {moved.x * metre, moved.y * metre, moved.z * metre};
      }
      children.push_back(nodes.size());
      nodes.push_back(std::move(node));
    });
  document["scenes"] = Json::array({{{"nodes", children}}});
  document["nodes"] = std::move(nodes);
  for (std::size_t y = 0; y < all.size(); ++y) {
    document["meshes"].push_back(mesh_of(y, fabric, fabric.yarns[y]));
    document["materials"].push_back(material_of(y, fabric));
  }
  document["accessors"] = Json::array();
  document["bufferViews"] = Json::array();
  for (std::size_t y = 0; y < all.size(); ++y) add_accessors(document, y, all[y], bounds[y]);
  document["buffers"] = Json::array({{{"byteLength", all.empty() ? 0 : all.back().end()}}});
  return document;
}

// The bytes of one yarn; its bounds are those of the floats as they are written.
PlaceBounds append_yarn(std::string& bytes, const Fabric& fabric, std::size_t number,
                        const std::vector<int>& loops, const ExportOptions& options) {
  const FabricYarn& yarn = fabric.yarns[number];
  const YarnSkin skin = yarn_skin(fabric, yarn, options);
  const std::vector<int> of_ring = loops_at_points(fabric, number, loops, options.per_segment);
  constexpr float inf = std::numeric_limits<float>::infinity();
  PlaceBounds bounds{{inf, inf, inf}, {-inf, -inf, -inf}};
  for (const YarnSkin::Vertex& vertex : skin.vertices) {
    for (int c = 0; c < 3; ++c) {
      const auto value = static_cast<float>(vertex.place_mm[c] * 1e-3);
      const auto at = static_cast<std::size_t>(c);
      bounds.low[at] = std::min(bounds.low[at], value);
      bounds.high[at] = std::max(bounds.high[at], value);
      append_bytes(bytes, value);
    }
    for (int c = 0; c < 3; ++c) append_bytes(bytes, static_cast<float>(vertex.normal[c]));
    append_bytes(bytes, static_cast<float>(vertex.u));
    append_bytes(bytes, static_cast<float>(vertex.v));
    const int loop = of_ring[vertex.ring];
    append_bytes(bytes, static_cast<float>(loop));
    append_bytes(bytes,
                 static_cast<float>(loop < 0 ? 0 : fabric.loops[static_cast<std::size_t>(loop)].at.line));
  }
  for (const auto& triangle : skin.triangles)
    for (const std::uint32_t corner : triangle) append_bytes(bytes, corner);
  return bounds;
}

// A name may hold bytes that are no UTF-8.
std::string text_of(const Json& document, int indent = -1) {
  return document.dump(indent, ' ', false, Json::error_handler_t::replace);
}

std::string base64(const std::string& bytes) {
  constexpr std::string_view letters = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t k = 0; k < bytes.size(); k += 3) {
    std::uint32_t three = 0;
    for (std::size_t j = 0; j < 3; ++j)
      three = three << 8 | (k + j < bytes.size() ? static_cast<unsigned char>(bytes[k + j]) : 0U);
    for (std::size_t j = 0; j < 4; ++j)
      text += k + j <= bytes.size() ? letters[three >> (18 - 6 * j) & 63] : '=';
  }
  return text;
}

}  // namespace

void write_glb(const std::filesystem::path& path, const Fabric& fabric, const ExportOptions& options) {
  check_tube_options(options);
  const std::vector<Stretch> all = stretches(fabric, options);
  // the widest texts that the bounds can have keep room for the true ones, known only after the vertices
  constexpr float wide = -1.23456789e-30F;
  const PlaceBounds widest{{wide, wide, wide}, {wide, wide, wide}};
  std::string text = text_of(description(fabric, options, all, std::vector<PlaceBounds>(all.size(), widest)));
  const std::size_t json_length = (text.size() + 3) / 4 * 4, binary = all.empty() ? 0 : all.back().end();
  const std::size_t whole = 12 + 8 + json_length + 8 + binary;
  if (whole > std::size_t{std::numeric_limits<std::uint32_t>::max()})
    throw std::invalid_argument("a .glb holds 4 GiB and this fabric needs " + std::to_string(whole >> 20) +
                                " MiB: take fewer --sides or --per-segment");
  AtomicFile file(path);
  std::ostream& out = file.stream();
  std::string bytes;
  append_bytes(bytes, std::uint32_t{0x46546C67});  // "glTF"
  append_bytes(bytes, std::uint32_t{2});
  append_bytes(bytes, static_cast<std::uint32_t>(whole));
  append_bytes(bytes, static_cast<std::uint32_t>(json_length));
  append_bytes(bytes, std::uint32_t{0x4E4F534A});  // "JSON"
  const std::size_t json_begin = bytes.size();
  bytes.append(json_length, ' ');
  append_bytes(bytes, static_cast<std::uint32_t>(binary));
  append_bytes(bytes, std::uint32_t{0x004E4942});  // "BIN"
  out.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));

  const std::vector<std::vector<int>> loops = loops_of_yarns(fabric);
  std::vector<PlaceBounds> bounds;
  for (std::size_t y = 0; y < all.size(); ++y) {
    bytes.clear();
    bounds.push_back(append_yarn(bytes, fabric, y, loops[y], options));
    out.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  }
  text = text_of(description(fabric, options, all, bounds));
  if (text.size() > json_length) throw std::logic_error("glb: the description outgrew its room");
  out.seekp(static_cast<std::streamoff>(json_begin));
  out << text;
  file.commit();
}

void write_gltf(const std::filesystem::path& path, const Fabric& fabric, const ExportOptions& options) {
  check_tube_options(options);
  const std::vector<std::vector<int>> loops = loops_of_yarns(fabric);
  std::string bytes;
  std::vector<PlaceBounds> bounds;
  for (std::size_t y = 0; y < fabric.yarns.size(); ++y)
    bounds.push_back(append_yarn(bytes, fabric, y, loops[y], options));
  Json document = description(fabric, options, stretches(fabric, options), bounds);
  document["buffers"][0]["uri"] = "data:application/octet-stream;base64," + base64(bytes);
  AtomicFile file(path);
  file.stream() << text_of(document, 1) << '\n';
  file.commit();
}

}  // namespace loopwright
