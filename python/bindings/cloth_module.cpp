// Cloth, its yarns and loops as arrays, its files and pictures.
#include "bindings.hpp"
#include "outputs/exchange/yarn_points.hpp"
#include "outputs/render.hpp"
#include "outputs/write_fabric.hpp"

namespace loopwright::python {
namespace {

// A yarn of a cloth; keeps it alive.
struct Yarn {
  std::shared_ptr<const Cloth> cloth;
  std::size_t index = 0;
  const FabricYarn& yarn() const { return cloth->fabric().yarns[index]; }
};

struct Loops {
  std::shared_ptr<const Cloth> cloth;
  const std::vector<LoopSpan>& list() const { return cloth->fabric().loops; }
};

struct Interlacings {
  std::shared_ptr<const Cloth> cloth;
  const std::vector<PlacedInterlacing>& list() const { return cloth->fabric().interlacings; }
};

// The points of a yarn, and the names of its forces' units.
struct Points {
  YarnPoints points;
  std::string tension_name, contact_name;
};
using PointsPointer = std::shared_ptr<Points>;

struct SharedForces {
  ToldForces told;
};

py::array own(std::vector<Vec3> list) {
  const auto owner = std::make_shared<const std::vector<Vec3>>(std::move(list));
  return points(*owner, owner);
}

py::array centreline(const Yarn& yarn, int per_segment) {
  if (per_segment < 1 || per_segment > 64) throw std::invalid_argument("per_segment lies from 1 to 64");
  const Fabric& fabric = yarn.cloth->fabric();
  return own(without_gil([&] {
    std::vector<Vec3> line = polyline(fabric, yarn.yarn(), per_segment);
    for (Vec3& p : line) p *= fabric.diameter_mm;
    return line;
  }));
}

std::vector<PointsPointer> points_of(const Cloth& cloth, int per_segment) {
  if (per_segment < 1 || per_segment > 64) throw std::invalid_argument("per_segment lies from 1 to 64");
  return without_gil([&] {
    const PointSource source(cloth.state(), per_segment);
    std::vector<PointsPointer> all;
    for (std::size_t y = 0; y < cloth.fabric().yarns.size(); ++y) {
      all.push_back(std::make_shared<Points>());
      all.back()->points = source.of(y);
      if (!source.forces()) continue;
      all.back()->tension_name = source.forces()->tension_name;
      all.back()->contact_name = source.forces()->contact_name;
    }
    return all;
  });
}

py::object forces_of(const Cloth& cloth) {
  std::optional<ToldForces> told = without_gil([&] { return told_forces(cloth.state()); });
  if (!told) return py::none();
  for (double& value : told->forces.tension) value *= told->tension_scale;
  for (double& value : told->forces.contact) value *= told->contact_scale;
  return py::cast(std::make_shared<SharedForces>(SharedForces{std::move(*told)}));
}

// The members of LoopSpan that are structs or enumerations, as numbers.
static_assert(sizeof(LoopId) == sizeof(std::int32_t));

ClothPointer relax(const Cloth& cloth, std::optional<double> friction, bool let_go,
                   std::optional<int> most_iterations, std::optional<double> tolerance, py::object progress) {
  Piece piece = cloth.piece();
  if (friction && !(*friction >= 0 && *friction <= 5))
    throw std::invalid_argument("friction lies from 0 to 5");
  if (most_iterations && *most_iterations < 1) throw std::invalid_argument("most_iterations begins at 1");
  if (tolerance && !(*tolerance > 0)) throw std::invalid_argument("the tolerance must be above 0");
  if (friction) piece.options.model.material.friction = *friction;
  if (most_iterations) piece.options.most_iterations = *most_iterations;
  if (tolerance) piece.options.tolerance = *tolerance;
  Watch watch(std::move(progress));
  ClothPointer relaxed = without_gil([&] {
    RelaxRun run = run_relax(piece, let_go, [&watch](const RelaxProgress& progress_now, double share) {
      return watch.goes_on(progress_now.phase, share, progress_now.newton_iterations, progress_now.residual);
    });
    // what was asked of this run alone
    run.options.most_iterations = cloth.piece().options.most_iterations;
    return std::make_shared<Cloth>(std::move(run), cloth.state());
  });
  watch.raise();
  warn_of(*relaxed);
  return relaxed;
}

ClothPointer load(const std::filesystem::path& file) {
  return without_gil([&] {
    const std::lock_guard lock(one_at_a_time());
    return std::make_shared<Cloth>(piece_of(read_state(file)));
  });
}

void export_to(const Cloth& cloth, const std::filesystem::path& file,
               const std::optional<std::string>& format, int per_segment, int sides,
               std::array<int, 2> repeats, bool quadratic_beams) {
  const FabricFormat chosen = format ? format_named(*format) : fabric_format(file);
  ExportOptions options{per_segment, sides, repeats, quadratic_beams};
  if (per_segment < 1 || per_segment > 64) throw std::invalid_argument("per_segment lies from 1 to 64");
  without_gil([&] {
    const std::lock_guard lock(one_at_a_time());
    write_fabric(file, cloth.state(), chosen, options);
  });
}

// `pixels_per_mm`: at the middle of what is drawn; none: so that all of it is in the picture.
Image picture(const Cloth& cloth, const RenderOptions& options, std::optional<double> pixels_per_mm = {}) {
  const Fabric& fabric = cloth.fabric();
  if (pixels_per_mm && !(*pixels_per_mm > 0 && *pixels_per_mm < 1e6))
    throw std::invalid_argument("pixels_per_mm must be a positive number");
  return without_gil([&] {
    const std::lock_guard lock(one_at_a_time());
    begin_drawing();
    if (!pixels_per_mm) return render(fabric, options);
    const Bounds bounds = fabric_bounds(fabric, drawn_repeats(fabric, options.repeats));
    Camera camera = fitted_camera(options.view, bounds, static_cast<double>(options.width) / options.height);
    camera.height = options.height / (*pixels_per_mm * fabric.diameter_mm);
    return render(fabric, camera, options);
  });
}

py::array pixels_of(Image image) {
  auto* kept = new std::vector<std::uint8_t>(std::move(image.pixels));
  const py::capsule base(kept, [](void* p) { delete static_cast<std::vector<std::uint8_t>*>(p); });
  return py::array_t<std::uint8_t>({image.height, image.width, 4}, kept->data(), base);
}

py::array render_to_array(const Cloth& cloth, const std::string& view, std::array<int, 2> size,
                          std::array<int, 2> repeats, std::optional<double> pixels_per_mm, double margin,
                          std::array<std::uint8_t, 3> background, bool transparent, bool shadows, bool table,
                          int plies, double twist, double fuzz) {
  RenderOptions options;
  const std::optional<View> known = view_named(view);
  if (!known)
    throw std::invalid_argument("there is no view '" + view +
                                "'; there are front, back, left, top, corner, left-corner");
  options.view = *known;
  options.width = size[0], options.height = size[1];
  options.repeats = repeats;
  options.margin = margin;
  options.style = {background, transparent, shadows, table};
  options.look.plies = plies, options.look.twist = twist, options.look.fuzz = fuzz;
  return pixels_of(picture(cloth, options, pixels_per_mm));
}

// What a notebook shows; None, so that it shows the line of words, where no picture can be drawn.
py::object png_of(const Cloth& cloth) {
  RenderOptions options;
  options.width = 800, options.height = 600;
  try {
    const std::vector<std::uint8_t> bytes = png_bytes(picture(cloth, options));
    return py::bytes(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  } catch (const NoOpenGl&) {
    return py::none();
  }
}

void write_pixels(const std::filesystem::path& file,
                  const py::array_t<std::uint8_t, py::array::c_style>& pixels) {
  if (pixels.ndim() != 3 || pixels.shape(2) != 4)
    throw std::invalid_argument("a picture is an array of shape (height, width, 4), uint8");
  Image image;
  image.height = static_cast<int>(pixels.shape(0)), image.width = static_cast<int>(pixels.shape(1));
  image.pixels.assign(pixels.data(), pixels.data() + pixels.size());
  without_gil([&] { write_png(file, image); });
}

// (2, 3): the lattice vectors of a cell.
py::object lattice_mm(const Cloth& cloth) {
  const Fabric& fabric = cloth.fabric();
  if (!fabric.periodic) return py::none();
  return own({fabric.lattice(1, 0) * fabric.diameter_mm, fabric.lattice(0, 1) * fabric.diameter_mm});
}

std::string description(const Cloth& cloth) {
  const Fabric& fabric = cloth.fabric();
  std::string said = "<Cloth";
  if (!fabric.name.empty()) said += " '" + fabric.name + "'";
  said += fabric.periodic ? ", a cell of " : ", a piece of ";
  said += std::to_string(fabric.loops.size()) + " loops, " + std::to_string(fabric.yarns.size()) + " yarns";
  if (const auto converged = cloth.number("converged"))
    said += *converged != 0 ? ", at rest" : ", not at rest";
  else if (cloth.number("radius").value_or(0) < 1)
    said += ", first geometry";
  return said + ">";
}

void bind_arrays(py::module_& module) {
  py::class_<Yarn>(module, "Yarn", "One yarn of a cloth; its arrays are views that keep the cloth alive.")
      .def_property_readonly(
          "control_points", [](const Yarn& y) { return points(y.yarn().control_points, y.cloth); },
          "(n, 3) float64, in yarn diameters d: control points of a uniform cubic B-spline. A view.")
      .def_property_readonly(
          "held", [](const Yarn& y) { return column(y.yarn().held, y.cloth); },
          "(n,) uint8: 1 for control points that are tied to the frame. A view.")
      .def_property_readonly("segments", [](const Yarn& y) { return y.yarn().segments(); })
      .def_property_readonly(
          "periodic", [](const Yarn& y) { return y.yarn().periodic; },
          "It goes on into its own beginning, `shift` lattice vectors further.")
      .def_property_readonly("shift", [](const Yarn& y) { return y.yarn().shift; })
      .def_property_readonly(
          "number", [](const Yarn& y) { return y.yarn().yarn.value; }, "Of the yarn that it is a piece of.")
      .def_property_readonly("colour", [](const Yarn& y) { return y.yarn().colour; })
      .def_property_readonly("diameter_mm",
                             [](const Yarn& y) { return y.yarn().diameter * y.cloth->fabric().diameter_mm; })
      .def_property_readonly(
          "linear_density_tex", [](const Yarn& y) { return y.yarn().linear_density_tex; }, "0: not known.")
      .def_property_readonly(
          "rest_length_mm",
          [](const Yarn& y) {
            return y.yarn().segment_rest_length * y.yarn().segments() * y.cloth->fabric().diameter_mm;
          },
          "Unloaded length.")
      .def("centreline", &centreline, py::arg("per_segment") = 4,
           "(m, 3) float64, mm: points at equal steps of the spline's parameter, both ends included.");

  py::class_<Loops>(module, "Loops",
                    "The loops of a cloth as columns: (loops,) views that keep the cloth alive.")
      .def("__len__", [](const Loops& l) { return l.list().size(); })
      .def_property_readonly(
          "number", [](const Loops& l) { return column<std::int32_t>(l.list(), &LoopSpan::loop, l.cloth); },
          "int32: of the loop in the whole programme.")
      .def_property_readonly(
          "yarn", [](const Loops& l) { return column<std::int32_t>(l.list(), &LoopSpan::yarn, l.cloth); },
          "int32: index into Cloth.yarns.")
      .def_property_readonly(
          "begin", [](const Loops& l) { return column<double>(l.list(), &LoopSpan::begin, l.cloth); },
          "float64: parameter of the yarn, in segments, where the loop begins; apex: its top; end.")
      .def_property_readonly(
          "apex", [](const Loops& l) { return column<double>(l.list(), &LoopSpan::apex, l.cloth); })
      .def_property_readonly("end",
                             [](const Loops& l) { return column<double>(l.list(), &LoopSpan::end, l.cloth); })
      .def_property_readonly(
          "kind", [](const Loops& l) { return column<std::uint8_t>(l.list(), &LoopSpan::kind, l.cloth); },
          "uint8: 0 knit, 1 cast on, 2 tuck, 3 split.")
      .def_property_readonly(
          "side", [](const Loops& l) { return column<std::int8_t>(l.list(), &LoopSpan::side, l.cloth); },
          "int8: 1 front stitch, -1 rear stitch.")
      .def_property_readonly(
          "course", [](const Loops& l) { return column<std::int32_t>(l.list(), &LoopSpan::course, l.cloth); },
          "int32: counted from the first of the whole piece; -1: not known.")
      .def_property_readonly(
          "slot", [](const Loops& l) { return column<double>(l.list(), &LoopSpan::slot, l.cloth); },
          "float64: where it was formed, in needles.")
      .def_property_readonly(
          "bed", [](const Loops& l) { return column<std::uint8_t>(l.list(), &LoopSpan::bed, l.cloth); },
          "uint8: 0 front, 1 back.")
      .def_property_readonly(
          "line",
          [](const Loops& l) {
            static const LoopSpan nothing{};
            const LoopSpan& first = l.list().empty() ? nothing : l.list().front();
            return view(&first.at.line, {static_cast<py::ssize_t>(l.list().size())},
                        {static_cast<py::ssize_t>(sizeof(LoopSpan))}, l.cloth);
          },
          "int32: of the file, from 1; 0: none.");

  py::class_<Interlacings>(module, "Interlacings",
                           "Who is drawn through whom, as columns: views that keep the cloth alive.")
      .def("__len__", [](const Interlacings& i) { return i.list().size(); })
      .def_property_readonly(
          "parent",
          [](const Interlacings& i) {
            return column<std::int32_t>(i.list(), &PlacedInterlacing::parent, i.cloth);
          },
          "int32: number of the loop that another is drawn through (Loops.number).")
      .def_property_readonly(
          "child",
          [](const Interlacings& i) {
            return column<std::int32_t>(i.list(), &PlacedInterlacing::child, i.cloth);
          },
          "int32: number of the loop that is drawn through it.")
      .def_property_readonly(
          "sign",
          [](const Interlacings& i) {
            return column<std::int32_t>(i.list(), &PlacedInterlacing::sign, i.cloth);
          },
          "int32: 1 front stitch, -1 rear stitch.")
      .def_property_readonly(
          "broken", [](const Interlacings& i) { return i.cloth->assessment().interlacings.broken; },
          "Places in these columns of those that are lost.");

  py::class_<Points, PointsPointer>(module, "YarnPoints",
                                    "The points of a yarn's centreline with what is known of each.")
      .def_property_readonly(
          "place_mm", [](const PointsPointer& p) { return points(p->points.place_mm, p); },
          "(m, 3) float64, mm.")
      .def_property_readonly(
          "arc_mm", [](const PointsPointer& p) { return column(p->points.arc_mm, p); },
          "(m,) float64, mm: length from the yarn's first point.")
      .def_property_readonly(
          "curvature_per_mm", [](const PointsPointer& p) { return column(p->points.curvature_per_mm, p); },
          "(m,) float64, 1/mm.")
      .def_property_readonly(
          "loop", [](const PointsPointer& p) { return column(p->points.loop, p); },
          "(m,) int32: place in Cloth.loops; -1 on floats and tails.")
      .def_property_readonly(
          "tension",
          [](const PointsPointer& p) -> py::object {
            if (p->points.tension.empty()) return py::none();
            return column(p->points.tension, p);
          },
          "(m,) float64, in tension_name; None for a first geometry.")
      .def_property_readonly(
          "contact",
          [](const PointsPointer& p) -> py::object {
            if (p->points.contact.empty()) return py::none();
            return column(p->points.contact, p);
          },
          "(m,) float64, in contact_name: what other yarn presses with, per length.")
      .def_readonly("tension_name", &Points::tension_name, "'tension_cN', or 'tension_B_per_d2'.")
      .def_readonly("contact_name", &Points::contact_name, "'contact_cN_per_mm', or 'contact_B_per_d3'.")
      .def("__len__", [](const PointsPointer& p) { return p->points.place_mm.size(); });

  using ForcesPointer = std::shared_ptr<SharedForces>;
  py::class_<SharedForces, ForcesPointer>(module, "YarnForces",
                                          "Forces in all segments of all yarns in turn.")
      .def_property_readonly(
          "tension", [](const ForcesPointer& f) { return column(f->told.forces.tension, f); },
          "(segments,) float64, in tension_name; below 0 where yarn is shorter than unloaded.")
      .def_property_readonly(
          "contact",
          [](const ForcesPointer& f) {
            const std::vector<double>& list = f->told.forces.contact;
            const auto samples = static_cast<py::ssize_t>(f->told.forces.samples);
            constexpr auto size = static_cast<py::ssize_t>(sizeof(double));
            return view(list.data(), {static_cast<py::ssize_t>(list.size()) / samples, samples},
                        {samples * size, size}, f);
          },
          "(segments, samples) float64, in contact_name: what other yarn presses with, per length.")
      .def_property_readonly("tension_name", [](const ForcesPointer& f) { return f->told.tension_name; })
      .def_property_readonly("contact_name", [](const ForcesPointer& f) { return f->told.contact_name; });
}

}  // namespace

void warn_of(const Cloth& relaxed) {
  const bool whole = without_gil([&] { return relaxed.whole(); });
  const InterlacingCheck& kept = relaxed.assessment().interlacings;
  if (!whole)
    warn("BrokenWarning", "broken: " + std::to_string(kept.intact) + " of " + std::to_string(kept.expected) +
                              " interlacings intact, " +
                              std::to_string(static_cast<int>(relaxed.number("pass_throughs").value_or(0))) +
                              " pass-throughs");
  if (!relaxed.stopped() && relaxed.number("converged") != 1.0)
    warn("NotAtRestWarning", "not at rest: " + relaxed.message());
}

void bind_cloth(py::module_& module) {
  bind_arrays(module);
  py::class_<Cloth, ClothPointer>(
      module, "Cloth",
      "Yarns in space: a first geometry, or cloth at rest. It never changes; what does something to it\n"
      "gives a new one.")
      .def_property_readonly("name", [](const Cloth& c) { return text(c.fabric().name); })
      .def_property_readonly(
          "periodic", [](const Cloth& c) { return c.fabric().periodic; }, "A cell that tiles the plane.")
      .def_property_readonly(
          "diameter_mm", [](const Cloth& c) { return c.fabric().diameter_mm; },
          "d, the diameter of the thickest yarn, in mm.")
      .def_property_readonly("lattice_mm", &lattice_mm, "(2, 3) float64, mm: of a cell; None for a piece.")
      .def_property_readonly("yarns",
                             [](const ClothPointer& c) {
                               py::tuple yarns(c->fabric().yarns.size());
                               for (std::size_t k = 0; k < yarns.size(); ++k) yarns[k] = Yarn{c, k};
                               return yarns;
                             })
      .def_property_readonly("loops", [](const ClothPointer& c) { return Loops{c}; })
      .def_property_readonly("interlacings", [](const ClothPointer& c) { return Interlacings{c}; })
      .def_property_readonly(
          "interlacings_kept",
          [](const Cloth& c) {
            const Assessment& found = without_gil([&]() -> const Assessment& { return c.assessment(); });
            return std::pair(found.interlacings.intact, found.interlacings.expected);
          },
          "(kept, of so many that the machine drew): cloth is what was knitted only if they are equal.")
      .def_property_readonly(
          "whole", [](const Cloth& c) { return without_gil([&] { return c.whole(); }); },
          "Every interlacing is there and no yarn went through another.")
      .def_property_readonly(
          "converged",
          [](const Cloth& c) -> std::optional<bool> {
            const auto number = c.number("converged");
            if (!number) return std::nullopt;
            return *number != 0;
          },
          "Every force is at rest; None for a first geometry.")
      .def_property_readonly(
          "residual", [](const Cloth& c) { return c.number("residual"); },
          "Largest force on a control point, B/d^2 (B: bending stiffness).")
      .def_property_readonly("stopped", &Cloth::stopped, "The run was stopped before its end.")
      .def_property_readonly("message", &Cloth::message, "Why the run ended, in words.")
      .def_property_readonly(
          "numbers", [](const Cloth& c) { return c.state().numbers; },
          "What a saved state says of the run and the yarn, by name.")
      .def(
          "measure",
          [](const Cloth& c) {
            return python_of(
                results(without_gil([&]() -> const Assessment& { return c.assessment(); }), c.state()));
          },
          "Sizes, densities, loop length, mass and the interlacing check, by the keys of docs/command.md,\n"
          "each with its unit; None for what is not known.")
      .def("relax", &relax, py::kw_only(), py::arg("friction") = py::none(), py::arg("let_go") = false,
           py::arg("most_iterations") = py::none(), py::arg("tolerance") = py::none(),
           py::arg("progress") = py::none(),
           "Equilibrium, as a new Cloth. Warns if it is broken or not at rest.\n\n"
           "friction: of yarn on yarn (0 to 5), instead of the yarn's own; let_go: take a piece's plates "
           "away\n"
           "in the end; tolerance: largest force that counts as rest, B/d^2; progress: called with a "
           "Progress\n"
           "after every step, False stops and gives what was reached. Ctrl-C raises KeyboardInterrupt.")
      .def("points", &points_of, py::arg("per_segment") = 4,
           "A YarnPoints for every yarn: per_segment points on each segment of the spline, both ends "
           "included.")
      .def("forces", &forces_of,
           "Tension and contact in every segment, or None for a first geometry, whose yarn is not grown in.")
      .def("export", &export_to, py::arg("file"), py::kw_only(), py::arg("format") = py::none(),
           py::arg("per_segment") = 4, py::arg("sides") = 8, py::arg("repeats") = std::array<int, 2>{1, 1},
           py::arg("quadratic_beams") = false,
           "Writes a format of another program; the suffix says which, or `format` (loopwright.formats()).")
      .def(
          "save",
          [](const Cloth& c, const std::filesystem::path& file) {
            export_to(c, file, "state", 4, 8, {1, 1}, false);
          },
          py::arg("file"), "Writes a saved state (HDF5), which `load` and the command read back to the bit.")
      .def("render", &render_to_array, py::kw_only(), py::arg("view") = "front",
           py::arg("size") = std::array<int, 2>{1600, 1200}, py::arg("repeats") = std::array<int, 2>{0, 0},
           py::arg("pixels_per_mm") = py::none(), py::arg("margin") = 1.06,
           py::arg("background") = std::array<std::uint8_t, 3>{246, 245, 242}, py::arg("transparent") = false,
           py::arg("shadows") = true, py::arg("table") = true, py::arg("plies") = 2, py::arg("twist") = 0.34,
           py::arg("fuzz") = 1.0,
           "A picture, (height, width, 4) uint8: red, green, blue (sRGB), alpha, rows from the top.\n\n"
           "view: front, back, left, top, corner, left-corner; size: (width, height) in pixels;\n"
           "repeats: cells to draw, (0, 0): enough for six wales and six courses; pixels_per_mm: the scale, "
           "at the\n"
           "middle of what is drawn (everywhere in a view across the cloth); None: all of it is in the "
           "picture.")
      .def("_repr_png_", &png_of)
      .def("__repr__", [](const Cloth& c) { return text(description(c)); });

  module.def("load", &load, py::arg("file"));
  module.def("write_png", &write_pixels, py::arg("file"), py::arg("pixels"));
}

}  // namespace loopwright::python
