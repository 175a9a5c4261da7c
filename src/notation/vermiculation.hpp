// Vermiculation: a fabric file as it is written, letter by letter, before it is knitted to its size.
// The needle diagram and the editor work on this; the machine gets the Program that it compiles to.
// The grammar is in docs/notation.md.
#pragma once
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/diagnostics.hpp"
#include "notation/program.hpp"

namespace loopwright {

inline constexpr std::size_t most_letters = 5'000'000;  // of a whole notation, repeats written out

/// One letter of a course. g e: stitch on the front, rear bed; v n: tuck on the front, rear bed; s S: split
/// on the front, rear needle, a stitch whose old loops go to the facing needle; t T: transfer from the front,
/// rear needle; d D: the front, rear needle drops its loops; '.': missed needle, the yarn floats past; '-':
/// inactive needle, nothing is done.
struct Cell {
  char letter = '-';
  SourceLocation at;
};

/// Whether a letter takes yarn: g e v n s S. Whether it moves loops without yarn: t T d D. Whether it stands
/// for a needle of the rear bed: e n S T D.
bool forms_loop(char letter);
bool moves_loops(char letter);
bool is_rear_letter(char letter);

/// A racking `Rk` or `rk` written before the cell `before`: 0 leads the pass, cells.size() trails it.
struct RackMark {
  std::size_t before = 0;
  double racking = 0;  // absolute, knitout's sign: Rk is +k, rk is -k
  SourceLocation at;
};

/// What the carriage does in one traverse: yarn letters, or transfers and drops, or nothing but racking.
struct Pass {
  std::vector<int> yarns;                 // places in Vermiculation::yarns, leading yarn first
  Direction direction = Direction::none;  // none: back from where the carrier is
  bool both_beds = false;                 // written `front / rear`
  std::vector<Cell> cells;                // the front needles if both_beds, else one needle per wale
  std::vector<Cell> rear;                 // the rear needles if both_beds
  std::vector<RackMark> racks;
  SourceLocation at;
  bool knits() const;      // holds a yarn letter
  bool transfers() const;  // holds a letter that moves loops without yarn
  bool carries_yarn()
      const;  // knits, or has its feeder or direction named: the carrier goes past its needles
};

/// A line: passes that `&` joins. It counts as a course if one of them knits.
struct CourseLine {
  std::vector<Pass> passes;
  bool knits() const;
};

struct VermiculationYarn {
  std::string name;  // "A"
  YarnData data;
  SourceLocation at;
};

enum class Gating : std::uint8_t { opposite, half_pitch };

/// A line of the file as it stands, for write_vermiculation.
struct WrittenLine {
  enum class Kind : std::uint8_t { magic, text, header, open, close, course };
  Kind kind = Kind::text;  // text: blank or a comment; open, close: `[` and `]*n`
  std::string text;        // with its comment, without its line end
  std::size_t times = 1;   // close: n
  std::string end =
      "\n";  // line feed, after carriage returns if there were any; empty at the end of the file
};

struct Vermiculation {
  std::string file;
  int version = 1;
  bool byte_order_mark = false;  // before the magic line
  FabricSettings settings;
  std::vector<VermiculationYarn> yarns;
  std::vector<std::string> carriers;  // machine carriers of the yarns; empty: named as the yarns
  std::optional<Gating> gating;       // none: half pitch if facing needles knit in the same pass
  std::vector<std::pair<std::string, std::string>> headers;
  std::vector<CourseLine> lines;     // with `[ ... ]*n` written out
  std::vector<WrittenLine> written;  // the file, a line each; its courses, written out, are those of `lines`
};

/// What the caller may want otherwise than the file says, and how much is too much.
struct FabricOptions {
  std::optional<Edges> edges;
  int size_wales = 0, size_courses = 0;  // 0: as in the file
  std::size_t most_instructions = 20'000'000;
};

/// Reads the text. What is wrong is said in `diagnostics` with line, column and remedy.
Vermiculation parse_vermiculation(std::string_view text, Diagnostics& diagnostics);

/// Knits the notation to its size: the Program with window and repeat starts. If `diagnostics` already holds
/// errors the Program has settings and yarns, but no instructions. The Program keeps the notation.
Program compile_vermiculation(std::shared_ptr<const Vermiculation> vermiculation,
                              const FabricOptions& options, Diagnostics& diagnostics);
Program compile_vermiculation(const Vermiculation& vermiculation, const FabricOptions& options,
                              Diagnostics& diagnostics);

}  // namespace loopwright
