// The command line: which words are understood, and what they fill in. The work is done in the files of
// commands.hpp.
#include <CLI/CLI.hpp>
#include <cstdio>
#include <exception>
#include <functional>
#include <iostream>

#include "commands.hpp"
#include "outputs/write_fabric.hpp"
#include "self_description.hpp"

namespace {

using namespace loopwright;

struct Commands {
  CheckCommand check;
  DiagramCommand diagram;
  ConvertCommand convert;
  BuildCommand build;
  RelaxCommand relax;
  StretchCommand stretch;
  HomogeniseCommand homogenise;
  SensitivityCommand sensitivity;
  RenderCommand render;
  ExportCommand export_;
  AnimateCommand animate;
  MeasureCommand measure;
  ViewCommand view;
};

void add_piece_options(CLI::App& command, PieceRequest& piece) {
  CLI::Option* periodic = command.add_flag("--periodic", piece.periodic,
                                           "One repeat of the structure as a cell that tiles the plane");
  command
      .add_option_function<std::string>(
          "--window", [&piece](const std::string& text) { piece.window = parsed_window(text); },
          "A part from the middle with held edges, in wales x courses: 16x16, allx16, 16xall")
      ->type_name("WxC")
      ->excludes(periodic);
}

void add_curve_options(CLI::App& command, PieceRequest& piece) {
  const std::string group = "Curves (.bcc, .yarns, .obj)";
  command
      .add_option("--yarn", piece.curve_yarn, "The yarn, as a fabric file's header says it: diameter=0.5 ...")
      ->type_name("DATA")
      ->group(group);
  command.add_option("--unit", piece.curve_unit_mm, "Length of the file's unit (default: 1)")
      ->type_name("MM")
      ->check(CLI::PositiveNumber)
      ->group(group);
}

void add_picture_options(CLI::App& command, PictureRequest& picture) {
  command.add_option("--view", picture.view, "Where the picture is taken from")
      ->check(CLI::IsMember({"front", "back", "left", "top", "corner", "left-corner"}))
      ->capture_default_str();
  command.add_option("--picture-size", picture.size, "Pixels of the picture")
      ->type_name("WxH")
      ->capture_default_str();
}

void add_loop_options(CLI::App& command, LoopRequest& loop) {
  const std::string group = "Loop model";
  command.add_option("--spring-law", loop.law, "Springs act along themselves, or on the whole vector")
      ->check(CLI::IsMember({"along", "vector"}))
      ->capture_default_str()
      ->group(group);
  command
      .add_flag("--coupling", loop.coupling, "A loop's yarn serves its width and height (Poisson's ratio)")
      ->group(group);
  command.add_option("--shear", loop.shear, "Diagonal springs, as a share of the weft springs")->group(group);
  command.add_option("--fold", loop.fold, "Springs that keep the fold of rib and purl, as a share")
      ->capture_default_str()
      ->group(group);
  command.add_option("--bend", loop.bend, "Springs over second neighbours, as a share")->group(group);
  command.add_option("--damping", loop.damping, "Damping over that which settles fast")
      ->capture_default_str()
      ->group(group);
  const std::string places = "top, bottom, left, right, corner, wale, course";
  command.add_option("--clamp", loop.clamps, "Hold a place: " + places)->type_name("PLACE")->group(group);
  command.add_option("--pull", loop.pulls, "Pull at a place outward, in cN: " + places)
      ->type_name("PLACE[:cN]")
      ->group(group);
  command.add_option("--take-down", loop.take_down_cN, "Hold the top and pull the bottom, in cN")
      ->type_name("cN")
      ->check(CLI::PositiveNumber)
      ->group(group);
  command.add_option("--ramp", loop.ramp_s, "Pulls grow over so many seconds")
      ->check(CLI::PositiveNumber)
      ->group(group);
  command.add_flag("--gravity", loop.gravity, "Weight along the wales, downward")->group(group);
}

void add_thread_option(CLI::App& command, int& threads) {
  command.add_option("--threads", threads, "Threads to use, 0 for all (results do not depend on it)")
      ->check(CLI::Range(0, 4096))
      ->capture_default_str();
}

void add_modes_option(CLI::App& command, int& modes) {
  command.add_option("--modes", modes, "Say whether the cloth is stable, and its so many lowest eigenvalues")
      ->type_name("N")
      ->check(CLI::Range(1, 100));
}

void add_segments_option(CLI::App& command, PieceRequest& piece) {
  command
      .add_option("--segments", piece.segments_per_loop,
                  "Segments of the spline in a loop: more are truer and slower")
      ->check(CLI::Range(8.0, 96.0))
      ->capture_default_str();
}

void add_homogenise(CLI::App& command, HomogeniseCommand& homogenise) {
  command.add_option("FILE", homogenise.file, "Fabric or knitout file, or a saved cell")->required();
  command
      .add_option("--json", homogenise.json, "Write the constants as JSON to a file, - for standard output")
      ->type_name("FILE");
  command
      .add_option("--csv", homogenise.csv,
                  "Write forces over a grid of strains as CSV, - for standard output")
      ->type_name("FILE");
  command.add_option("--plot", homogenise.plot, "Draw the pulls along courses and wales and their laws")
      ->type_name("SVG");
  command.add_option("--course", homogenise.course, "The grid's strains along the courses, beside 0")
      ->capture_default_str();
  command.add_option("--wale", homogenise.wale, "The grid's strains along the wales, beside 0")
      ->capture_default_str();
  command.add_option("--shear", homogenise.shear, "The grid's shears, beside 0")->capture_default_str();
  command.add_option("--course-pull", homogenise.course_pull, "Strain to which the cell is pulled")
      ->check(CLI::Range(0.01, 5.0))
      ->capture_default_str();
  command.add_option("--wale-pull", homogenise.wale_pull, "The same along the wales")
      ->check(CLI::Range(0.01, 5.0))
      ->capture_default_str();
  command.add_option("--step", homogenise.step, "Largest step of strain")
      ->check(CLI::Range(1e-4, 0.2))
      ->capture_default_str();
  add_segments_option(command, homogenise.piece);
  add_thread_option(command, homogenise.threads);
}

void add_sensitivity(CLI::App& command, SensitivityCommand& sensitivity) {
  command.add_option("FILE", sensitivity.file, "Fabric or knitout file, or a saved cell")->required();
  command
      .add_option("--deviation", sensitivity.deviations,
                  "Standard deviation of a quantity in per cent: loop-length=2 bend-stiffness=20")
      ->type_name("KEY=PERCENT");
  command.add_option("--csv", sensitivity.csv, "Write the table as CSV, - for standard output")
      ->type_name("FILE");
  command.add_option("--json", sensitivity.json, "Write it as JSON to a file, - for standard output")
      ->type_name("FILE");
  add_segments_option(command, sensitivity.piece);
  add_thread_option(command, sensitivity.threads);
}

using Action = std::function<int()>;

void add_commands(CLI::App& app, Commands& commands, Action& action) {
  CLI::App* check = app.add_subcommand("check", "Say what is wrong in programmes and fabric files");
  check->add_option("FILE", commands.check.files, "Knitout (.k, .knitout) or fabric (.verm) files")
      ->required();
  check
      ->add_option("--json", commands.check.json,
                   "Write the findings as JSON to a file, - for standard output")
      ->type_name("FILE");
  check
      ->add_option("--machine-state", commands.check.machine_state,
                   "Write where every loop and carrier went, as JSON to a file")
      ->type_name("FILE");
  check->add_option("--machine", commands.check.machine, "Ask the rules of a make of machine as well")
      ->check(CLI::IsMember({"shima", "kniterate"}));
  check->callback([&] { action = [&] { return run(commands.check); }; });

  CLI::App* diagram = app.add_subcommand("diagram", "Draw the needle diagram on point paper");
  diagram->add_option("FILE", commands.diagram.file, "Fabric or knitout file")->required();
  diagram->add_option("-o,--out", commands.diagram.out, "The drawing, - for standard output")
      ->type_name("SVG")
      ->required();
  diagram->add_option("--size", commands.diagram.size, "Wales and courses to draw; default: one repeat")
      ->type_name("WxC");
  diagram->add_flag("--whole", commands.diagram.whole, "As large as the file's Size says");
  diagram->add_option("--first", commands.diagram.first, "First pass of a knitout file to draw")
      ->check(CLI::Range(1, 100'000'000))
      ->capture_default_str();
  diagram->add_option("--passes", commands.diagram.most, "How many passes of a knitout file to draw")
      ->check(CLI::Range(1, 10'000))
      ->capture_default_str();
  diagram->callback([&] { action = [&] { return run(commands.diagram); }; });

  CLI::App* convert = app.add_subcommand(
      "convert", "Write a fabric file as knitout for a machine, or knitout as a fabric file");
  convert->add_option("FILE", commands.convert.file, "Fabric or knitout file")->required();
  convert->add_option("-o,--out", commands.convert.out, "What to write: .k, .knitout or .verm")
      ->type_name("OUT")
      ->required();
  convert->add_option("--machine", commands.convert.machine, "The make of machine (default: shima)")
      ->check(CLI::IsMember({"shima", "kniterate"}));
  convert->add_flag("--bind-off", commands.convert.bind_off, "Bind off instead of dropping the last loops");
  convert->callback([&] { action = [&] { return run(commands.convert); }; });

  CLI::App* build = app.add_subcommand("build", "Write the first geometry, before mechanics");
  build->add_option("FILE", commands.build.file, "Knitout or fabric file")->required();
  build->add_option("-o,--out", commands.build.out, "What to write: the suffix chooses the format")
      ->type_name("OUT")
      ->required();
  add_piece_options(*build, commands.build.piece);
  build->add_option("--layout", commands.build.layout, "Where loops lie: flat, or at rest in the loop model")
      ->check(CLI::IsMember({"flat", "loop"}))
      ->capture_default_str();
  build
      ->add_option("--json", commands.build.json,
                   "Write measurements as JSON to a file, - for standard output")
      ->type_name("FILE");
  build->callback([&] { action = [&] { return run(commands.build); }; });

  CLI::App* relax = app.add_subcommand("relax", "Bring the cloth to equilibrium");
  relax
      ->add_option("FILE", commands.relax.file,
                   "Knitout or fabric file, curves, or a saved state to go on with")
      ->required();
  add_curve_options(*relax, commands.relax.piece);
  relax->add_option("-o,--out", commands.relax.out, "What to write: the suffix chooses the format")
      ->type_name("OUT")
      ->required();
  add_piece_options(*relax, commands.relax.piece);
  relax
      ->add_option("--json", commands.relax.json,
                   "Write measurements as JSON to a file, - for standard output")
      ->type_name("FILE");
  relax->add_option("--render", commands.relax.render, "Draw the relaxed cloth")->type_name("PNG");
  add_picture_options(*relax, commands.relax.picture);
  relax
      ->add_option(
          "--friction", commands.relax.piece.friction,
          "Friction coefficient of yarn on yarn (0: frictionless; default: the yarn's own, else 0.25)")
      ->type_name("MU")
      ->check(CLI::Range(0.0, 5.0));
  relax->add_flag("!--from-template", commands.relax.piece.start_from_cell,
                  "Start a held piece from the first geometry, not from its relaxed repeat");
  relax
      ->add_option("--threads", commands.relax.threads,
                   "Threads to use, 0 for all (results do not depend on it)")
      ->check(CLI::Range(0, 4096))
      ->capture_default_str();
  relax->add_option("--most-iterations", commands.relax.most_iterations, "Stop after so many Newton steps")
      ->check(CLI::Range(1, 1'000'000));
  add_segments_option(*relax, commands.relax.piece);
  add_modes_option(*relax, commands.relax.modes);
  relax
      ->add_option("--set", commands.relax.set,
                   "Share of its curvature at rest that the yarn keeps as the shape it has when unloaded")
      ->type_name("SHARE")
      ->check(CLI::Range(0.0, 1.0));
  relax->add_flag("--let-go", commands.relax.let_go,
                  "In the end take away the plates between which a finite piece lies: plain curls");
  relax->callback([&] { action = [&] { return run(commands.relax); }; });

  CLI::App* stretch =
      app.add_subcommand("stretch", "Pull the relaxed cloth and read off the forces of its frame");
  stretch->add_option("FILE", commands.stretch.file, "Fabric or knitout file, or a saved state")->required();
  add_piece_options(*stretch, commands.stretch.piece);
  stretch->add_option("--direction", commands.stretch.direction, "What is prescribed")
      ->check(CLI::IsMember({"course", "wale", "both", "shear"}))
      ->capture_default_str();
  CLI::Option* strains =
      stretch->add_option("--to", commands.stretch.to, "Strains to go to, in order: 0.3 0 loads and unloads")
          ->capture_default_str();
  stretch->add_option("--step", commands.stretch.step, "Largest step of strain")
      ->check(CLI::Range(1e-4, 0.2))
      ->capture_default_str();
  CLI::Option* loads = stretch
                           ->add_option("--load", commands.stretch.load,
                                        "Forces to go to instead, N/m: 20 0 loads and unloads")
                           ->excludes(strains);
  stretch
      ->add_option("--load-step", commands.stretch.load_step,
                   "Largest step of force, N/m; a twentieth if not said")
      ->needs(loads)
      ->check(CLI::PositiveNumber);
  stretch->add_flag("--held-across", commands.stretch.held_across, "The other size stays as it is");
  stretch->add_option("--csv", commands.stretch.csv, "Write the points as CSV, - for standard output")
      ->type_name("FILE");
  stretch->add_option("--plot", commands.stretch.plot, "Draw force over strain")->type_name("SVG");
  stretch->add_option("-o,--out", commands.stretch.out, "Write the cloth as it is at the last point")
      ->type_name("OUT");
  stretch->add_option("--friction", commands.stretch.piece.friction, "Friction coefficient of yarn on yarn")
      ->type_name("MU")
      ->check(CLI::Range(0.0, 5.0));
  add_segments_option(*stretch, commands.stretch.piece);
  stretch->add_option("--threads", commands.stretch.threads, "Threads to use, 0 for all")
      ->check(CLI::Range(0, 4096))
      ->capture_default_str();
  stretch->callback([&] { action = [&] { return run(commands.stretch); }; });

  CLI::App* homogenise = app.add_subcommand(
      "homogenise", "Membrane constants of a cell: stiffness, Poisson's ratios, forces over strains");
  add_homogenise(*homogenise, commands.homogenise);
  homogenise->callback([&] { action = [&] { return run(commands.homogenise); }; });

  CLI::App* sensitivity =
      app.add_subcommand("sensitivity", "How a cell's size and stiffness depend on the data of its yarn");
  add_sensitivity(*sensitivity, commands.sensitivity);
  sensitivity->callback([&] { action = [&] { return run(commands.sensitivity); }; });

  CLI::App* render =
      app.add_subcommand("render", "Draw a picture of a file's first geometry or of a saved state");
  render->add_option("FILE", commands.render.file, "Knitout or fabric file, curves, or a saved state")
      ->required();
  add_curve_options(*render, commands.render.piece);
  render->add_option("-o,--out", commands.render.out, "The picture")->type_name("PNG")->required();
  add_piece_options(*render, commands.render.piece);
  add_picture_options(*render, commands.render.picture);
  render->add_option("--style", commands.render.style, "Yarn, or the loop model's net or sides")
      ->check(CLI::IsMember({"yarn", "structure", "sides"}))
      ->capture_default_str();
  render
      ->add_option("--moment", commands.render.moment, "Of the loop model: its start, stable state, or both")
      ->check(CLI::IsMember({"start", "stable", "both"}))
      ->capture_default_str();
  add_loop_options(*render, commands.render.loop);
  render->callback([&] { action = [&] { return run(commands.render); }; });

  CLI::App* animate = app.add_subcommand("animate", "Motion of loops or of yarns: pictures and a VTK series");
  animate->add_option("FILE", commands.animate.file, "Knitout or fabric file")->required();
  animate->add_option("-o,--out", commands.animate.out, "Folder for the frames")
      ->type_name("DIR")
      ->required();
  animate->add_option("--model", commands.animate.model, "What moves")
      ->check(CLI::IsMember({"loop", "yarn"}))
      ->capture_default_str();
  animate->add_option("--binding", commands.animate.binding, "Yarn model: what holds yarns to each other")
      ->check(CLI::IsMember({"barycentric", "sliding", "contact"}))
      ->capture_default_str();
  animate->add_option("--stretch", commands.animate.stretch, "Yarn model: pull the sides apart by this share")
      ->check(CLI::Range(-0.5, 3.0));
  animate
      ->add_option("--size", commands.animate.size,
                   "Yarn model: wales and courses, instead of the file's Size")
      ->type_name("WxC");
  animate->add_option("--style", commands.animate.style, "The net with its curves, or front and rear loops")
      ->check(CLI::IsMember({"structure", "sides"}))
      ->capture_default_str();
  animate->add_option("--frames", commands.animate.frames, "Number of frames")
      ->check(CLI::Range(2, 9999))
      ->capture_default_str();
  animate->add_option("--seconds", commands.animate.seconds, "Time shown (default: until nothing moves)")
      ->check(CLI::PositiveNumber);
  animate->add_flag("--no-pictures", commands.animate.no_pictures, "VTK files only");
  animate->add_option("--threads", commands.animate.threads, "Threads to use, 0 for all")
      ->check(CLI::Range(0, 4096));
  add_picture_options(*animate, commands.animate.picture);
  add_loop_options(*animate, commands.animate.loop);
  animate->callback([&] { action = [&] { return run(commands.animate); }; });

  CLI::App* export_ = app.add_subcommand("export", "Write a fabric in the format of another program");
  export_->add_option("FILE", commands.export_.file, "Saved state, knitout or fabric file, or curves")
      ->required();
  export_->add_option("-o,--out", commands.export_.out, "What to write: the suffix chooses the format")
      ->type_name("OUT")
      ->required();
  std::string names;
  for (const FormatEntry& entry : fabric_formats())
    names.append("\n").append(entry.name).append(": ").append(entry.what);
  export_
      ->add_option("--format", commands.export_.format,
                   "The format, where the suffix does not say it:" + names)
      ->type_name("NAME");
  export_
      ->add_option("--per-segment", commands.export_.options.per_segment,
                   "Points or rings on each of a loop's dozen spline segments")
      ->check(CLI::Range(1, 64))
      ->capture_default_str();
  export_->add_option("--sides", commands.export_.options.sides, "Corners of a tube's cross-section")
      ->check(CLI::Range(3, 256))
      ->capture_default_str();
  export_->add_option("--repeats", commands.export_.repeats, "Cells of a periodic fabric, in columns x rows")
      ->type_name("CxR")
      ->capture_default_str();
  export_->add_flag("--quadratic", commands.export_.options.quadratic_beams,
                    "Beam elements of three nodes (B32), as CalculiX always gets them");
  add_piece_options(*export_, commands.export_.piece);
  add_curve_options(*export_, commands.export_.piece);
  export_->callback([&] { action = [&] { return run(commands.export_); }; });

  CLI::App* measure = app.add_subcommand("measure", "Measure a saved state or curves");
  measure->add_option("STATE", commands.measure.file, "A saved state, or curves (.bcc, .yarns, .obj)")
      ->required();
  add_curve_options(*measure, commands.measure.piece);
  measure
      ->add_option("--json", commands.measure.json,
                   "Write measurements as JSON to a file, - for standard output")
      ->type_name("FILE");
  add_modes_option(*measure, commands.measure.modes);
  measure->callback([&] { action = [&] { return run(commands.measure); }; });

  CLI::App* view = app.add_subcommand("view", "The desktop application");
  view->add_option("FILE", commands.view.file, "Fabric file or knitout file to open");
  view->callback([&] { action = [&] { return run(commands.view); }; });

  add_self_description(app, action);
}

}  // namespace

int main(int argc, char** argv) {
  try {
    CLI::App app("From a knitting notation to relaxed cloth", "loopwright");
    app.require_subcommand(1);
    Commands commands;
    Action action;
    add_commands(app, commands, action);
    try {
      app.parse(argc, argv);
    } catch (const CLI::ParseError& error) {
      return app.exit(error) == 0 ? exit_good : exit_error;
    }
    const int status = action();
    // a full disk or a closed pipe shows when the last bytes leave
    if (!std::cout.flush()) throw std::runtime_error("cannot write to standard output");
    return status;
  } catch (const std::bad_alloc&) {
    std::fputs("loopwright: error: not enough memory\n", stderr);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "loopwright: error: %s\n", error.what());
  }
  return exit_error;
}
