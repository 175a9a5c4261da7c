// The reader of .yarns (Carnegie Mellon Textiles Lab, described with its .smobj tools): chunks of four
// letters, u32 length and records, little-endian: 'f3..' points, 'src.' a source line a point, 'yarn' point
// range, radius and colour, and 'strs', 'unit', 'chk.' (lengths between checkpoints), which are passed over.
#include <array>
#include <cstdio>

#include "outputs/atomic_file.hpp"
#include "outputs/exchange/bytes.hpp"
#include "outputs/exchange/curve_file.hpp"

namespace loopwright {
namespace {

[[noreturn]] void fail(const std::string& name, std::size_t at, const std::string& why) {
  throw FileError("cannot read " + name + ": byte " + std::to_string(at) + ": " + why);
}

struct YarnRecord {
  std::uint32_t begin, end;
  float radius;
  std::array<std::uint8_t, 4> rgba;
};
static_assert(sizeof(YarnRecord) == 16);

// The records of the chunk that must come next.
std::string_view chunk(std::string_view bytes, ByteReader& in, const std::string& name,
                       std::string_view wanted, std::size_t record) {
  const std::size_t begin = in.at();
  std::array<char, 4> letters{};
  std::uint32_t length = 0;
  if (!in.read(letters) || !in.read(length))
    fail(name, begin, "the file ends before the chunk '" + std::string(wanted) + "'");
  if (std::string_view(letters.data(), 4) != wanted)
    fail(name, begin,
         "here the chunk '" + std::string(wanted) + "' must begin" +
             (begin == 0 ? ": it is not a .yarns file" : ""));
  const std::size_t from = in.at();
  if (!in.skip(length))
    fail(name, begin, "the chunk '" + std::string(wanted) + "' is longer than the rest of the file");
  if (length % record != 0)
    fail(name, begin,
         "the chunk '" + std::string(wanted) + "' is not a whole number of records of " +
             std::to_string(record) + " bytes");
  return bytes.substr(from, length);
}

}  // namespace

CurveFile read_yarns(std::string_view bytes, const std::string& name) {
  ByteReader in(bytes);
  const std::string_view places = chunk(bytes, in, name, "f3..", 12);
  const std::string_view lines = chunk(bytes, in, name, "src.", 4);
  const std::size_t yarns_at = in.at();
  const std::string_view records = chunk(bytes, in, name, "yarn", sizeof(YarnRecord));
  const std::size_t points = places.size() / 12;
  if (lines.size() / 4 != points) fail(name, places.size() + 8, "there must be one source line a point");

  CurveFile file;
  file.basis = CurveBasis::midpoint_quadratic;
  ByteReader yarns(records);
  std::uint32_t before = 0;
  for (YarnRecord record{}; yarns.read(record);) {
    const std::string which = "yarn " + std::to_string(file.curves.size());
    // apart and in order, as the format demands; so no yarn can be told twice
    if (record.begin > record.end || record.end > points || record.begin < before)
      fail(name, yarns_at, which + " takes points that are not there or are another yarn's");
    before = record.end;
    FileCurve curve;
    if (!(record.radius >= 0 && record.radius < 1e30F)) fail(name, yarns_at, which + " has no sound radius");
    curve.radius = record.radius;
    std::array<char, 8> colour{};
    std::snprintf(colour.data(), colour.size(), "#%02x%02x%02x", record.rgba[0], record.rgba[1],
                  record.rgba[2]);
    curve.colour = colour.data();
    ByteReader own(places.substr(std::size_t{record.begin} * 12));
    for (std::uint32_t k = record.begin; k < record.end; ++k) {
      std::array<float, 3> p{};
      own.read(p);
      curve.points.push_back({p[0], p[1], p[2]});
      if (!is_finite(curve.points.back()))
        fail(name, 8 + std::size_t{k} * 12, which + ": a coordinate is not a number");
    }
    curve.closed = curve.points.size() > 3 && curve.points.front() == curve.points.back();
    if (curve.closed) curve.points.pop_back();
    file.curves.push_back(std::move(curve));
  }
  if (file.curves.empty()) fail(name, yarns_at, "there is no yarn in it");
  return file;
}

}  // namespace loopwright
