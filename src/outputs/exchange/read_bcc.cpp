// The reader of BCC, Cem Yuksel's Binary Curve Collection. Layout, little-endian: 'BCC', a byte of byte
// counts (0x44: 4-byte integers and floats), two letters for the kind of curve, a byte for the dimensions, a
// byte for the up axis (1 y, 2 z), u64 curves, u64 points, 40 bytes of text; then for each curve i32 n,
// negative where the curve is closed, and |n| points of float32.
#include <array>
#include <cctype>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>

#include "outputs/atomic_file.hpp"
#include "outputs/exchange/bytes.hpp"
#include "outputs/exchange/curve_file.hpp"

namespace loopwright {
namespace {

struct BccHeader {
  std::array<char, 3> magic;
  std::uint8_t byte_counts;
  std::array<char, 2> kind;
  std::uint8_t dimensions, up;
  std::uint64_t curves, points;
  std::array<char, 40> text;
};
static_assert(sizeof(BccHeader) == 64);

[[noreturn]] void fail(const std::string& name, std::size_t at, const std::string& why) {
  throw FileError("cannot read " + name + ": byte " + std::to_string(at) + ": " + why);
}

CurveBasis basis_of(const BccHeader& header, const std::string& name) {
  const std::string kind(header.kind.data(), 2);
  if (kind == "C0") return CurveBasis::catmull_rom;
  if (kind == "BS") return CurveBasis::bspline;
  if (kind == "BZ") return CurveBasis::bezier;
  if (kind == "PL") return CurveBasis::through_points;
  const bool text = std::isgraph(static_cast<unsigned char>(kind[0])) != 0 &&
                    std::isgraph(static_cast<unsigned char>(kind[1])) != 0;
  fail(name, 4,
       "curves of kind " + (text ? "'" + kind + "'" : std::string("unknown")) +
           " are not known; C0 (uniform Catmull-Rom), BS, BZ and PL are");
}

FileCurve curve_of(ByteReader& in, const std::string& name, std::size_t number) {
  const std::string which = "curve " + std::to_string(number);
  std::int32_t count = 0;
  const std::size_t begin = in.at();
  if (!in.read(count)) fail(name, begin, "the file ends before " + which);
  FileCurve curve;
  curve.closed = count < 0;
  const auto points = static_cast<std::size_t>(std::llabs(count));
  // never believed before there are as many bytes
  if (points > in.left() / (3 * sizeof(float)))
    fail(name, begin, which + " is to have " + std::to_string(points) + " points and the file ends before");
  curve.points.reserve(points);
  for (std::size_t k = 0; k < points; ++k) {
    std::array<float, 3> p{};
    const std::size_t at = in.at();
    in.read(p);
    curve.points.push_back({p[0], p[1], p[2]});
    if (!is_finite(curve.points.back()))
      fail(name, at, which + ": a coordinate of point " + std::to_string(k) + " is not a number");
  }
  return curve;
}

}  // namespace

CurveFile read_bcc(std::string_view bytes, const std::string& name) {
  ByteReader in(bytes);
  BccHeader header{};
  if (!bytes.starts_with("BCC"))
    fail(name, 0, "it is not a BCC file: it does not begin with the letters BCC");
  if (!in.read(header)) fail(name, bytes.size(), "the file ends within its header of 64 bytes");
  if (header.byte_counts != 0x44)
    fail(name, 3, "integers and floats of 4 bytes are read (0x44), others are not");
  if (header.dimensions != 3)
    fail(name, 6, "points in space are read, not of " + std::to_string(header.dimensions) + " dimensions");
  CurveFile file;
  file.basis = basis_of(header, name);
  file.z_up = header.up == 2;
  // what Loopwright's own files say
  const std::string text(header.text.data(), strnlen(header.text.data(), header.text.size()));
  if (double mm = 0; std::sscanf(text.c_str(), "Loopwright mm diameter %lf", &mm) == 1 && mm > 0 && mm < 1e6)
    file.diameter_mm = mm, file.millimetres = true;
  // each curve has at least its count
  if (header.curves > in.left() / sizeof(std::int32_t))
    fail(name, 8, "it is to hold " + std::to_string(header.curves) + " curves and is too short for them");
  if (header.curves == 0) fail(name, 8, "there is no curve in it");
  for (std::size_t k = 0; k < header.curves; ++k) file.curves.push_back(curve_of(in, name, k));
  return file;
}

}  // namespace loopwright
