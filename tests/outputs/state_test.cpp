#include "outputs/state.hpp"

#include <gmock/gmock.h>
#include <hdf5.h>

#include <bit>
#include <cstring>
#include <limits>
#include <random>

#include "outputs/atomic_file.hpp"
#include "plain_fabric.hpp"
#include "temporary_folder.hpp"

namespace loopwright {
namespace {

using test::content;
using ::testing::HasSubstr;

class StateTest : public test::TemporaryFolder {
 protected:
  std::string error_of(const std::string& bytes) const {
    std::ofstream(in_folder("damaged.h5"), std::ios::binary) << bytes;
    try {
      read_state(in_folder("damaged.h5"));
    } catch (const FileError& error) {
      return error.what();
    }
    return "";
  }
};

std::uint64_t bits(double v) { return std::bit_cast<std::uint64_t>(v); }
std::array<std::uint64_t, 3> bits(const Vec3& v) { return {bits(v.x), bits(v.y), bits(v.z)}; }

// Structured bindings name every field: a field that is added to these types does not compile here until it
// is saved and compared too.
void expect_equal(const FabricYarn& a, const FabricYarn& b) {
  const auto& [yarn, carrier, colour, diameter, tex, rest, lively, set, periodic, shift, points, held] = a;
  EXPECT_EQ(yarn, b.yarn);
  EXPECT_EQ(carrier, b.carrier);
  EXPECT_EQ(colour, b.colour);
  EXPECT_EQ(bits(diameter), bits(b.diameter));
  EXPECT_EQ(bits(tex), bits(b.linear_density_tex));
  EXPECT_EQ(bits(rest), bits(b.segment_rest_length));
  EXPECT_EQ(bits(lively), bits(b.liveliness));
  EXPECT_EQ(set, b.natural_curvature);
  EXPECT_EQ(periodic, b.periodic);
  EXPECT_EQ(shift, b.shift);
  ASSERT_EQ(points.size(), b.control_points.size());
  for (std::size_t k = 0; k < points.size(); ++k) EXPECT_EQ(bits(points[k]), bits(b.control_points[k]));
  EXPECT_EQ(held, b.held);
}

void expect_equal(const LoopSpan& a, const LoopSpan& b) {
  const auto& [loop, yarn, begin, apex, end, at, kind, side, direction, course, slot, bed] = a;
  EXPECT_EQ(loop, b.loop);
  EXPECT_EQ(yarn, b.yarn);
  EXPECT_EQ(bits(begin), bits(b.begin));
  EXPECT_EQ(bits(apex), bits(b.apex));
  EXPECT_EQ(bits(end), bits(b.end));
  EXPECT_EQ(at, b.at);
  EXPECT_EQ(kind, b.kind);
  EXPECT_EQ(side, b.side);
  EXPECT_EQ(direction, b.direction);
  EXPECT_EQ(course, b.course);
  EXPECT_EQ(bits(slot), bits(b.slot));
  EXPECT_EQ(bed, b.bed);
}

void expect_equal(const Fabric& a, const Fabric& b) {
  const auto& [name, yarns, loops, interlacings, diameter_mm, periodic, width, height, skew, wales, courses] =
      a;
  EXPECT_EQ(name, b.name);
  ASSERT_EQ(yarns.size(), b.yarns.size());
  for (std::size_t y = 0; y < yarns.size(); ++y) expect_equal(yarns[y], b.yarns[y]);
  ASSERT_EQ(loops.size(), b.loops.size());
  for (std::size_t k = 0; k < loops.size(); ++k) expect_equal(loops[k], b.loops[k]);
  ASSERT_EQ(interlacings.size(), b.interlacings.size());
  for (std::size_t k = 0; k < interlacings.size(); ++k) {
    const auto& [parent, child, sign, shift] = interlacings[k];
    EXPECT_EQ(parent, b.interlacings[k].parent);
    EXPECT_EQ(child, b.interlacings[k].child);
    EXPECT_EQ(sign, b.interlacings[k].sign);
    EXPECT_EQ(shift, b.interlacings[k].shift);
  }
  EXPECT_EQ(bits(diameter_mm), bits(b.diameter_mm));
  EXPECT_EQ(periodic, b.periodic);
  EXPECT_EQ(bits(width), bits(b.width));
  EXPECT_EQ(bits(height), bits(b.height));
  EXPECT_EQ(bits(skew), bits(b.skew));
  EXPECT_EQ(bits(wales), bits(b.wales));
  EXPECT_EQ(bits(courses), bits(b.courses));
}

// A piece in which no field has its default.
State rich_state() {
  State state;
  Fabric& fabric = state.fabric;
  fabric = test::plain_piece(7, 5);
  fabric.name = "Köper, 1x1 — \"test\"";
  fabric.skew = -0.125;
  std::mt19937_64 random(7);
  std::normal_distribution<double> noise(0, 0.01);
  for (FabricYarn& yarn : fabric.yarns) {
    for (Vec3& q : yarn.control_points) q += {noise(random), noise(random), noise(random)};
    yarn.colour = "#a0b1c2";
    yarn.diameter = 0.75;
    yarn.linear_density_tex = 66.7;
    yarn.carrier = CarrierId(3);
  }
  fabric.yarns[1].control_points[4] = {-0.0, std::numeric_limits<double>::denorm_min(),
                                       std::numeric_limits<double>::max()};
  fabric.yarns[1].liveliness = -1.0 / 7;
  FabricYarn& set = fabric.yarns[1];
  for (int e = 0; e < set.segments(); ++e) set.natural_curvature.push_back({0.1 * e, 1.0 / 3, 0, 0.25});
  fabric.loops[3].kind = LoopKind::split;
  fabric.loops[4].side = StitchSide::rear;
  fabric.loops[5].direction = Direction::left;
  fabric.loops[5].course = 7;
  fabric.loops[5].slot = -2.5;
  fabric.loops[5].bed = Bed::back;
  fabric.interlacings[2].sign = -1;
  fabric.interlacings[2].shift = {-1, 2};
  state.numbers = {
      {"residual", 1.0 / 3}, {"unknown", std::numeric_limits<double>::quiet_NaN()}, {"a/b c", -0.0}};
  state.texts = {{"source", std::string(200000, 'x') + "\nge\n"}, {"empty", ""}, {"Größe", "žluť"}};
  state.history = {{0, 3, 0, 0, {0.01, -0.0, 1e-300}}, {0, 3, 0, 1, {}}, {2, 1, -1, 1, {-0.02, 0, 0.5}}};
  return state;
}

TEST_F(StateTest, RoundTripIsExact) {
  for (State state : {rich_state(), State{test::plain_cell(), {}, {}, {}}, State{}}) {
    write_state(in_folder("a.h5"), state);
    const State back = read_state(in_folder("a.h5"));
    expect_equal(state.fabric, back.fabric);
    ASSERT_EQ(state.numbers.size(), back.numbers.size());
    for (const auto& [name, value] : state.numbers)
      EXPECT_EQ(bits(value), bits(back.numbers.at(name))) << name;
    EXPECT_EQ(state.texts, back.texts);
    ASSERT_EQ(state.history.size(), back.history.size());
    for (std::size_t k = 0; k < state.history.size(); ++k) {
      const auto& [a, b, m, n, slip] = state.history[k];
      const ContactSlip& other = back.history[k];
      EXPECT_EQ(std::tie(a, b, m, n), std::tie(other.a, other.b, other.m, other.n));
      EXPECT_EQ(bits(slip), bits(other.slip));
    }
  }
}

TEST_F(StateTest, HistoryOfOtherContactsIsRefused) {
  const Fabric fabric = test::plain_piece(2, 2);
  const auto fault = [&](const ContactHistory& history) { return history_fault(fabric, history); };
  EXPECT_EQ(fault({{0, 1, 0, 0, {}}, {0, 2, 0, 0, {}}}), "");
  EXPECT_THAT(fault({{0, 100000, 0, 0, {}}}), HasSubstr("does not exist"));
  EXPECT_THAT(fault({{-1, 0, 0, 0, {}}}), HasSubstr("does not exist"));
  EXPECT_THAT(fault({{0, 2, 0, 0, {}}, {0, 1, 0, 0, {}}}), HasSubstr("order"));
  EXPECT_THAT(fault({{0, 1, 0, 0, {0, std::numeric_limits<double>::infinity(), 0}}}), HasSubstr("finite"));
  State state{fabric, {}, {}, {{0, 100000, 0, 0, {}}}};
  EXPECT_THROW(write_state(in_folder("a.h5"), state), std::invalid_argument);
  EXPECT_FALSE(std::filesystem::exists(in_folder("a.h5")));
}

TEST_F(StateTest, EqualStatesAreEqualFilesAndSmall) {
  const State state{test::plain_piece(30, 30), {}, {}, {}};
  write_state(in_folder("a.h5"), state);
  write_state(in_folder("b.h5"), state);
  const std::string a = content(in_folder("a.h5"));
  EXPECT_EQ(a, content(in_folder("b.h5")));
  EXPECT_LT(a.size(), 30U * 30 * 16 * 3 * 8) << "bytes of the control points alone, uncompressed";
}

// The file is an HDF5 file like any other, user block and all.
TEST_F(StateTest, IsAnHdf5FileForOthers) {
  write_state(in_folder("a.h5"), rich_state());
  const hid_t file = H5Fopen(in_folder("a.h5").c_str(), H5F_ACC_RDONLY, H5P_DEFAULT);
  ASSERT_GE(file, 0);
  const hid_t column = H5Dopen2(file, "control_points/position", H5P_DEFAULT);
  ASSERT_GE(column, 0);
  const hid_t space = H5Dget_space(column);
  std::array<hsize_t, 2> shape{};
  EXPECT_EQ(H5Sget_simple_extent_dims(space, shape.data(), nullptr), 2);
  EXPECT_EQ(shape, (std::array<hsize_t, 2>{5 * (7 * 16 + 3), 3}));
  H5Sclose(space);
  H5Dclose(column);
  H5Fclose(file);
}

TEST_F(StateTest, EveryTruncationIsAnError) {
  write_state(in_folder("a.h5"), {test::plain_piece(2, 2, 8), {{"residual", 1e-5}}, {}});
  const std::string whole = content(in_folder("a.h5"));
  for (std::size_t length = 0; length < whole.size(); length += length < 600 ? 7 : 211)
    EXPECT_THAT(error_of(whole.substr(0, length)), HasSubstr("damaged.h5")) << length;
  EXPECT_THAT(error_of(whole + "x"), HasSubstr("damaged"));
}

TEST_F(StateTest, EveryFlippedBitIsAnError) {
  write_state(in_folder("a.h5"), {test::plain_piece(2, 2, 8), {{"residual", 1e-5}}, {}});
  const std::string whole = content(in_folder("a.h5"));
  std::mt19937 random(1);
  for (int trial = 0; trial < 300; ++trial) {
    std::string bytes = whole;
    const std::size_t place = trial < 64 ? static_cast<std::size_t>(trial) * 8 : random() % bytes.size();
    bytes[place] = static_cast<char>(bytes[place] ^ (1 << (random() % 8)));
    EXPECT_THAT(error_of(bytes), HasSubstr("cannot read")) << "byte " << place;
  }
}

TEST_F(StateTest, ForeignFilesAreNamedAsSuch) {
  EXPECT_THAT(error_of("solid ascii\n"), HasSubstr("it is not a Loopwright state"));
  EXPECT_THAT(error_of(""), HasSubstr("it is not a Loopwright state"));
  EXPECT_THAT(error_of("Loopwright state 2\nlength 5\n"), HasSubstr("version 2"));
  const hid_t file = H5Fcreate(in_folder("foreign.h5").c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT);
  H5Fclose(file);
  EXPECT_THAT(error_of(content(in_folder("foreign.h5"))), HasSubstr("it is not a Loopwright state"));
  EXPECT_THROW(read_state(in_folder("missing.h5")), FileError);
  EXPECT_THROW(read_state(folder_), FileError);
}

// A file with a right checksum that another program made: what HDF5 reads is checked just the same.
class ForgedState : public StateTest {
 protected:
  // The HDF5 part is changed through HDF5 itself and the user block made anew as the format says.
  template <class Change>
  std::string forged(Change change) const {
    Fabric fabric = test::plain_piece(2, 2, 8);
    FabricYarn& set = fabric.yarns[0];
    set.natural_curvature.assign(static_cast<std::size_t>(set.segments()), {0.1, 0.2, 0.3, 0.4});
    set.liveliness = 0.1;
    write_state(in_folder("a.h5"), {fabric, {}, {}, {{0, 5, 0, 0, {0.01, 0, 0}}}});
    const std::string part = content(in_folder("a.h5")).substr(512);
    std::ofstream(in_folder("part.h5"), std::ios::binary) << part;
    const hid_t file = H5Fopen(in_folder("part.h5").c_str(), H5F_ACC_RDWR, H5P_DEFAULT);
    EXPECT_GE(file, 0);
    change(file);
    H5Fclose(file);
    const std::string bytes = content(in_folder("part.h5"));
    std::uint64_t sum = 14695981039346656037ULL;
    for (const char c : bytes) sum = (sum ^ static_cast<unsigned char>(c)) * 1099511628211ULL;
    std::string block = content(in_folder("a.h5")).substr(0, 512);
    std::array<char, 64> line{};
    std::snprintf(line.data(), line.size(), "length %zu\nchecksum fnv1a64 %016llx\n", bytes.size(),
                  static_cast<unsigned long long>(sum));
    const std::string tail = block.substr(block.find("An HDF5"));
    block = block.substr(0, block.find("length")) + line.data() + tail;
    block.resize(512, '\0');
    return error_of(block + bytes);
  }
  template <class T>
  static void overwrite_first(hid_t file, const char* name, hid_t type, T value) {
    const hid_t column = H5Dopen2(file, name, H5P_DEFAULT), space = H5Dget_space(column);
    std::array<hsize_t, 2> start{0, 0}, count{1, 1};
    H5Sselect_hyperslab(space, H5S_SELECT_SET, start.data(), nullptr, count.data(), nullptr);
    const hsize_t one = 1;
    const hid_t memory = H5Screate_simple(1, &one, nullptr);
    EXPECT_GE(H5Dwrite(column, type, memory, space, H5P_DEFAULT, &value), 0);
    H5Sclose(memory);
    H5Sclose(space);
    H5Dclose(column);
  }
};

TEST_F(ForgedState, UnchangedContentPasses) {
  EXPECT_EQ(forged([](hid_t) {}), "");
}

TEST_F(ForgedState, WrongContentIsSaid) {
  const auto nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THAT(forged([&](hid_t f) { overwrite_first(f, "control_points/position", H5T_NATIVE_DOUBLE, nan); }),
              HasSubstr("finite"));
  EXPECT_THAT(forged([](hid_t f) { overwrite_first(f, "fabric/diameter", H5T_NATIVE_DOUBLE, -1.0); }),
              HasSubstr("diameter"));
  EXPECT_THAT(forged([](hid_t f) { overwrite_first(f, "yarns/control_points", H5T_NATIVE_INT, 1000000); }),
              HasSubstr("more control points"));
  EXPECT_THAT(forged([](hid_t f) { overwrite_first(f, "yarns/control_points", H5T_NATIVE_INT, -5); }),
              HasSubstr("control points"));
  EXPECT_THAT(forged([](hid_t f) { overwrite_first(f, "loops/yarn", H5T_NATIVE_INT, 99); }),
              HasSubstr("yarn does not exist"));
  EXPECT_THAT(forged([](hid_t f) { overwrite_first(f, "loops/kind", H5T_NATIVE_INT, 17); }),
              HasSubstr("loops/kind"));
  EXPECT_THAT(forged([](hid_t f) { overwrite_first(f, "loops/side", H5T_NATIVE_INT, 0); }),
              HasSubstr("loops/side"));
  EXPECT_THAT(forged([](hid_t f) { overwrite_first(f, "fabric/periodic", H5T_NATIVE_INT, 2); }),
              HasSubstr("fabric/periodic"));
  EXPECT_THAT(
      forged([](hid_t f) { overwrite_first(f, "segments/natural_curvature", H5T_NATIVE_DOUBLE, -1.0); }),
      HasSubstr("natural curvature"));
  EXPECT_THAT(forged([](hid_t f) {
                overwrite_first(f, "yarns/liveliness", H5T_NATIVE_DOUBLE,
                                std::numeric_limits<double>::infinity());
              }),
              HasSubstr("liveliness"));
  EXPECT_THAT(forged([](hid_t f) { overwrite_first(f, "history/segments", H5T_NATIVE_INT, 9999); }),
              HasSubstr("segment that does not exist"));
  EXPECT_THAT(forged([](hid_t f) { overwrite_first(f, "history/shift", H5T_NATIVE_INT, 300); }),
              HasSubstr("history/shift"));
  EXPECT_THAT(forged([](hid_t f) { H5Ldelete(f, "history/slip", H5P_DEFAULT); }),
              HasSubstr("'history/slip' is missing"));
  EXPECT_THAT(forged([](hid_t f) { H5Ldelete(f, "loops/apex", H5P_DEFAULT); }),
              HasSubstr("'loops/apex' is missing"));
  EXPECT_THAT(forged([](hid_t f) {
                H5Lmove(f, "loops/kind", f, "yarns/diameter2", H5P_DEFAULT, H5P_DEFAULT);
                H5Ldelete(f, "yarns/diameter", H5P_DEFAULT);
                H5Lmove(f, "yarns/diameter2", f, "yarns/diameter", H5P_DEFAULT, H5P_DEFAULT);
              }),
              HasSubstr("wrong type"));
}

// A column that claims more than any memory holds, without a byte of it stored.
TEST_F(ForgedState, HugeColumnIsAnErrorNotAnAllocation) {
  const std::string error = forged([](hid_t f) {
    H5Ldelete(f, "control_points/held", H5P_DEFAULT);
    const hsize_t rows = hsize_t{1} << 50, chunk = 1024;
    const hid_t space = H5Screate_simple(1, &rows, nullptr), creation = H5Pcreate(H5P_DATASET_CREATE);
    H5Pset_chunk(creation, 1, &chunk);
    H5Dclose(H5Dcreate2(f, "control_points/held", H5T_STD_U8LE, space, H5P_DEFAULT, creation, H5P_DEFAULT));
    H5Pclose(creation);
    H5Sclose(space);
  });
  EXPECT_THAT(error, HasSubstr("wrong shape"));
}

TEST(FabricFault, NamesWhatIsWrong) {
  EXPECT_EQ(fabric_fault(test::plain_piece(2, 2)), "");
  EXPECT_EQ(fabric_fault(test::plain_cell()), "");
  Fabric fabric = test::plain_piece(2, 2);
  fabric.yarns[1].held.pop_back();
  EXPECT_THAT(fabric_fault(fabric), HasSubstr("yarn 1: its held marks"));
  fabric = test::plain_piece(2, 2);
  fabric.yarns[0].control_points.resize(3);
  fabric.yarns[0].held.resize(3);
  EXPECT_THAT(fabric_fault(fabric), HasSubstr("too few control points"));
  fabric = test::plain_cell();
  fabric.width = 0;
  EXPECT_THAT(fabric_fault(fabric), HasSubstr("no width"));
}

}  // namespace
}  // namespace loopwright
