#include "notation/read_program.hpp"

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <memory>
#include <string>
#include <system_error>

#include "notation/read_knitout.hpp"
#include "notation/read_vermiculation.hpp"
#include "notation/scan.hpp"

namespace loopwright {
namespace {

// The file's bytes, or false after saying what is wrong.
bool read_bytes(const std::filesystem::path& file, std::string& bytes, Diagnostics& diagnostics) {
  const auto refuse = [&](const std::string& message) {
    diagnostics.error({}, message);
    return false;
  };
  std::error_code failure;
  const auto status = std::filesystem::status(file, failure);
  if (status.type() == std::filesystem::file_type::not_found) return refuse("there is no such file");
  if (failure) return refuse("the file cannot be looked at: " + failure.message());
  if (std::filesystem::is_directory(status))
    return refuse("this is a folder; name a .verm, .k or .knitout file");
  const std::uintmax_t size = std::filesystem::file_size(file, failure);
  if (!failure && size > largest_file_bytes)
    return refuse("the file is larger than 512 MiB; split the programme");
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> stream(std::fopen(file.c_str(), "rb"), &std::fclose);
  if (!stream) return refuse(std::string("the file cannot be opened: ") + std::strerror(errno));
  // read to the end rather than trust the size: a pipe has none, and a file may grow
  constexpr std::size_t block = std::size_t{1} << 20;
  while (true) {
    const std::size_t before = bytes.size();
    bytes.resize(before + block);
    const std::size_t got = std::fread(bytes.data() + before, 1, block, stream.get());
    bytes.resize(before + got);
    if (bytes.size() > largest_file_bytes)
      return refuse("the file is larger than 512 MiB; split the programme");
    if (got < block) break;
  }
  if (std::ferror(stream.get()) != 0) return refuse("the file cannot be read to its end");
  return true;
}

bool names_fabric(std::string_view text) {
  return text.substr(text.starts_with("\xef\xbb\xbf") ? 3 : 0).starts_with(";!vermiculation");
}
bool names_knitout(std::string_view text) {
  return text.substr(text.starts_with("\xef\xbb\xbf") ? 3 : 0).starts_with(";!knitout");
}

}  // namespace

std::optional<std::string> read_text(const std::filesystem::path& file, Diagnostics& diagnostics) {
  std::string bytes;
  if (!read_bytes(file, bytes, diagnostics)) return std::nullopt;
  return bytes;
}

bool is_fabric_text(std::string_view text, std::string_view suffix) {
  return names_fabric(text) || (!names_knitout(text) && lower_case(suffix) == ".verm");
}

Program read_program_text(std::string_view text, std::string_view suffix, Diagnostics& diagnostics,
                          const FabricOptions& options) {
  if (is_fabric_text(text, suffix)) return read_vermiculation(text, diagnostics, options);
  const bool knitout_suffix = lower_case(suffix) == ".k" || lower_case(suffix) == ".knitout";
  if (!names_knitout(text) && !knitout_suffix) {
    diagnostics.error(
        {1, 1},
        "neither a fabric file nor a knitout file: the first line is neither ';!vermiculation-1' nor "
        "';!knitout-2', and the suffix is not .verm, .k or .knitout");
    Program program;
    program.file = diagnostics.file();
    return program;
  }
  return read_knitout(text, diagnostics);
}

Program read_program(const std::filesystem::path& file, Diagnostics& diagnostics,
                     const FabricOptions& options) {
  Program program;
  if (const auto text = read_text(file, diagnostics))
    program = read_program_text(*text, file.extension().string(), diagnostics, options);
  program.file = file.string();
  return program;
}

}  // namespace loopwright
