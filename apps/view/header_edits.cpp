#include "header_edits.hpp"

#include <algorithm>
#include <optional>

#include "notation/scan.hpp"

namespace loopwright {
namespace {

struct HeaderLine {
  std::size_t begin = 0, end = 0;              // of the line, without its end
  std::size_t value_begin = 0, value_end = 0;  // without blanks
};

// `;;Name: value ; comment`. A colour's '#' and the like never contain ';'.
std::optional<HeaderLine> parsed(std::string_view text, std::size_t begin, std::size_t end,
                                 std::string_view name) {
  const std::string_view line = text.substr(begin, end - begin);
  const std::size_t colon = line.find(':');
  if (!line.starts_with(";;") || colon == std::string_view::npos) return std::nullopt;
  if (!name.empty() && lower_case(trimmed(line.substr(2, colon - 2))) != lower_case(name))
    return std::nullopt;
  std::size_t value = colon + 1, stop = std::min(line.find(';', colon), line.size());
  while (value < stop && is_blank(line[value])) ++value;
  while (stop > value && (is_blank(line[stop - 1]) || line[stop - 1] == '\r')) --stop;
  return HeaderLine{begin, end, begin + value, begin + stop};
}

template <class Visit>
void each_line(std::string_view text, const Visit& visit) {
  for (std::size_t begin = 0; begin < text.size();) {
    const std::size_t end = std::min(text.find('\n', begin), text.size());
    visit(begin, end);
    begin = end + 1;
  }
}

}  // namespace

std::string header_value(std::string_view text, std::string_view name) {
  std::string value;
  each_line(text, [&](std::size_t begin, std::size_t end) {
    if (const auto line = parsed(text, begin, end, name))
      value = std::string(text.substr(line->value_begin, line->value_end - line->value_begin));
  });
  return value;
}

std::string with_header(std::string_view text, std::string_view name, std::string_view value) {
  std::optional<HeaderLine> found;
  std::size_t after_headers = 0;
  each_line(text, [&](std::size_t begin, std::size_t end) {
    if (const auto line = parsed(text, begin, end, name)) found = line;
    if (text.substr(begin, end - begin).starts_with(";!") || parsed(text, begin, end, {}))
      after_headers = std::min(end + 1, text.size());
  });
  std::string out(text);
  if (found && value.empty())
    return out.erase(found->begin, std::min(found->end + 1, text.size()) - found->begin);
  if (found) return out.replace(found->value_begin, found->value_end - found->value_begin, value);
  if (value.empty()) return out;
  const bool returns = text.find("\r\n") != std::string_view::npos;
  std::string line = ";;" + std::string(name) + ": " + std::string(value) + (returns ? "\r\n" : "\n");
  if (after_headers > 0 && text[after_headers - 1] != '\n') line = "\n" + line;
  return out.insert(after_headers, line);
}

}  // namespace loopwright
