// Changes of a fabric file's header lines in its text; everything else of the text stays as it was.
#pragma once
#include <string>
#include <string_view>

namespace loopwright {

// The text with `;;name: value`: in place of the header's line, its comment kept, or after the last header
// line. An empty value takes the line out.
std::string with_header(std::string_view text, std::string_view name, std::string_view value);

// What the text says for a header; empty if it has none.
std::string header_value(std::string_view text, std::string_view name);

}  // namespace loopwright
