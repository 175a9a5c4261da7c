// The needle diagram of a notation (the running-thread drawing of knitters, "vermiculation" on point paper):
// what each pass does at each needle of both beds, ready to be drawn, and the changes that an editor makes.
// A diagram is a view: changes are made to the notation, whose text write_vermiculation gives.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "notation/vermiculation.hpp"

namespace loopwright {

enum class NeedleOperation : std::uint8_t {
  unused,    // faces a needle that is meant; not on the paper
  inactive,  // `-`, drawn as a cross
  missed,    // `.`, the yarn floats past
  stitch,    // g, e
  tuck,      // v, n
  transfer,  // t, T: gives its loops to the needle that it faces
  split,     // s, S: a stitch whose old loops go to the facing needle
  drop       // d, D: loops are let fall
};

struct DiagramNeedle {
  NeedleOperation operation = NeedleOperation::unused;
  double slot =
      0;  // on the axis that both beds share, in needle pitches: front i at i, rear i at i + racking
  SourceLocation at;  // the letter or instruction
};

/// One line of graph: what happens in one traverse of the carriage.
struct DiagramPass {
  int course = 0;                   // counted from 1; transfers belong to the course that they precede
  std::optional<std::size_t> line;  // of Vermiculation::lines; none: implied transfers, or from knitout
  std::size_t pass = 0;             // place in that line
  bool implied = false;             // transfers that the notation leaves unsaid
  bool carries_yarn = false;
  std::vector<int> yarns;  // places in NeedleDiagram::yarns, leading yarn first
  Direction direction = Direction::right;
  double racking = 0;                      // of the rear bed at the start of the pass, gating included
  std::vector<DiagramNeedle> front, rear;  // [NeedleDiagram::wales]
  SourceLocation at;
};

struct DiagramYarn {
  std::string name, colour;  // colour: "#rrggbb" or empty
};

struct NeedleDiagram {
  std::string name;
  std::vector<DiagramYarn> yarns;
  int first_needle = 0, wales = 0, courses = 0;
  int repeat_wales = 0, repeat_courses = 0;  // of the notation; 0 for knitout
  double gating = 0;                // 0.5: needles of the rear bed stand between those of the front bed
  bool rear_bed = false;            // some pass works on it
  std::vector<DiagramPass> passes;  // in knitting order
};

struct DiagramOptions {
  int wales = 0, courses = 0;        // 0: one repeat, of at least `fewest_wales`
  std::size_t first_pass = 0;        // knitout: first line of graph ...
  std::size_t most_passes = 10'000;  // ... and how many
};
inline constexpr std::size_t most_diagram_needles = 4'000'000;  // passes times wales
inline constexpr int fewest_wales = 6;  // drawn where the repeat is narrower: whole repeats

/// The diagram of a notation without errors. It shows the notation as it repeats: what the first course needs
/// from the needles is as the course before it in the repeat leaves it, except in a piece with free or
/// bound-off edges that the notation writes whole. Empty if the notation has no repeat. Throws
/// std::invalid_argument for more than `most_diagram_needles`.
NeedleDiagram needle_diagram(const Vermiculation& notation, const DiagramOptions& options = {});

/// The diagram of a programme's passes: runs of stitches, tucks and misses in one direction by the same
/// carriers at one racking, and runs of transfers and drops. `passes_in_all` gets their number where only a
/// part is wanted. Throws std::invalid_argument as above.
NeedleDiagram needle_diagram(const Program& program, const DiagramOptions& options = {},
                             std::size_t* passes_in_all = nullptr);

/// A needle in a pass of a notation.
struct NeedlePlace {
  std::size_t line = 0, pass = 0;  // of Vermiculation::lines and its passes
  Bed bed = Bed::front;
  int needle = 0;  // from 0 to the width of the repeat
};

// Each of the following changes the notation and answers an empty text, or leaves it alone and says why. What
// one letter of a repeat says is changed at this needle alone: the pass is first written out to the whole
// repeat.

/// `missed` and `inactive` take an operation away; in a pass with one needle for each wale an operation on
/// the other bed replaces what the facing needle did.
[[nodiscard]] std::string change_operation(Vermiculation& notation, NeedlePlace place,
                                           NeedleOperation operation);
/// change_operation at a needle that does nothing yet, and back to doing nothing.
[[nodiscard]] std::string add_operation(Vermiculation& notation, NeedlePlace place,
                                        NeedleOperation operation);
[[nodiscard]] std::string remove_operation(Vermiculation& notation, NeedlePlace place);

/// Racking before the letters of a pass; none: as the lines before leave it.
[[nodiscard]] std::string change_racking(Vermiculation& notation, std::size_t line, std::size_t pass,
                                         std::optional<double> racking);
/// Who knits a pass, and which way; Direction::none: back from where the carrier is.
[[nodiscard]] std::string change_feeder(Vermiculation& notation, std::size_t line, std::size_t pass,
                                        const std::vector<int>& yarns, Direction direction);
/// Writes a pass `front / rear`, so that both needles of a wale can be worked.
[[nodiscard]] std::string write_on_both_beds(Vermiculation& notation, std::size_t line, std::size_t pass);

/// Puts `course` before line `line` (at the end if there is no such line), or takes a line out. A bracket
/// around the place is opened there.
[[nodiscard]] std::string insert_line(Vermiculation& notation, std::size_t line, const CourseLine& course);
[[nodiscard]] std::string remove_line(Vermiculation& notation, std::size_t line);

/// Makes the repeat a wale wider by a copy of wale `wale`, or narrower without it; passes of one letter,
/// which repeat at every width, stay as they are written.
[[nodiscard]] std::string insert_wale(Vermiculation& notation, int wale);
[[nodiscard]] std::string remove_wale(Vermiculation& notation, int wale);

}  // namespace loopwright
