// Errors, warnings and diagnostics, and what else the files of the module share.
#include <pthread.h>

#include <atomic>
#include <sstream>

#include "bindings.hpp"
#include "outputs/atomic_file.hpp"
#include "outputs/headless_gl.hpp"

namespace loopwright::python {
namespace {

std::string lines_of(const Diagnostics& diagnostics) {
  std::ostringstream text;
  text << diagnostics;
  std::string lines = text.str();
  while (lines.ends_with('\n')) lines.pop_back();
  return lines;
}

// What the message says to do: behind its first semicolon that is not inside quotes.
std::string remedy_of(const std::string& message) {
  bool quoted = false;
  for (std::size_t k = 0; k + 1 < message.size(); ++k) {
    const bool after_word = k > 0 && std::isalnum(static_cast<unsigned char>(message[k - 1])) != 0;
    const bool before_word = std::isalnum(static_cast<unsigned char>(message[k + 1])) != 0;
    if (message[k] == '\'' && !(after_word && before_word)) quoted = !quoted;
    if (message[k] == ';' && message[k + 1] == ' ' && !quoted) return message.substr(k + 2);
  }
  return {};
}

std::string line_of(const FileDiagnostic& d) {
  Diagnostics one(d.file);
  one.add(d.said);
  return lines_of(one);
}

void set_error(const std::string& said, const std::vector<FileDiagnostic>& diagnostics) {
  const py::object type = py::module_::import("loopwright._errors").attr("Error");
  const py::object error = type(text(said), py::tuple(py::cast(diagnostics)));
  PyErr_SetObject(type.ptr(), error.ptr());
}

void translate(std::exception_ptr thrown) {
  try {
    std::rethrow_exception(std::move(thrown));
  } catch (const py::builtin_exception&) {
    throw;
  } catch (const ProgramError& error) {
    set_error(error.what(), diagnostics_of(error.diagnostics()));
  } catch (const std::invalid_argument& error) {
    set_error(error.what(), {});
  } catch (const std::filesystem::filesystem_error& error) {
    set_error(error.what(), {});
  } catch (const std::runtime_error& error) {
    set_error(error.what(), {});
  }
}

}  // namespace

py::str text(const std::string& bytes) {
  PyObject* const decoded =
      PyUnicode_DecodeUTF8(bytes.data(), static_cast<Py_ssize_t>(bytes.size()), "replace");
  if (decoded == nullptr) throw py::error_already_set();
  return py::reinterpret_steal<py::str>(decoded);
}

ProgramError::ProgramError(Diagnostics diagnostics)
    : std::runtime_error(lines_of(diagnostics)), diagnostics_(std::move(diagnostics)) {}

std::vector<FileDiagnostic> diagnostics_of(const Diagnostics& diagnostics) {
  std::vector<FileDiagnostic> list;
  for (const Diagnostic& d : diagnostics.list()) list.push_back({diagnostics.file(), d});
  std::stable_sort(list.begin(), list.end(), [](const FileDiagnostic& a, const FileDiagnostic& b) {
    return std::pair(a.said.at.line, a.said.at.column) < std::pair(b.said.at.line, b.said.at.column);
  });
  return list;
}

void warn(const char* category, const std::string& said) {
  const py::object type = py::module_::import("loopwright._errors").attr(category);
  if (PyErr_WarnEx(type.ptr(), said.c_str(), 1) != 0) throw py::error_already_set();
}

namespace {
std::atomic<bool> has_drawn{false}, cannot_draw{false};
}

void begin_drawing() {
  if (cannot_draw)
    throw std::runtime_error(
        "no picture can be drawn: this process is a copy of one that has drawn, which OpenGL drivers do not "
        "survive; start it with multiprocessing.get_context('spawn')");
  has_drawn = true;
}

bool is_forked() {
  static std::atomic<bool> forked{false};
  // nobody is inside HDF5 or a driver while the process is copied
  static const int registered =
      pthread_atfork([] { one_at_a_time().lock(); }, [] { one_at_a_time().unlock(); },
                     [] {
                       one_at_a_time().unlock();
                       forked = true;
                       cannot_draw = cannot_draw || has_drawn;
                     });
  static_cast<void>(registered);
  return forked;
}

namespace {
std::exception_ptr noted_signal;  // to be used with the GIL held
}

void note_signals() {
  const py::gil_scoped_acquire acquired;
  try {
    if (PyErr_CheckSignals() != 0) throw py::error_already_set();
  } catch (...) {
    noted_signal = std::current_exception();
  }
}

void raise_noted_signal() {
  const py::gil_scoped_acquire acquired;
  if (noted_signal) std::rethrow_exception(std::exchange(noted_signal, nullptr));
}

std::mutex& one_at_a_time() {
  static std::mutex mutex;
  return mutex;
}

py::array points(const std::vector<Vec3>& list, std::shared_ptr<const void> owner) {
  static_assert(sizeof(Vec3) == 3 * sizeof(double));
  return view(reinterpret_cast<const double*>(list.data()), {static_cast<py::ssize_t>(list.size()), 3},
              {static_cast<py::ssize_t>(sizeof(Vec3)), static_cast<py::ssize_t>(sizeof(double))},
              std::move(owner));
}

py::object python_of(const JsonValue& value) {
  return std::visit(
      [](const auto& held) -> py::object {
        using Held = std::decay_t<decltype(held)>;
        if constexpr (std::is_same_v<Held, std::nullptr_t>) {
          return py::none();
        } else if constexpr (std::is_same_v<Held, JsonArray>) {
          py::list list;
          for (const JsonValue& each : held) list.append(python_of(each));
          return list;
        } else if constexpr (std::is_same_v<Held, JsonObject>) {
          return python_of(held);
        } else if constexpr (std::is_same_v<Held, double>) {
          return std::isfinite(held) ? py::object(py::float_(held)) : py::object(py::none());
        } else if constexpr (std::is_same_v<Held, std::string>) {
          return text(held);
        } else {
          return py::cast(held);
        }
      },
      value.variant());
}

py::dict python_of(const JsonObject& object) {
  py::dict dict;
  for (const auto& [key, value] : object) dict[py::str(key)] = python_of(value);
  return dict;
}

std::optional<WindowSize> window_of(const py::object& window) {
  if (window.is_none()) return std::nullopt;
  if (py::isinstance<py::str>(window)) return parsed_window(window.cast<std::string>());
  std::pair<std::optional<int>, std::optional<int>> counts;
  try {
    counts = window.cast<decltype(counts)>();
  } catch (const py::cast_error&) {
    throw py::type_error("a window is (wales, courses), None for all of them, or text such as '16x16'");
  }
  const auto written = [](const std::optional<int>& count) {
    return count ? std::to_string(*count) : std::string("all");
  };
  return parsed_window(written(counts.first) + 'x' + written(counts.second));
}

bool Watch::goes_on(const std::string& phase, double share, int step, double residual) {
  if (stopped_) return false;
  const py::gil_scoped_acquire acquired;
  try {
    if (PyErr_CheckSignals() != 0) throw py::error_already_set();
    raise_noted_signal();
    if (!callback_.is_none()) {
      const py::object type = py::module_::import("loopwright._errors").attr("Progress");
      stopped_ = callback_(type(phase, share, step, residual)).is(py::bool_(false));
    }
  } catch (...) {
    raised_ = std::current_exception();
    stopped_ = true;
  }
  return !stopped_;
}

void Watch::raise() const {
  if (raised_) std::rethrow_exception(raised_);
}

void bind_errors(py::module_& module) {
  is_forked();  // from now on it is seen
  py::register_exception_translator(&translate);
  py::class_<FileDiagnostic>(module, "Diagnostic",
                             "One thing that is said of a file: what is wrong, where, and what to do.")
      .def_property_readonly("file", [](const FileDiagnostic& d) { return text(d.file); })
      .def_property_readonly(
          "severity", [](const FileDiagnostic& d) { return std::string(to_string(d.said.severity)); },
          "'error', 'warning' or 'advice'.")
      .def_property_readonly(
          "line", [](const FileDiagnostic& d) { return d.said.at.line; }, "From 1; 0: the file as a whole.")
      .def_property_readonly(
          "column", [](const FileDiagnostic& d) { return d.said.at.column; },
          "From 1, in bytes; 0: the line as a whole.")
      .def_property_readonly(
          "message", [](const FileDiagnostic& d) { return text(d.said.message); },
          "What is wrong and what to do about it.")
      .def_property_readonly(
          "remedy", [](const FileDiagnostic& d) { return text(remedy_of(d.said.message)); },
          "The part of the message that says what to do; '' where the message is one sentence.")
      .def("__str__", [](const FileDiagnostic& d) { return text(line_of(d)); })
      .def("__repr__", [](const FileDiagnostic& d) { return text("<Diagnostic " + line_of(d) + ">"); })
      .def(py::pickle(
          [](const FileDiagnostic& d) {
            return py::make_tuple(py::bytes(d.file), static_cast<int>(d.said.severity), d.said.at.line,
                                  d.said.at.column, py::bytes(d.said.message));
          },
          [](const py::tuple& t) {
            return FileDiagnostic{
                t[0].cast<std::string>(),
                {Severity(t[1].cast<int>()), {t[2].cast<int>(), t[3].cast<int>()}, t[4].cast<std::string>()}};
          }));
}

}  // namespace loopwright::python
