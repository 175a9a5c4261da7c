#include "notation/scan.hpp"

#include <array>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstring>

namespace loopwright {

bool LineReader::next(TextLine& line) {
  if (rest_.empty()) return false;
  const std::size_t end = rest_.find('\n');
  line.text = rest_.substr(0, end);
  rest_.remove_prefix(end == std::string_view::npos ? rest_.size() : end + 1);
  line.carriage_return = line.text.ends_with('\r');
  while (line.text.ends_with('\r')) line.text.remove_suffix(1);
  line.number = ++number_;
  return true;
}

bool WordReader::next(Word& word) {
  while (at_ < line_.size() && is_blank(line_[at_])) ++at_;
  if (at_ == line_.size()) return false;
  const std::size_t begin = at_;
  while (at_ < line_.size() && !is_blank(line_[at_])) ++at_;
  word.text = line_.substr(begin, at_ - begin);
  word.column = first_column_ + static_cast<int>(begin);
  return true;
}

std::size_t first_byte_not_utf8(std::string_view text) {
  const auto byte = [&](std::size_t k) { return static_cast<unsigned char>(k < text.size() ? text[k] : 0); };
  std::size_t at = 0;
  while (at < text.size()) {
    // eight ASCII bytes at once: that is what nearly all programmes are made of
    std::uint64_t eight = 0;
    if (at + 8 <= text.size()) {
      std::memcpy(&eight, text.data() + at, 8);
      if ((eight & 0x8080808080808080U) == 0) {
        at += 8;
        continue;
      }
    }
    const unsigned char first = byte(at);
    // how many bytes follow, and the range of the second one, which shuts out overlong forms and surrogates
    // (RFC 3629, section 4)
    std::size_t more = 0;
    unsigned char low = 0x80, high = 0xbf;
    if (first >= 0xc2 && first <= 0xdf) {
      more = 1;
    } else if (first >= 0xe0 && first <= 0xef) {
      more = 2;
      if (first == 0xe0) low = 0xa0;
      if (first == 0xed) high = 0x9f;
    } else if (first >= 0xf0 && first <= 0xf4) {
      more = 3;
      if (first == 0xf0) low = 0x90;
      if (first == 0xf4) high = 0x8f;
    } else if (first >= 0x80) {
      return at;
    }
    if (more > 0 && (byte(at + 1) < low || byte(at + 1) > high)) return at;
    for (std::size_t k = 2; k <= more; ++k)
      if (byte(at + k) < 0x80 || byte(at + k) > 0xbf) return at;
    at += 1 + more;
  }
  return std::string_view::npos;
}

bool is_blank(char c) { return c == ' ' || c == '\t'; }
bool is_digit(char c) { return c >= '0' && c <= '9'; }
bool is_letter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); }

std::string_view trimmed(std::string_view text) {
  while (!text.empty() && is_blank(text.front())) text.remove_prefix(1);
  while (!text.empty() && is_blank(text.back())) text.remove_suffix(1);
  return text;
}

std::string lower_case(std::string_view text) {
  std::string lower(text);
  for (char& c : lower) {
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  }
  return lower;
}

namespace {

// Length of the number at the start of `text`, 0 if there is none; from_chars alone takes no '+', but takes
// "inf".
std::size_t number_at_start(std::string_view text, double& value) {
  const bool plus = !text.empty() && text.front() == '+';
  std::string_view digits = text.substr(plus ? 1 : 0);
  const std::string_view unsigned_part = !plus && digits.starts_with('-') ? digits.substr(1) : digits;
  if (unsigned_part.empty() || !(is_digit(unsigned_part.front()) || unsigned_part.front() == '.')) return 0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  if (error != std::errc() || !std::isfinite(value)) return 0;
  return static_cast<std::size_t>(end - text.data());
}

}  // namespace

std::optional<double> parsed_number(std::string_view text) {
  double value = 0;
  if (text.empty() || number_at_start(text, value) != text.size()) return std::nullopt;
  return value;
}

std::optional<int> parsed_integer(std::string_view text) {
  if (text.starts_with('+')) {
    text.remove_prefix(1);
    if (text.starts_with('-')) return std::nullopt;
  }
  int value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (text.empty() || error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return value;
}

namespace {
// Whether one letter that is wrong, left out, put in or swapped with the next makes the one of the other.
bool differ_by_a_slip(std::string_view a, std::string_view b) {
  if (a.size() > b.size()) std::swap(a, b);
  if (b.size() - a.size() > 1) return false;
  std::size_t same = 0;
  while (same < a.size() && a[same] == b[same]) ++same;
  if (a.size() < b.size()) return a.substr(same) == b.substr(same + 1);
  if (same == a.size()) return false;
  const bool swapped = same + 1 < a.size() && a[same] == b[same + 1] && a[same + 1] == b[same] &&
                       a.substr(same + 2) == b.substr(same + 2);
  return swapped || a.substr(same + 1) == b.substr(same + 1);
}
}  // namespace

std::string_view word_meant(std::string_view word, std::span<const std::string_view> known) {
  if (word.size() > 40) return {};
  const std::string small = lower_case(word);
  for (const std::string_view each : known)
    if (small == lower_case(each)) return each;
  for (const std::string_view each : known)
    if (each.size() > 2 && differ_by_a_slip(small, lower_case(each))) return each;
  return {};
}

std::string written_number(double value) {
  std::array<char, 32> digits{};
  return {digits.data(), std::to_chars(digits.data(), digits.data() + digits.size(), value).ptr};
}

std::string printable(std::string_view text) {
  constexpr std::string_view hex = "0123456789abcdef";
  std::string result;
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    if (byte >= 32 && byte < 127) {
      result += c;
    } else {
      result += "\\x";
      result += hex[byte >> 4];
      result += hex[byte & 15];
    }
  }
  return result;
}

std::string quoted(std::string_view text) {
  constexpr std::size_t most = 40;
  return "'" + printable(text.substr(0, most)) + (text.size() > most ? "...'" : "'");
}

namespace {

struct Unit {
  Dimension dimension;
  std::string_view name;    // without blanks, '*' and '^'
  double factor = 1;        // times the number
  bool reciprocal = false;  // a count: length per mass, factor over the number
};

constexpr std::array units{
    Unit{Dimension::length, "mm", 1},
    Unit{Dimension::length, "cm", 10},
    Unit{Dimension::length, "m", 1000},
    Unit{Dimension::length, "um", 1e-3},
    Unit{Dimension::length, "\xc2\xb5m", 1e-3},
    Unit{Dimension::length, "in", 25.4},
    Unit{Dimension::linear_density, "tex", 1},
    Unit{Dimension::linear_density, "dtex", 0.1},
    Unit{Dimension::linear_density, "g/km", 1},
    Unit{Dimension::linear_density, "den", 1.0 / 9},
    Unit{Dimension::linear_density, "Nm", 1000, true},
    Unit{Dimension::linear_density, "Ne", 590.5412, true},  // 840 yd per lb
    Unit{Dimension::force, "cN", 1},
    Unit{Dimension::force, "N", 100},
    Unit{Dimension::force, "mN", 0.1},
    Unit{Dimension::force, "gf", 0.980665},
    Unit{Dimension::bend_stiffness, "mNmm2", 1},
    Unit{Dimension::bend_stiffness, "Nm2", 1e9},
    Unit{Dimension::bend_stiffness, "Nmm2", 1e3},
    Unit{Dimension::bend_stiffness, "uNm2", 1e3},
    Unit{Dimension::bend_stiffness, "gfcm2", 980.665},
    Unit{Dimension::shell_stiffness, "N/mm3", 1},
    Unit{Dimension::shell_stiffness, "N/m3", 1e-9},
    Unit{Dimension::twist, "tpm", 1},
    Unit{Dimension::twist, "turns/m", 1},
    Unit{Dimension::twist, "tpi", 1 / 0.0254},
    Unit{Dimension::share, "", 1},
    Unit{Dimension::share, "%", 0.01},
    Unit{Dimension::gauge, "", 1},
    Unit{Dimension::gauge, "npi", 1},
};

std::string_view examples(Dimension dimension) {
  switch (dimension) {
    case Dimension::length:
      return "mm, cm, m or in, e.g. '6.2 mm'";
    case Dimension::linear_density:
      return "tex, dtex, den, Nm or Ne, e.g. '71 tex'";
    case Dimension::force:
      return "cN, N, mN or gf, e.g. '5500 cN'";
    case Dimension::bend_stiffness:
      return "mN mm^2, N m^2 or gf cm^2, e.g. '10 mN mm^2'";
    case Dimension::shell_stiffness:
      return "N/mm^3 or N/m^3, e.g. '6e-4 N/mm^3'";
    case Dimension::twist:
      return "tpm (turns per metre) or tpi, e.g. '150 tpm', negative for S twist";
    case Dimension::share:
      return "a share without unit or %, e.g. '0.05' or '5 %'";
    case Dimension::gauge:
      return "npi, e.g. '7 npi'";
  }
  return "";
}

}  // namespace

Quantity parsed_quantity(std::string_view text, Dimension dimension) {
  text = trimmed(text);
  Quantity result;
  // E7 is the trade's way to write a gauge of 7 needles per inch
  if (dimension == Dimension::gauge && text.starts_with('E')) text.remove_prefix(1);
  std::size_t length = number_at_start(text, result.value);
  if (length == 0) {
    result.problem = "expected a number with a unit, not " + quoted(text) + "; units are " +
                     std::string(examples(dimension));
    return result;
  }
  // folded yarns: 2/28 Nm is two plies of 28 Nm
  double plies = 1;
  if (dimension == Dimension::linear_density && length < text.size() && text[length] == '/') {
    double single = 0;
    const std::size_t more = number_at_start(text.substr(length + 1), single);
    if (more > 0) {
      plies = result.value;
      result.value = single;
      length += 1 + more;
    }
  }
  std::string name;
  for (const char c : text.substr(length)) {
    if (!is_blank(c) && c != '*' && c != '^') name += c;
    if (name.size() > 16) break;
  }
  for (const Unit& unit : units) {
    if (unit.dimension != dimension || unit.name != name) continue;
    result.value = unit.reciprocal ? plies * unit.factor / result.value : plies * unit.factor * result.value;
    if (!std::isfinite(result.value)) result.problem = "the value " + quoted(text) + " is out of range";
    return result;
  }
  result.problem =
      name.empty() ? "the unit is missing after " + quoted(text) : "unknown unit " + quoted(name);
  result.problem += "; write " + std::string(examples(dimension));
  return result;
}

}  // namespace loopwright
