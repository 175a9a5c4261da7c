#include "outputs/atomic_file.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cerrno>
#include <charconv>
#include <cstring>
#include <system_error>

namespace loopwright {
namespace {

[[noreturn]] void fail(const std::filesystem::path& path, const std::string& why) {
  throw FileError("cannot write " + path.string() + ": " + why);
}

std::string last_error() { return std::strerror(errno); }

// Creates a file that nobody else has, with the permissions that a plain new file would get.
std::filesystem::path create_beside(const std::filesystem::path& target, const std::filesystem::path& shown) {
  static std::atomic<unsigned> counter{0};
  for (int attempt = 0; attempt < 100; ++attempt) {
    std::filesystem::path name = target;
    name += ".tmp-" + std::to_string(::getpid()) + "-" + std::to_string(counter++);
    const int file = ::open(name.c_str(), O_CREAT | O_EXCL | O_WRONLY | O_CLOEXEC, 0666);
    if (file >= 0) {
      ::close(file);
      return name;
    }
    if (errno != EEXIST) {
      if (errno == ENOENT) fail(shown, "the folder " + target.parent_path().string() + " does not exist");
      fail(shown, last_error());
    }
  }
  fail(shown, "no free name for a temporary file");
}

// Asks the system to put the file's bytes (or a folder's entries) on the disk, so that a power cut after the
// rename does not leave an empty file. Some file systems refuse it; the rename is safe against a kill even
// then.
bool flush_to_disk(const std::filesystem::path& path, int flags) {
  const int file = ::open(path.c_str(), flags | O_CLOEXEC);
  if (file < 0) return false;
  const bool done = ::fsync(file) == 0 || errno == EINVAL || errno == EROFS;
  ::close(file);
  return done;
}

}  // namespace

AtomicFile::AtomicFile(const std::filesystem::path& target) : target_(target) {
  if (target.empty()) throw FileError("cannot write: no file name was given");
  std::error_code error;
  if (std::filesystem::is_symlink(target_, error)) {
    const auto resolved = std::filesystem::weakly_canonical(target_, error);
    if (!error) target_ = resolved;
  }
  const auto status = std::filesystem::status(target_, error);
  if (std::filesystem::is_directory(status)) fail(target, "it is a folder; give a file name");
  rename_ = !std::filesystem::exists(status) || std::filesystem::is_regular_file(status);
  if (rename_) {
    if (std::filesystem::exists(status) && ::access(target_.c_str(), W_OK) != 0) fail(target, last_error());
    temporary_ = create_beside(std::filesystem::absolute(target_), target);
  } else {
    temporary_ = create_beside(std::filesystem::temp_directory_path() / "loopwright", target);
  }
}

AtomicFile::~AtomicFile() {
  if (committed_ && rename_) return;
  stream_.close();
  std::error_code ignored;
  std::filesystem::remove(temporary_, ignored);
}

std::ofstream& AtomicFile::stream() {
  if (!stream_.is_open()) {
    stream_.open(temporary_, std::ios::binary | std::ios::trunc);
    if (!stream_) fail(target_, last_error());
  }
  return stream_;
}

void AtomicFile::commit() {
  if (stream_.is_open()) {
    errno = 0;
    stream_.close();
    if (!stream_) fail(target_, errno != 0 ? last_error() : "the disk may be full");
  }
  if (!rename_) {
    std::ifstream from(temporary_, std::ios::binary);
    std::ofstream to(target_, std::ios::binary);
    if (from.peek() != std::ifstream::traits_type::eof()) to << from.rdbuf();
    to.flush();
    if (!to) fail(target_, "the bytes were not taken");
    committed_ = true;
    return;
  }
  if (!flush_to_disk(temporary_, O_WRONLY)) fail(target_, last_error());
  std::error_code error;
  std::filesystem::rename(temporary_, target_, error);
  if (error) fail(target_, error.message());
  committed_ = true;
  flush_to_disk(target_.has_parent_path() ? target_.parent_path() : ".", O_RDONLY | O_DIRECTORY);
}

std::string number_text(double value) {
  std::array<char, 32> text{};
  const auto end = std::to_chars(text.data(), text.data() + text.size(), value).ptr;
  return {text.data(), end};
}

}  // namespace loopwright
