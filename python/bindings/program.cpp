// Programmes: reading, checking, and the road up to the first geometry.
#include <charconv>

#include "bindings.hpp"
#include "machine/machine_rules.hpp"
#include "machine/review.hpp"
#include "notation/read_program.hpp"
#include "outputs/exchange/curve_file.hpp"
#include "outputs/write_fabric.hpp"

namespace loopwright::python {
namespace {

// What `check` finds.
struct Findings {
  Diagnostics diagnostics;
  std::size_t instructions = 0, yarns = 0, loops = 0, interlacings = 0, unheld = 0, left_on_needles = 0;
  int passes = 0, carriage_passes = 0;
};

Findings findings_of(const Knitting& knitting, Diagnostics diagnostics) {
  Findings found{std::move(diagnostics)};
  found.instructions = knitting.program.instructions.size();
  found.passes = knitting.record.passes, found.carriage_passes = knitting.record.carriage_passes;
  found.yarns = knitting.graph.yarns.size(), found.loops = knitting.graph.loops.size();
  found.interlacings = knitting.graph.interlacings.size();
  found.unheld = knitting.graph.unheld.size();
  found.left_on_needles = knitting.graph.left_on_needles.size();
  return found;
}

// A notation with what the caller states beside it.
class ReadProgram {
 public:
  ReadProgram(std::string file, std::string text, std::string suffix, StatedHeaders stated)
      : file_(std::move(file)),
        text_(std::move(text)),
        suffix_(std::move(suffix)),
        stated_(std::move(stated)) {}

  const std::string& file() const { return file_; }
  const std::string& text() const { return text_; }
  const std::string& suffix() const { return suffix_; }
  const StatedHeaders& stated() const { return stated_; }

  Knitting knit(bool periodic, Diagnostics& diagnostics) const {
    FabricOptions options;
    if (periodic) options.edges = Edges::periodic;
    return knit_text(text_, suffix_, options, stated_, diagnostics);
  }

  // Throws ProgramError if the programme has errors or no such part.
  Piece build(const PieceRequest& request, bool loop_layout, Watch& watch) const {
    Diagnostics diagnostics(file_);
    const Knitting knitting = knit(request.periodic, diagnostics);
    if (diagnostics.ok()) {
      try {
        Piece piece = loop_layout ? loop_layout_piece(knitting, request)
                                  : first_piece(knitting, request, [&watch](const RelaxProgress& progress) {
                                      return watch.goes_on("relaxed repeat", 0, progress.newton_iterations,
                                                           progress.residual);
                                    });
        keep_notation(piece.state, text_, suffix_);
        return piece;
      } catch (const std::invalid_argument& fault) {
        diagnostics.error({}, fault.what());
      }
    }
    throw ProgramError(std::move(diagnostics));
  }

 private:
  std::string file_, text_, suffix_;
  StatedHeaders stated_;
};

// Keywords as headers: loop_length_mm=5.9 is `Loop-Length: 5.9 mm`. What is None was not stated.
struct Keyword {
  const char *name, *header, *unit;
};
constexpr std::array<Keyword, 7> keywords{{{"gauge_npi", "Gauge", ""},
                                           {"bed_gap_mm", "Bed-Gap", " mm"},
                                           {"loop_length_mm", "Loop-Length", " mm"},
                                           {"tuck_length_mm", "Tuck-Length", " mm"},
                                           {"float_slack", "Float-Slack", ""},
                                           {"bed_change_mm", "Bed-Change", " mm"},
                                           {"set", "Set", ""}}};

StatedHeaders stated_by(const py::kwargs& arguments, StatedHeaders stated = {}) {
  for (const auto& [key, value] : arguments) {
    const std::string name = py::str(key);
    if (value.is_none()) continue;
    if (name == "yarn") {
      stated.yarn = value.cast<std::string>();
      continue;
    }
    const auto* const known =
        std::find_if(keywords.begin(), keywords.end(), [&](const Keyword& k) { return name == k.name; });
    if (known == keywords.end()) throw py::type_error("there is no argument '" + name + "'");
    // repr() has the digits that read back to the same number
    const std::string number = py::str(py::repr(py::float_(py::reinterpret_borrow<py::object>(value))));
    std::erase_if(stated.settings, [&](const auto& each) { return each.first == known->header; });
    stated.settings.emplace_back(known->header, number + known->unit);
  }
  return stated;
}

std::string text_of(const std::filesystem::path& file) {
  Diagnostics diagnostics(file.string());
  const std::optional<std::string> text = read_text(file, diagnostics);
  if (!text) throw ProgramError(std::move(diagnostics));
  return *text;
}

std::shared_ptr<ReadProgram> good_program(ReadProgram program) {
  Diagnostics diagnostics(program.file());
  without_gil([&] { return program.knit(false, diagnostics); });
  if (!diagnostics.ok()) throw ProgramError(std::move(diagnostics));
  return std::make_shared<ReadProgram>(std::move(program));
}

std::shared_ptr<ReadProgram> program_of_file(const std::filesystem::path& file, const py::kwargs& stated) {
  return good_program({file.string(), text_of(file), file.extension().string(), stated_by(stated)});
}

std::shared_ptr<ReadProgram> program_of_text(const std::string& text, const std::string& suffix,
                                             const std::string& name, const py::kwargs& stated) {
  return good_program({name, text, suffix, stated_by(stated)});
}

Findings check(const ReadProgram& program, const std::optional<std::string>& machine) {
  const std::optional<MachineKind> make = machine_named(machine.value_or(""));
  if (machine && !make)
    throw std::invalid_argument("there is no machine '" + *machine + "'; there are shima, kniterate");
  return without_gil([&] {
    Diagnostics diagnostics(program.file());
    const Knitting knitting = program.knit(false, diagnostics);
    review(knitting.program, knitting.record, diagnostics);
    if (make) check_machine_rules(knitting.program, *make, diagnostics);
    return findings_of(knitting, std::move(diagnostics));
  });
}

Findings check_file(const std::filesystem::path& file, const std::optional<std::string>& machine) {
  Diagnostics diagnostics(file.string());
  const std::optional<std::string> text = read_text(file, diagnostics);
  if (!text) return {std::move(diagnostics)};
  return check({file.string(), *text, file.extension().string(), {}}, machine);
}

ClothPointer build(const ReadProgram& program, bool periodic, const py::object& window,
                   std::optional<double> friction, const std::string& layout, double segments_per_loop,
                   bool start_from_cell, py::object progress) {
  PieceRequest request;
  request.periodic = periodic;
  request.window = window_of(window);
  request.friction = friction;
  request.segments_per_loop = segments_per_loop;
  request.start_from_cell = start_from_cell;
  if (layout != "flat" && layout != "loop")
    throw std::invalid_argument("there is no layout '" + layout + "'; there are flat, loop");
  if (request.periodic && request.window)
    throw std::invalid_argument("a cell has no window: ask for one of periodic and window");
  if (layout == "loop" && (request.periodic || request.window))
    throw std::invalid_argument("the layout 'loop' is for whole pieces, not for a cell or window");
  if (!(segments_per_loop >= 8 && segments_per_loop <= 96))
    throw std::invalid_argument("segments_per_loop lies from 8 to 96");
  if (friction && !(*friction >= 0 && *friction <= 5))
    throw std::invalid_argument("friction lies from 0 to 5");
  Watch watch(std::move(progress));
  ClothPointer cloth =
      without_gil([&] { return std::make_shared<Cloth>(program.build(request, layout == "loop", watch)); });
  watch.raise();
  return cloth;
}

ClothPointer read_curves(const std::filesystem::path& file, const std::string& yarn,
                         std::optional<double> unit_mm, std::optional<double> friction) {
  PieceRequest request;
  request.curve_yarn = yarn;
  request.curve_unit_mm = unit_mm;
  request.friction = friction;
  Diagnostics diagnostics("yarn");
  const ImportedCurves imported = without_gil([&] { return import_curves(file, request, diagnostics); });
  if (!diagnostics.ok()) throw ProgramError(std::move(diagnostics));
  return std::make_shared<Cloth>(piece_of(imported));
}

std::string kind_of(const std::filesystem::path& file) {
  if (names_curves(file)) return "curves";
  try {
    return fabric_format(file) == FabricFormat::state ? "state" : "notation";
  } catch (const std::invalid_argument&) {
    return "notation";
  }
}

}  // namespace

void bind_program(py::module_& module) {
  py::class_<Findings>(module, "Findings", "What `check` found in a programme.")
      .def_property_readonly("file", [](const Findings& f) { return text(f.diagnostics.file()); })
      .def_property_readonly(
          "ok", [](const Findings& f) { return f.diagnostics.ok(); }, "No error.")
      .def_property_readonly("errors", [](const Findings& f) { return f.diagnostics.errors(); })
      .def_property_readonly("warnings", [](const Findings& f) { return f.diagnostics.warnings(); })
      .def_property_readonly("advice", [](const Findings& f) { return f.diagnostics.advice(); })
      .def_property_readonly(
          "diagnostics", [](const Findings& f) { return py::tuple(py::cast(diagnostics_of(f.diagnostics))); },
          "All that was said, in the order of the file's lines (the first 1000 of each severity).")
      .def_readonly("instructions", &Findings::instructions)
      .def_readonly("passes", &Findings::passes, "Runs of yarn in one direction.")
      .def_readonly("carriage_passes", &Findings::carriage_passes,
                    "Traverses of the carriage, transfers included.")
      .def_readonly("yarns", &Findings::yarns)
      .def_readonly("loops", &Findings::loops)
      .def_readonly("interlacings", &Findings::interlacings, "Pairs of loops drawn through each other.")
      .def_readonly("unheld_loops", &Findings::unheld, "Loops that will run.")
      .def_readonly("loops_left_on_needles", &Findings::left_on_needles)
      .def("__bool__", [](const Findings& f) { return f.diagnostics.ok(); })
      .def("__str__",
           [](const Findings& f) {
             std::string said = ProgramError(f.diagnostics).what();
             if (f.diagnostics.ok())
               said += (said.empty() ? "" : "\n") + f.diagnostics.file() + ": " + std::to_string(f.loops) +
                       " loops, " + std::to_string(f.yarns) + " yarns, " + std::to_string(f.passes) +
                       " passes, " + std::to_string(f.interlacings) + " interlacings";
             return text(said);
           })
      .def("__repr__", [](const Findings& f) {
        return text("<Findings " + f.diagnostics.file() + ": " + std::to_string(f.diagnostics.errors()) +
                    " errors, " + std::to_string(f.diagnostics.warnings()) + " warnings>");
      });

  py::class_<ReadProgram, std::shared_ptr<ReadProgram>>(
      module, "Program", "A knitting programme that was read without errors: a fabric file or knitout.")
      .def_property_readonly(
          "file", [](const ReadProgram& program) { return text(program.file()); },
          "The name that messages call it by.")
      .def_property_readonly(
          "text", [](const ReadProgram& program) { return text(program.text()); },
          "The notation as it is written.")
      .def_property_readonly("suffix", &ReadProgram::suffix)
      .def(
          "changed",
          [](const ReadProgram& program, const py::kwargs& stated) {
            return good_program(
                {program.file(), program.text(), program.suffix(), stated_by(stated, program.stated())});
          },
          "The same with other data: gauge_npi, bed_gap_mm, loop_length_mm, tuck_length_mm, float_slack,\n"
          "bed_change_mm, set, yarn (as a fabric file's header states it, of every carrier).")
      .def("check", &check, py::arg("machine") = py::none(),
           "What is wrong and what a knitter would look at twice; machine: 'shima' or 'kniterate'.")
      .def("build", &build, py::kw_only(), py::arg("periodic") = false, py::arg("window") = py::none(),
           py::arg("friction") = py::none(), py::arg("layout") = "flat", py::arg("segments_per_loop") = 12.0,
           py::arg("start_from_cell") = false, py::arg("progress") = py::none(),
           "The first geometry, before mechanics.\n\n"
           "periodic: one repeat as a cell; window: (wales, courses) from the middle, None for all;\n"
           "friction: of yarn on yarn; layout: 'flat', or 'loop': at rest at loop scale;\n"
           "start_from_cell: a held piece starts from its relaxed repeat.")
      .def("__repr__", [](const ReadProgram& program) { return text("<Program " + program.file() + ">"); })
      .def(py::pickle(
          [](const ReadProgram& program) {
            return py::make_tuple(py::bytes(program.file()), py::bytes(program.text()), program.suffix(),
                                  program.stated().settings, program.stated().yarn);
          },
          [](const py::tuple& t) {
            return std::make_shared<ReadProgram>(
                t[0].cast<std::string>(), t[1].cast<std::string>(), t[2].cast<std::string>(),
                StatedHeaders{t[3].cast<std::vector<std::pair<std::string, std::string>>>(),
                              t[4].cast<std::string>()});
          }));

  module.def("read", &program_of_file, py::arg("file"));
  module.def("read_text", &program_of_text, py::arg("text"), py::arg("suffix") = ".verm",
             py::arg("name") = "text");
  module.def("check_file", &check_file, py::arg("file"), py::arg("machine") = py::none());
  module.def(
      "check_text",
      [](const std::string& text, const std::string& suffix, const std::string& name,
         const std::optional<std::string>& machine) {
        return check({name, text, suffix, {}}, machine);
      },
      py::arg("text"), py::arg("suffix") = ".verm", py::arg("name") = "text",
      py::arg("machine") = py::none());
  module.def("read_curves", &read_curves, py::arg("file"), py::kw_only(), py::arg("yarn") = "",
             py::arg("unit_mm") = py::none(), py::arg("friction") = py::none());
  module.def("kind_of", &kind_of, py::arg("file"));
}

}  // namespace loopwright::python
