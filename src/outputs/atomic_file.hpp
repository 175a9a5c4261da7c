// A file that appears under its name only when it is complete. Every writer of this stage goes through it.
#pragma once
#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <string>

namespace loopwright {

// A file that cannot be read or written, or whose content is not what it should be. The message names the
// file and says what to do.
class FileError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

// Writes go to a new file in the same folder; commit() flushes it to the disk and renames it. Without
// commit() (an exception, an early return) the new file is removed and an older file of that name stays as it
// was. A symbolic link is followed. A device or pipe (/dev/stdout) cannot be renamed over: it gets the bytes
// at commit().
class AtomicFile {
 public:
  explicit AtomicFile(
      const std::filesystem::path& target);  // throws FileError if the place cannot be written
  ~AtomicFile();
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;

  std::ofstream& stream();                                               // binary; opened on first use
  const std::filesystem::path& temporary() const { return temporary_; }  // for libraries that write by name
  void commit();  // throws FileError, e.g. when the disk is full

 private:
  std::filesystem::path target_, temporary_;
  std::ofstream stream_;
  bool rename_ = true;
  bool committed_ = false;
};

// Text of a number: the shortest that reads back to the same double; nan, inf and -inf as such.
std::string number_text(double value);

}  // namespace loopwright
