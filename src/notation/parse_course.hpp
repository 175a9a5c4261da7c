// One course line of a fabric file, and the `*n` that repeats what stands before it.
#pragma once
#include <span>
#include <string_view>

#include "base/diagnostics.hpp"
#include "notation/vermiculation.hpp"

namespace loopwright {

inline constexpr std::size_t most_wales = 10'000;  // of one written pass

/// Reads a line without its comment. What is wrong is said with the line's number and the column in `text`.
CourseLine parse_course(std::string_view text, int line, std::span<const VermiculationYarn> yarns,
                        Diagnostics& diagnostics);

/// Reads `*n`, n from 1, at `at` and moves `at` past it. Answers 0 after saying what is wrong.
std::size_t read_times(std::string_view text, std::size_t& at, int line, Diagnostics& diagnostics);

}  // namespace loopwright
