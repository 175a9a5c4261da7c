// Named columns of numbers and texts in an HDF5 file that lies in memory. A thin layer over HDF5's C library:
// handles are closed, errors are exceptions, nothing is printed.
#pragma once
#include <hdf5.h>

#include <cstdint>
#include <map>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

namespace loopwright::hdf5 {

// What is wrong with the content; the caller adds the file's name.
class ContentError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

using Close = herr_t (*)(hid_t);

// An HDF5 identifier that closes itself. Throws ContentError(`what`) where HDF5 gave none.
class Handle {
 public:
  Handle(hid_t id, Close close, const std::string& what);
  ~Handle();
  Handle(const Handle&) = delete;
  Handle& operator=(const Handle&) = delete;
  operator hid_t() const { return id_; }

 private:
  hid_t id_;
  Close close_;
};

// HDF5 prints its error stack unless it is told not to; while one of these lives it does not. It also keeps
// other threads out: Debian's serial library is not built for several at once.
class Quiet {
 public:
  Quiet();
  ~Quiet();
  Quiet(const Quiet&) = delete;
  Quiet& operator=(const Quiet&) = delete;

 private:
  H5E_auto2_t function_ = nullptr;
  void* data_ = nullptr;
};

// Columns are addressed as "group/name". `width` numbers make a row, e.g. 3 for points. `unit` is kept as an
// attribute.
class Writer {
 public:
  Writer();
  void column(const std::string& name, std::span<const double> values, int width = 1,
              const char* unit = nullptr);
  void column(const std::string& name, std::span<const std::int32_t> values, int width = 1);
  void column(const std::string& name, std::span<const std::uint8_t> values);
  void texts(const std::string& name, const std::vector<std::string>& values);  // UTF-8, no zero bytes
  std::vector<char> bytes();                                                    // the finished file

 private:
  void write(const std::string& name, hid_t type, const void* data, std::size_t count, int width,
             const char* unit);
  Quiet quiet_;
  std::map<std::string, bool> groups_;
  Handle file_;
};

// Every call checks that the column is there and has the type and width that are asked for.
class Reader {
 public:
  explicit Reader(std::span<char> bytes);   // the file's bytes, which must outlive the reader
  bool has(const std::string& name) const;  // whether there is such a column
  std::vector<double> doubles(const std::string& name, int width = 1) const;
  std::vector<std::int32_t> integers(const std::string& name, int width = 1) const;
  std::vector<std::uint8_t> octets(const std::string& name) const;
  std::vector<std::string> texts(const std::string& name) const;

 private:
  Quiet quiet_;
  Handle file_;
};

}  // namespace loopwright::hdf5
