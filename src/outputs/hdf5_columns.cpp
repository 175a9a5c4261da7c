#include "outputs/hdf5_columns.hpp"

#include <algorithm>
#include <array>
#include <mutex>

namespace loopwright::hdf5 {
namespace {

constexpr hsize_t most_values = hsize_t{1} << 28;  // of one column; more is not a fabric but a damaged file

std::recursive_mutex& library() {
  static std::recursive_mutex mutex;
  return mutex;
}

// Access to a file in memory; `bytes` is its content when it is opened.
hid_t memory_access(std::span<char> bytes) {
  const hid_t access = H5Pcreate(H5P_FILE_ACCESS);
  H5Pset_fapl_core(access, std::size_t{1} << 20, 0);
  if (!bytes.empty()) H5Pset_file_image(access, bytes.data(), bytes.size());
  return access;
}

hid_t created() {
  const Handle access(memory_access({}), H5Pclose, "HDF5 refuses a file in memory");
  // no times, so that equal states are equal files
  const Handle creation(H5Pcreate(H5P_FILE_CREATE), H5Pclose, "HDF5 refuses a file in memory");
  H5Pset_obj_track_times(creation, false);
  return H5Fcreate("loopwright-state", H5F_ACC_TRUNC, creation, access);
}

hid_t opened(std::span<char> bytes) {
  const Handle access(memory_access(bytes), H5Pclose, "HDF5 refuses a file in memory");
  return H5Fopen("loopwright-state", H5F_ACC_RDONLY, access);
}

hid_t text_type() {
  const hid_t type = H5Tcopy(H5T_C_S1);
  H5Tset_size(type, H5T_VARIABLE);
  H5Tset_cset(type, H5T_CSET_UTF8);
  return type;
}

// A column opened for reading, with its number of rows.
struct Column {
  Handle dataset;
  hsize_t rows = 0;

  Column(hid_t file, const std::string& name, int width)
      : dataset(H5Dopen2(file, name.c_str(), H5P_DEFAULT), H5Dclose, "'" + name + "' is missing") {
    const Handle space(H5Dget_space(dataset), H5Sclose, "'" + name + "' has no shape");
    std::array<hsize_t, 2> shape{0, 1};
    const int rank = H5Sget_simple_extent_ndims(space);
    if (rank != (width == 1 ? 1 : 2) || H5Sget_simple_extent_dims(space, shape.data(), nullptr) != rank ||
        shape[1] != static_cast<hsize_t>(width) || shape[0] > most_values)
      throw ContentError("'" + name + "' has the wrong shape");
    rows = shape[0];
  }

  void require_type(const std::string& name, hid_t wanted) const {
    const Handle type(H5Dget_type(dataset), H5Tclose, "'" + name + "' has no type");
    if (H5Tequal(type, wanted) <= 0) throw ContentError("'" + name + "' has the wrong type of number");
  }
};

template <class T>
std::vector<T> read(hid_t file, const std::string& name, int width, hid_t stored, hid_t native) {
  const Column column(file, name, width);
  column.require_type(name, stored);
  std::vector<T> values(column.rows * static_cast<hsize_t>(width));
  if (!values.empty() && H5Dread(column.dataset, native, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()) < 0)
    throw ContentError("'" + name + "' cannot be read");
  return values;
}

}  // namespace

Handle::Handle(hid_t id, Close close, const std::string& what) : id_(id), close_(close) {
  if (id < 0) throw ContentError(what);
}

Handle::~Handle() { close_(id_); }

Quiet::Quiet() {
  library().lock();
  H5Eget_auto2(H5E_DEFAULT, &function_, &data_);
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
}

Quiet::~Quiet() {
  H5Eset_auto2(H5E_DEFAULT, function_, data_);
  library().unlock();
}

Writer::Writer() : file_(created(), H5Fclose, "HDF5 refuses a file in memory") {}

void Writer::write(const std::string& name, hid_t type, const void* data, std::size_t count, int width,
                   const char* unit) {
  const std::string group = name.substr(0, name.find('/'));
  const std::string failed = "HDF5 cannot store '" + name + "'";
  const auto untimed = [&](hid_t kind) {
    const hid_t creation = H5Pcreate(kind);
    H5Pset_obj_track_times(creation, false);
    return creation;
  };
  if (groups_.emplace(group, true).second) {
    const Handle creation(untimed(H5P_GROUP_CREATE), H5Pclose, failed);
    const Handle made(H5Gcreate2(file_, group.c_str(), H5P_DEFAULT, creation, H5P_DEFAULT), H5Gclose, failed);
  }
  const std::array<hsize_t, 2> shape{count / static_cast<std::size_t>(width), static_cast<hsize_t>(width)};
  const int rank = width == 1 ? 1 : 2;
  const Handle space(H5Screate_simple(rank, shape.data(), nullptr), H5Sclose, failed);
  const Handle creation(untimed(H5P_DATASET_CREATE), H5Pclose, failed);
  if (count > 64 && H5Tis_variable_str(type) <= 0) {
    const std::array<hsize_t, 2> chunk{std::min<hsize_t>(shape[0], 16384), shape[1]};
    H5Pset_chunk(creation, rank, chunk.data());
    H5Pset_shuffle(creation);
    H5Pset_deflate(creation, 4);
  }
  const Handle dataset(H5Dcreate2(file_, name.c_str(), type, space, H5P_DEFAULT, creation, H5P_DEFAULT),
                       H5Dclose, failed);
  if (count > 0 && H5Dwrite(dataset, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, data) < 0)
    throw ContentError(failed);
  if (unit != nullptr) {
    const Handle type_of_unit(text_type(), H5Tclose, failed), scalar(H5Screate(H5S_SCALAR), H5Sclose, failed);
    const Handle attribute(H5Acreate2(dataset, "unit", type_of_unit, scalar, H5P_DEFAULT, H5P_DEFAULT),
                           H5Aclose, failed);
    if (H5Awrite(attribute, type_of_unit, &unit) < 0) throw ContentError(failed);
  }
}

void Writer::column(const std::string& name, std::span<const double> values, int width, const char* unit) {
  write(name, H5T_IEEE_F64LE, values.data(), values.size(), width, unit);
}

void Writer::column(const std::string& name, std::span<const std::int32_t> values, int width) {
  write(name, H5T_STD_I32LE, values.data(), values.size(), width, nullptr);
}

void Writer::column(const std::string& name, std::span<const std::uint8_t> values) {
  write(name, H5T_STD_U8LE, values.data(), values.size(), 1, nullptr);
}

void Writer::texts(const std::string& name, const std::vector<std::string>& values) {
  std::vector<const char*> pointers;
  for (const std::string& text : values) {
    if (text.find('\0') != std::string::npos)
      throw ContentError("a text in '" + name + "' contains a zero byte");
    pointers.push_back(text.c_str());
  }
  const Handle type(text_type(), H5Tclose, "HDF5 has no text type");
  write(name, type, pointers.data(), pointers.size(), 1, nullptr);
}

std::vector<char> Writer::bytes() {
  if (H5Fflush(file_, H5F_SCOPE_GLOBAL) < 0) throw ContentError("HDF5 cannot finish the file");
  const ssize_t size = H5Fget_file_image(file_, nullptr, 0);
  if (size <= 0) throw ContentError("HDF5 cannot finish the file");
  std::vector<char> image(static_cast<std::size_t>(size));
  if (H5Fget_file_image(file_, image.data(), image.size()) != size)
    throw ContentError("HDF5 cannot finish the file");
  return image;
}

Reader::Reader(std::span<char> bytes) : file_(opened(bytes), H5Fclose, "it is not an HDF5 file") {}

bool Reader::has(const std::string& name) const {
  const std::size_t slash = name.find('/');
  return (slash == std::string::npos || H5Lexists(file_, name.substr(0, slash).c_str(), H5P_DEFAULT) > 0) &&
         H5Lexists(file_, name.c_str(), H5P_DEFAULT) > 0;
}

std::vector<double> Reader::doubles(const std::string& name, int width) const {
  return read<double>(file_, name, width, H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE);
}

std::vector<std::int32_t> Reader::integers(const std::string& name, int width) const {
  return read<std::int32_t>(file_, name, width, H5T_STD_I32LE, H5T_NATIVE_INT32);
}

std::vector<std::uint8_t> Reader::octets(const std::string& name) const {
  return read<std::uint8_t>(file_, name, 1, H5T_STD_U8LE, H5T_NATIVE_UINT8);
}

std::vector<std::string> Reader::texts(const std::string& name) const {
  const Column column(file_, name, 1);
  const Handle type(text_type(), H5Tclose, "HDF5 has no text type");
  column.require_type(name, type);
  std::vector<char*> pointers(column.rows, nullptr);
  if (pointers.empty()) return {};
  if (H5Dread(column.dataset, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, pointers.data()) < 0)
    throw ContentError("'" + name + "' cannot be read");
  std::vector<std::string> texts;
  for (const char* text : pointers) texts.emplace_back(text != nullptr ? text : "");
  const Handle space(H5Dget_space(column.dataset), H5Sclose, "'" + name + "' has no shape");
  H5Dvlen_reclaim(type, space, H5P_DEFAULT, pointers.data());
  return texts;
}

}  // namespace loopwright::hdf5
