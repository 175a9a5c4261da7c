// The command line: which words are understood, and what they fill in. The work is done in the files of
// commands.hpp.
#include <CLI/CLI.hpp>
#include <cstdio>
#include <exception>
#include <functional>
#include <iostream>

#include "commands.hpp"

namespace {

using namespace loopwright;

struct Commands {
  CheckCommand check;
  DiagramCommand diagram;
  ConvertCommand convert;
  BuildCommand build;
  RelaxCommand relax;
  RenderCommand render;
  MeasureCommand measure;
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

void add_picture_options(CLI::App& command, PictureRequest& picture) {
  command.add_option("--view", picture.view, "Where the picture is taken from")
      ->check(CLI::IsMember({"front", "back", "left", "top", "corner"}))
      ->capture_default_str();
  command.add_option("--picture-size", picture.size, "Pixels of the picture")
      ->type_name("WxH")
      ->capture_default_str();
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
  build
      ->add_option("--json", commands.build.json,
                   "Write measurements as JSON to a file, - for standard output")
      ->type_name("FILE");
  build->callback([&] { action = [&] { return run(commands.build); }; });

  CLI::App* relax = app.add_subcommand("relax", "Bring the cloth to equilibrium");
  relax->add_option("FILE", commands.relax.file, "Knitout or fabric file, or a saved state to go on with")
      ->required();
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
  relax->callback([&] { action = [&] { return run(commands.relax); }; });

  CLI::App* render =
      app.add_subcommand("render", "Draw a picture of a file's first geometry or of a saved state");
  render->add_option("FILE", commands.render.file, "Knitout or fabric file, or a saved state")->required();
  render->add_option("-o,--out", commands.render.out, "The picture")->type_name("PNG")->required();
  add_piece_options(*render, commands.render.piece);
  add_picture_options(*render, commands.render.picture);
  render->callback([&] { action = [&] { return run(commands.render); }; });

  CLI::App* measure = app.add_subcommand("measure", "Measure a saved state");
  measure->add_option("STATE", commands.measure.file, "A saved state")->required();
  measure
      ->add_option("--json", commands.measure.json,
                   "Write measurements as JSON to a file, - for standard output")
      ->type_name("FILE");
  measure->callback([&] { action = [&] { return run(commands.measure); }; });

  app.add_subcommand("version", "Print the version")->callback([&] {
    action = [] {
      std::cout << "loopwright " LOOPWRIGHT_VERSION "\n";
      return exit_good;
    };
  });
}

}  // namespace

int main(int argc, char** argv) {
  try {
    CLI::App app("From a knitting notation to relaxed cloth", "loopwright");
    app.set_version_flag("--version", "loopwright " LOOPWRIGHT_VERSION);
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
