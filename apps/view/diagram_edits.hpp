// Changes of many needles at once: what the diagram's select, copy, paste and repeat do to a notation.
#pragma once
#include <cstddef>
#include <string>
#include <vector>

#include "notation/needle_diagram.hpp"

namespace loopwright {

// Lines and wales of a notation, both ends included; wales within one repeat.
struct DiagramArea {
  std::size_t first_line = 0, last_line = 0;
  int first_wale = 0, last_wale = 0;
};

// What needles do, cut from a notation: letters by line, pass and wale.
struct CopiedNeedles {
  struct CopiedPass {
    bool both_beds = false;
    std::string front, rear;  // letters; rear empty where a pass has one needle for each wale
  };
  std::vector<std::vector<CopiedPass>> lines;
  int wales = 0;
};

CopiedNeedles copied(const Vermiculation& notation, const DiagramArea& area);

// Each answers an empty text, or leaves the notation alone and says why.

// Puts copied needles with their first line and wale at a place; what would lie outside the notation is left
// out, and wales go on round the repeat.
[[nodiscard]] std::string paste(Vermiculation& notation, const CopiedNeedles& copy, std::size_t line,
                                int wale);
// So many further copies of lines after the last of them.
[[nodiscard]] std::string repeat_lines(Vermiculation& notation, std::size_t first, std::size_t last,
                                       int times);
[[nodiscard]] std::string remove_lines(Vermiculation& notation, std::size_t first, std::size_t last);
// The same operation at every working needle of an area, on one bed.
[[nodiscard]] std::string fill(Vermiculation& notation, const DiagramArea& area, Bed bed,
                               NeedleOperation operation);

// The operation and bed of a letter; unused for what is none.
struct LetterMeaning {
  NeedleOperation operation = NeedleOperation::unused;
  Bed bed = Bed::front;
};
LetterMeaning meaning_of(char letter, bool rear_row);

// Width of the notation's repeat: the least common width of its passes.
int repeat_width(const Vermiculation& notation);

}  // namespace loopwright
