#include "outputs/state.hpp"

#include <array>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <new>
#include <span>
#include <vector>

#include "outputs/atomic_file.hpp"
#include "outputs/hdf5_columns.hpp"

namespace loopwright {
namespace {

constexpr int version = 1;
constexpr std::size_t block_size = 512;
constexpr std::string_view magic = "Loopwright state ";

// FNV-1a, 64 bits (Fowler, Noll, Vo). Each step is one to one, so that a change of a single byte always
// shows.
std::uint64_t checksum(std::span<const char> bytes) {
  std::uint64_t sum = 14695981039346656037ULL;
  for (const char c : bytes) sum = (sum ^ static_cast<unsigned char>(c)) * 1099511628211ULL;
  return sum;
}

// The user block that belongs to the given HDF5 bytes.
std::array<char, block_size> user_block(std::span<const char> bytes) {
  std::array<char, block_size> block{};
  std::snprintf(
      block.data(), block.size(),
      "%s%d\nlength %zu\nchecksum fnv1a64 %016llx\nAn HDF5 file follows at byte 512. A state that was "
      "changed by another program does not pass the checksum.\n",
      magic.data(), version, bytes.size(), static_cast<unsigned long long>(checksum(bytes)));
  return block;
}

[[noreturn]] void fail(const std::filesystem::path& path, const std::string& why) {
  throw FileError("cannot read " + path.string() + ": " + why);
}

std::vector<char> file_bytes(const std::filesystem::path& path) {
  std::error_code error;
  if (std::filesystem::is_directory(path, error)) fail(path, "it is a folder");
  std::ifstream in(path, std::ios::binary);
  if (!in) fail(path, std::strerror(errno));
  in.seekg(0, std::ios::end);
  const auto size = static_cast<std::streamoff>(in.tellg());
  if (size < 0) fail(path, "its length is unknown");
  std::vector<char> bytes(static_cast<std::size_t>(size));
  in.seekg(0);
  if (!in.read(bytes.data(), size)) fail(path, "it ends early");
  return bytes;
}

// Throws unless the user block fits the rest of the file.
void check_block(const std::filesystem::path& path, const std::vector<char>& bytes) {
  const std::string_view start(bytes.data(), std::min(bytes.size(), block_size));
  if (!start.starts_with(magic)) fail(path, "it is not a Loopwright state");
  const std::string_view number =
      start.substr(magic.size(), start.find('\n') - std::min(start.find('\n'), magic.size()));
  if (number != std::to_string(version))
    fail(path, "it is damaged, or of format version " + std::string(number.substr(0, 8)) +
                   "; this program reads version " + std::to_string(version));
  if (bytes.size() < block_size) fail(path, "it is cut short");
  const std::span<const char> content(bytes.data() + block_size, bytes.size() - block_size);
  const auto block = user_block(content);
  if (std::memcmp(block.data(), bytes.data(), block_size) != 0)
    fail(path, "it is damaged (length or checksum disagree); take an older copy");
}

template <class T, class List, class Field>
std::vector<T> gathered(const List& list, Field field) {
  std::vector<T> column;
  column.reserve(list.size());
  for (const auto& item : list) column.push_back(static_cast<T>(field(item)));
  return column;
}

template <class List>
std::vector<std::int32_t> shifts(const List& list) {
  std::vector<std::int32_t> column;
  for (const auto& item : list) column.insert(column.end(), item.shift.begin(), item.shift.end());
  return column;
}

void put_fabric(hdf5::Writer& out, const Fabric& fabric) {
  const auto one = [&out](const char* name, double value, const char* unit) {
    out.column(name, std::span<const double>(&value, 1), 1, unit);
  };
  out.texts("fabric/name", {fabric.name});
  one("fabric/diameter", fabric.diameter_mm, "mm");
  one("fabric/width", fabric.width, "d");
  one("fabric/height", fabric.height, "d");
  one("fabric/skew", fabric.skew, "d");
  one("fabric/wales", fabric.wales, nullptr);
  one("fabric/courses", fabric.courses, nullptr);
  const std::uint8_t periodic = fabric.periodic ? 1 : 0;
  out.column("fabric/periodic", std::span<const std::uint8_t>(&periodic, 1));
}

// Of set yarn alone: a row for every segment of every yarn, in order.
void put_set(hdf5::Writer& out, const Fabric& fabric) {
  if (!is_set(fabric)) return;
  std::vector<double> curvatures;
  for (const FabricYarn& yarn : fabric.yarns)
    for (std::size_t e = 0; e < static_cast<std::size_t>(yarn.segments()); ++e) {
      const auto row = yarn.natural_curvature.empty() ? std::array<double, 4>{} : yarn.natural_curvature[e];
      curvatures.insert(curvatures.end(), row.begin(), row.end());
    }
  out.column("segments/natural_curvature", curvatures, 4, "1/d");
}

void put_yarns(hdf5::Writer& out, const Fabric& fabric) {
  const std::vector<FabricYarn>& yarns = fabric.yarns;
  using Y = FabricYarn;
  out.column("yarns/yarn", gathered<std::int32_t>(yarns, [](const Y& y) { return y.yarn.value; }));
  out.column("yarns/carrier", gathered<std::int32_t>(yarns, [](const Y& y) { return y.carrier.value; }));
  out.texts("yarns/colour", gathered<std::string>(yarns, [](const Y& y) { return y.colour; }));
  out.column("yarns/diameter", gathered<double>(yarns, [](const Y& y) { return y.diameter; }), 1, "d");
  out.column("yarns/linear_density", gathered<double>(yarns, [](const Y& y) { return y.linear_density_tex; }),
             1, "tex");
  out.column("yarns/segment_rest_length",
             gathered<double>(yarns, [](const Y& y) { return y.segment_rest_length; }), 1, "d");
  put_set(out, fabric);
  if (std::any_of(yarns.begin(), yarns.end(), [](const Y& y) { return y.liveliness != 0; }))
    out.column("yarns/liveliness", gathered<double>(yarns, [](const Y& y) { return y.liveliness; }), 1,
               "rad/d");
  out.column("yarns/periodic", gathered<std::uint8_t>(yarns, [](const Y& y) { return y.periodic ? 1 : 0; }));
  out.column("yarns/shift", shifts(yarns), 2);
  out.column("yarns/control_points",
             gathered<std::int32_t>(yarns, [](const Y& y) { return y.control_points.size(); }));
  std::vector<double> places;
  std::vector<std::uint8_t> held;
  for (const Y& yarn : yarns) {
    for (const Vec3& q : yarn.control_points) places.insert(places.end(), {q.x, q.y, q.z});
    held.insert(held.end(), yarn.held.begin(), yarn.held.end());
  }
  out.column("control_points/position", places, 3, "d");
  out.column("control_points/held", held);
}

void put_loops(hdf5::Writer& out, const Fabric& fabric) {
  using L = LoopSpan;
  const auto& loops = fabric.loops;
  out.column("loops/loop", gathered<std::int32_t>(loops, [](const L& l) { return l.loop.value; }));
  out.column("loops/yarn", gathered<std::int32_t>(loops, [](const L& l) { return l.yarn; }));
  out.column("loops/begin", gathered<double>(loops, [](const L& l) { return l.begin; }));
  out.column("loops/apex", gathered<double>(loops, [](const L& l) { return l.apex; }));
  out.column("loops/end", gathered<double>(loops, [](const L& l) { return l.end; }));
  out.column("loops/line", gathered<std::int32_t>(loops, [](const L& l) { return l.at.line; }));
  out.column("loops/text_column", gathered<std::int32_t>(loops, [](const L& l) { return l.at.column; }));
  out.column("loops/kind",
             gathered<std::int32_t>(loops, [](const L& l) { return static_cast<int>(l.kind); }));
  out.column("loops/side",
             gathered<std::int32_t>(loops, [](const L& l) { return static_cast<int>(l.side); }));
  out.column("loops/direction",
             gathered<std::int32_t>(loops, [](const L& l) { return static_cast<int>(l.direction); }));
  out.column("loops/course", gathered<std::int32_t>(loops, [](const L& l) { return l.course; }));
  out.column("loops/slot", gathered<double>(loops, [](const L& l) { return l.slot; }));
  out.column("loops/bed", gathered<std::int32_t>(loops, [](const L& l) { return static_cast<int>(l.bed); }));
  using I = PlacedInterlacing;
  const auto& pairs = fabric.interlacings;
  out.column("interlacings/parent", gathered<std::int32_t>(pairs, [](const I& i) { return i.parent.value; }));
  out.column("interlacings/child", gathered<std::int32_t>(pairs, [](const I& i) { return i.child.value; }));
  out.column("interlacings/sign", gathered<std::int32_t>(pairs, [](const I& i) { return i.sign; }));
  out.column("interlacings/shift", shifts(pairs), 2);
}

// States without friction have no such group, as those from before it was kept.
void put_history(hdf5::Writer& out, const ContactHistory& history) {
  if (history.empty()) return;
  std::vector<std::int32_t> segments, shift;
  std::vector<double> slip;
  for (const ContactSlip& contact : history) {
    segments.insert(segments.end(), {contact.a, contact.b});
    shift.insert(shift.end(), {contact.m, contact.n});
    slip.insert(slip.end(), {contact.slip.x, contact.slip.y, contact.slip.z});
  }
  out.column("history/segments", segments, 2);
  out.column("history/shift", shift, 2);
  out.column("history/slip", slip, 3, "d");
}

template <class Map, class T>
void put_map(const Map& map, std::vector<std::string>& names, std::vector<T>& values) {
  for (const auto& [name, value] : map) {
    names.push_back(name);
    values.push_back(value);
  }
}

}  // namespace

void write_state(const std::filesystem::path& path, const State& state) {
  if (const std::string fault = fabric_fault(state.fabric); !fault.empty())
    throw std::invalid_argument("this fabric cannot be saved: " + fault);
  if (const std::string fault = history_fault(state.fabric, state.history); !fault.empty())
    throw std::invalid_argument("this state cannot be saved: " + fault);
  std::vector<char> bytes;
  try {
    hdf5::Writer out;
    put_fabric(out, state.fabric);
    put_yarns(out, state.fabric);
    put_loops(out, state.fabric);
    put_history(out, state.history);
    std::vector<std::string> names, text_names, texts;
    std::vector<double> numbers;
    put_map(state.numbers, names, numbers);
    put_map(state.texts, text_names, texts);
    out.texts("run/number_names", names);
    out.column("run/numbers", numbers);
    out.texts("run/text_names", text_names);
    out.texts("run/texts", texts);
    bytes = out.bytes();
  } catch (const hdf5::ContentError& error) {
    throw FileError("cannot write " + path.string() + ": " + error.what());
  }
  const auto block = user_block(bytes);
  AtomicFile file(path);
  file.stream().write(block.data(), static_cast<std::streamsize>(block.size()));
  file.stream().write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  file.commit();
}

State state_from_columns(const hdf5::Reader& in);  // state_columns.cpp

State read_state(const std::filesystem::path& path) {
  try {
    std::vector<char> bytes = file_bytes(path);
    check_block(path, bytes);
    const hdf5::Reader in(std::span<char>(bytes).subspan(block_size));
    State state = state_from_columns(in);
    if (const std::string fault = fabric_fault(state.fabric); !fault.empty()) fail(path, fault);
    if (const std::string fault = history_fault(state.fabric, state.history); !fault.empty())
      fail(path, fault);
    return state;
  } catch (const hdf5::ContentError& error) {
    fail(path, error.what());
  } catch (const std::bad_alloc&) {
    fail(path, "it does not fit into memory");
  }
}

}  // namespace loopwright
