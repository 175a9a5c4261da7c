// Reads a file in either notation.
#pragma once
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

#include "base/diagnostics.hpp"
#include "notation/program.hpp"
#include "notation/vermiculation.hpp"

namespace loopwright {

/// Files above this size are refused.
inline constexpr std::uintmax_t largest_file_bytes = std::uintmax_t{512} << 20;

/// The file's bytes; nothing if they cannot be read, which is said in `diagnostics`.
std::optional<std::string> read_text(const std::filesystem::path& file, Diagnostics& diagnostics);

/// Whether read_program_text takes the text for a fabric file.
bool is_fabric_text(std::string_view text, std::string_view suffix);

/// Reads a fabric file or a knitout file: the magic line decides, then the suffix (.verm; .k, .knitout). What
/// is wrong, an unreadable file included, is said in `diagnostics`. `options` apply to fabric files only.
Program read_program(const std::filesystem::path& file, Diagnostics& diagnostics,
                     const FabricOptions& options = {});

/// The same for a text that is already in memory; `suffix` (".verm") decides where the magic line does not.
Program read_program_text(std::string_view text, std::string_view suffix, Diagnostics& diagnostics,
                          const FabricOptions& options = {});

}  // namespace loopwright
