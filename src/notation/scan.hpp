// Small tools that both readers share: lines, words with their columns, numbers, quantities with units.
#pragma once
#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace loopwright {

/// One line of a text without its end; `carriage_return` says that it ended with CR LF, or several CR.
struct TextLine {
  std::string_view text;
  int number = 0;  // 1-based
  bool carriage_return = false;
};

/// Hands out the lines of a text one by one. The last line may lack its end.
class LineReader {
 public:
  explicit LineReader(std::string_view text) : rest_(text) {}
  bool next(TextLine& line);

 private:
  std::string_view rest_;
  int number_ = 0;
};

/// A word between blanks (space, tab) and the column, 1-based in bytes, at which it starts.
struct Word {
  std::string_view text;
  int column = 0;
};

/// Hands out the words of a line one by one; nothing is copied, so a line of 100 MB costs nothing extra.
class WordReader {
 public:
  explicit WordReader(std::string_view line, int first_column = 1)
      : line_(line), first_column_(first_column) {}
  bool next(Word& word);
  /// Column just past the last word handed out: where something is missing.
  int column() const { return first_column_ + static_cast<int>(at_); }

 private:
  std::string_view line_;
  std::size_t at_ = 0;
  int first_column_ = 1;
};

/// Where a text stops being UTF-8 (RFC 3629); npos if it is UTF-8 throughout.
std::size_t first_byte_not_utf8(std::string_view text);

bool is_blank(char c);
bool is_digit(char c);
bool is_letter(char c);
std::string_view trimmed(std::string_view text);
std::string lower_case(std::string_view text);

/// A decimal number such as `-0.75`, `+1`, `.5`, `1e-8`; nothing for anything else, infinity and NaN
/// included.
std::optional<double> parsed_number(std::string_view text);
/// A whole number with an optional sign; nothing if it does not fit into an int.
std::optional<int> parsed_integer(std::string_view text);

/// The shortest digits that read back as the same number.
std::string written_number(double value);

/// The word of `known` that `word` was meant for, told by its letters' case or by one letter that is wrong,
/// left out, put in or swapped with the next; empty if there is none.
std::string_view word_meant(std::string_view word, std::span<const std::string_view> known);

/// Text as it may stand in a message: control and non-ASCII bytes as \xNN.
std::string printable(std::string_view text);
/// The same in quotes and cut after 40 bytes.
std::string quoted(std::string_view text);

/// What a quantity measures and, in brackets, the unit that `parsed_quantity` answers in.
enum class Dimension {
  length,           // mm
  linear_density,   // tex
  force,            // cN
  bend_stiffness,   // mN mm^2; of twist as well
  shell_stiffness,  // N/mm^3
  twist,            // turns per metre
  share,            // 1; `%` is understood
  gauge             // needles per inch; the unit may be left out
};

struct Quantity {
  double value = 0;     // in the unit of its dimension
  std::string problem;  // empty if the text was understood; else what is wrong and what to write
};

/// A number with its unit, e.g. `6.2 mm`, `2/28 Nm`, `10 mN mm^2`, `5 %`. A missing unit is a problem except
/// for shares and gauges.
Quantity parsed_quantity(std::string_view text, Dimension dimension);

}  // namespace loopwright
