// The compiled half of the Python package: the library's own functions, no second implementation.
#include "base/parallel.hpp"
#include "bindings.hpp"
#include "outputs/write_fabric.hpp"

PYBIND11_MODULE(_loopwright, module) {
  namespace py = pybind11;
  using namespace loopwright;
  module.doc() = "The compiled half of loopwright; import loopwright instead.";
  module.attr("__version__") = LOOPWRIGHT_VERSION;
  python::bind_errors(module);
  python::bind_program(module);
  python::bind_cloth(module);
  python::bind_experiments(module);
  module.def("set_threads", &set_thread_count, py::arg("threads"), py::call_guard<py::gil_scoped_release>());
  module.def("threads", &thread_count, py::call_guard<py::gil_scoped_release>());
  module.def("formats", [] {
    py::dict all;
    for (const FormatEntry& entry : fabric_formats()) {
      py::dict one;
      one["suffixes"] = py::tuple(py::str(entry.suffixes).attr("split")());
      one["what"] = entry.what;
      all[py::str(entry.name)] = one;
    }
    return all;
  });
}
