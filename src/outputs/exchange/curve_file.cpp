#include "outputs/exchange/curve_file.hpp"

#include <cerrno>
#include <cstring>
#include <fstream>
#include <sstream>

#include "outputs/atomic_file.hpp"

namespace loopwright {
namespace {

std::string suffix_of(const std::filesystem::path& path) {
  std::string suffix = path.extension().string();
  for (char& c : suffix)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  return suffix;
}

std::string content_of(const std::filesystem::path& path) {
  std::error_code error;
  if (std::filesystem::is_directory(path, error))
    throw FileError("cannot read " + path.string() + ": it is a folder");
  std::ifstream in(path, std::ios::binary);
  if (!in) throw FileError("cannot read " + path.string() + ": " + std::strerror(errno));
  std::ostringstream content;
  if (in.peek() != std::ifstream::traits_type::eof()) content << in.rdbuf();
  return std::move(content).str();
}

}  // namespace

bool names_curves(const std::filesystem::path& path) {
  const std::string suffix = suffix_of(path);
  return suffix == ".bcc" || suffix == ".yarns" || suffix == ".obj";
}

CurveFile read_curve_file(const std::filesystem::path& path) {
  const std::string content = content_of(path), suffix = suffix_of(path), name = path.string();
  if (suffix == ".bcc") return read_bcc(content, name);
  if (suffix == ".yarns") return read_yarns(content, name);
  return read_obj_curves(content, name);
}

}  // namespace loopwright
