// Program: what both notations (fabric file and knitout) compile to, and all that the machine needs to know.
#pragma once
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "base/diagnostics.hpp"
#include "base/index.hpp"

namespace loopwright {

enum class Bed : std::uint8_t { front, back, front_slider, back_slider };
inline bool is_front(Bed b) { return b == Bed::front || b == Bed::front_slider; }
inline bool is_slider(Bed b) { return b == Bed::front_slider || b == Bed::back_slider; }

struct Needle {
  Bed bed = Bed::front;
  int index = 0;
  friend auto operator<=>(const Needle&, const Needle&) = default;
};
std::string to_string(Needle needle);  // "f3", "bs-2", as in knitout

enum class Direction : std::int8_t { left = -1, none = 0, right = 1 };

enum class Op : std::uint8_t {
  in,
  inhook,
  releasehook,
  out,
  outhook,  // carriers
  stitch,
  rack,
  pause,
  extension,  // machine state; extension: a known or unknown x- operation
  knit,
  tuck,
  split,
  miss,
  drop,
  amiss,
  xfer  // needles
};

// One instruction. Fields that its op does not use keep their defaults.
struct Instruction {
  Op op = Op::pause;
  Direction direction = Direction::none;
  Needle needle;                    // knit, tuck, split, miss, drop, amiss, xfer
  Needle target;                    // split, xfer
  std::vector<CarrierId> carriers;  // the carrier set, in the order written (first leads in plating)
  double value = 0, value2 = 0;     // rack: racking; stitch: leading and trailing stitch value
  std::string text;                 // extension: its name and arguments as written
  SourceLocation at;
};

// A yarn's data as the textile trade states it. Unset values are filled in from a material or by mechanics.
struct YarnData {
  std::string material;  // name of a set in data/materials, empty if none was named
  std::optional<double> linear_density_tex;
  std::optional<double> diameter_mm;       // outer (soft) diameter
  std::optional<double> core_diameter_mm;  // hard core
  std::optional<double> bend_stiffness_mN_mm2;
  std::optional<double> stretch_stiffness_cN;
  std::optional<double> twist_stiffness_mN_mm2;
  // Turns per metre by which a free piece of it would turn back: positive for Z twist, negative for S twist.
  std::optional<double> liveliness_per_m;
  std::optional<double> shell_stiffness;  // contact law: kc, N/mm^3
  std::optional<double> shell_exponent;   // contact law: p
  std::optional<double> friction_coefficient;
  std::string colour;  // "#rrggbb" or empty
};

enum class Edges : std::uint8_t { held, bound_off, free, periodic };

// What a fabric file says beside its instructions. A knitout file sets what its headers carry.
struct FabricSettings {
  std::string name;
  std::optional<double> gauge_npi;  // needles per inch
  std::optional<double> bed_gap_mm;
  std::optional<double> loop_length_mm;  // yarn in one knitted loop
  std::optional<double> tuck_length_mm;  // yarn in one tuck loop
  std::optional<double> float_slack;     // share by which a float is longer than the needles it spans
  std::optional<double> bed_change_mm;   // extra yarn where the yarn passes from one bed to the other
  double set = 0;                        // share of the knitted curvature kept as rest shape, 0 to 1
  std::optional<Edges> edges;
  int size_wales = 0, size_courses = 0;      // ;;Size, 0 if none
  int repeat_wales = 0, repeat_courses = 0;  // the notation's own repeat, 0 if it has none (knitout)
};

// The part of a programme that is wanted. Fabric files with held or periodic edges are knitted with a margin
// of whole repeats all round, so that every wanted loop has its true neighbours; the margin is then cut away.
struct ProgramWindow {
  int first_needle = 0, needles = 0;            // needle positions (both beds); needles = 0: everything
  int first_instruction = 0, instructions = 0;  // loops formed by instructions in [first, first + count)
};

struct Vermiculation;  // notation/vermiculation.hpp

struct Program {
  std::string file;  // name for messages
  int version = 2;
  std::vector<std::string> carriers;  // front to back; CarrierId indexes this
  std::vector<YarnData> yarns;        // by CarrierId, same length as carriers
  FabricSettings settings;
  std::vector<std::pair<std::string, std::string>> headers;  // as written, in order
  std::vector<Instruction> instructions;
  std::vector<std::pair<int, std::string>>
      source_marks;                // (instruction, text of its knitout `;!source:` comment)
  ProgramWindow window;            // of a fabric file with held or periodic edges
  std::vector<int> repeat_starts;  // instruction at which each course-wise repeat of a fabric file starts
  // The fabric file that it was knitted from, as it is written: write_vermiculation gives that text back,
  // comments and layout with it, wherever it still says what the instructions do. None: knitout, or made.
  std::shared_ptr<const Vermiculation> notation;
};

}  // namespace loopwright
