// What the files of the Python module share. Every function here is called with the GIL held unless it says
// otherwise.
#pragma once
#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <chrono>
#include <functional>
#include <future>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "cloth.hpp"

namespace loopwright::python {

namespace py = pybind11;

// The module's parts, one file each.
void bind_errors(py::module_& module);
void bind_program(py::module_& module);
void bind_cloth(py::module_& module);
void bind_experiments(py::module_& module);

// A wrong programme: becomes loopwright.Error with the lines that the command prints and the diagnostics.
class ProgramError : public std::runtime_error {
 public:
  explicit ProgramError(Diagnostics diagnostics);
  const Diagnostics& diagnostics() const { return diagnostics_; }

 private:
  Diagnostics diagnostics_;
};

// A diagnostic as Python sees it: with its file.
struct FileDiagnostic {
  std::string file;
  Diagnostic said;
};
std::vector<FileDiagnostic> diagnostics_of(const Diagnostics& diagnostics);

// Text of a file, which need not be UTF-8: what is not becomes U+FFFD, as the command writes it.
py::str text(const std::string& bytes);

// Python's warnings: loopwright.BrokenWarning, loopwright.NotAtRestWarning.
void warn(const char* category, const std::string& text);

// Whether this process is a copy that fork() made of another. GNU's OpenMP, which CHOLMOD uses, then waits
// for threads that the thread which forked had before and which are no more: a thread of one's own has none
// of them.
bool is_forked();
// To be called before a picture is drawn. Throws in a copy of a process that has drawn one: OpenGL drivers
// hang there.
void begin_drawing();
// Keeps a signal that came while another thread works, for its Watch; and raises one that no Watch took.
void note_signals();
void raise_noted_signal();

// Of cloth that should be at rest: where it is broken or is not.
void warn_of(const Cloth& relaxed);

// Long work: Python goes on with other threads meanwhile.
template <class Work>
auto without_gil(const Work& work) -> decltype(work()) {
  const py::gil_scoped_release released;
  if (!is_forked()) return work();
  std::packaged_task<decltype(work())()> task(std::cref(work));
  auto result = task.get_future();
  std::thread worker(std::move(task));
  while (result.wait_for(std::chrono::milliseconds(100)) != std::future_status::ready) note_signals();
  worker.join();
  raise_noted_signal();
  return result.get();
}

// HDF5 and OpenGL drivers serve one thread at a time. To be locked without the GIL.
std::mutex& one_at_a_time();

// Follows long work: asks Python for Ctrl-C and calls `callback` with a Progress, unless it is None.
class Watch {
 public:
  explicit Watch(py::object callback) : callback_(std::move(callback)) {}
  // Called without the GIL, by the thread that works. False: stop, since the callback returned False or
  // something was raised.
  bool goes_on(const std::string& phase, double share, int step, double residual);
  // To be called when the work has returned: raises what was raised meanwhile.
  void raise() const;

 private:
  py::object callback_;
  std::exception_ptr raised_;
  bool stopped_ = false;
};

// A read-only NumPy array over memory that `owner` keeps alive: nothing is copied. Strides in bytes.
template <class T>
py::array view(const T* data, std::vector<py::ssize_t> shape, std::vector<py::ssize_t> strides,
               std::shared_ptr<const void> owner) {
  auto* kept = new std::shared_ptr<const void>(std::move(owner));
  const py::capsule base(kept, [](void* p) { delete static_cast<std::shared_ptr<const void>*>(p); });
  py::array array(py::dtype::of<T>(), std::move(shape), std::move(strides), data, base);
  py::detail::array_proxy(array.ptr())->flags &= ~py::detail::npy_api::NPY_ARRAY_WRITEABLE_;
  return array;
}

// One member of every element of a list of structs. T: the type that NumPy sees, of the member's size.
template <class T, class Element, class Member>
py::array column(const std::vector<Element>& list, Member Element::*member,
                 std::shared_ptr<const void> owner) {
  static_assert(sizeof(T) == sizeof(Member));
  static const Element nothing{};
  const Element& first = list.empty() ? nothing : list.front();
  return view(reinterpret_cast<const T*>(&(first.*member)), {static_cast<py::ssize_t>(list.size())},
              {static_cast<py::ssize_t>(sizeof(Element))}, std::move(owner));
}

// A whole list of numbers, and of points as (n, 3).
template <class T>
py::array column(const std::vector<T>& list, std::shared_ptr<const void> owner) {
  return view(list.data(), {static_cast<py::ssize_t>(list.size())}, {static_cast<py::ssize_t>(sizeof(T))},
              std::move(owner));
}
py::array points(const std::vector<Vec3>& list, std::shared_ptr<const void> owner);

// JSON as dict, list, str, int, float, bool and None. What JSON has no word for, NaN, is None as it is there.
py::object python_of(const JsonValue& value);
py::dict python_of(const JsonObject& object);

// (16, 16), (None, 16) or "16x16", as --window takes it; None: no window.
std::optional<WindowSize> window_of(const py::object& window);

}  // namespace loopwright::python
