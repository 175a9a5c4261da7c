#include "self_description.hpp"

#include <iostream>
#include <memory>

#include "build_facts.hpp"
#include "commands.hpp"
#include "option_facts.hpp"
#include "outputs/atomic_file.hpp"

namespace loopwright {
namespace {

// What the three subcommands are asked for; lives as long as the parser.
struct Requests {
  std::string page = "-", script = "-", shell, json;
};

std::string version_text() { return text_of(build_facts()) + "\ncommand line: CLI11 " CLI11_VERSION; }

int write_text(const std::string& file, const std::string& text) {
  if (file == "-") {
    std::cout << text;
    return exit_good;
  }
  AtomicFile out(file);
  out.stream() << text;
  out.commit();
  return exit_good;
}

int say_version(const std::string& json) {
  if (json != "-") std::cout << version_text() << '\n';
  if (!json.empty()) write_json(json, json_of(build_facts()));
  return exit_good;
}

CLI::Option* add_out(CLI::App& command, std::string& out) {
  return command.add_option("-o,--out", out, "Where to write it, - for standard output")
      ->type_name("FILE")
      ->capture_default_str();
}

}  // namespace

void add_self_description(CLI::App& app, std::function<int()>& action) {
  const auto requests = std::make_shared<Requests>();
  app.set_version_flag("--version", version_text, "Print the version and how this binary was built");

  CLI::App* version = app.add_subcommand("version", "Print the version and how this binary was built");
  version->add_option("--json", requests->json, "Write it as JSON to a file, - for standard output")
      ->type_name("FILE");
  version->callback([&action, requests] { action = [requests] { return say_version(requests->json); }; });

  CLI::App* manual = app.add_subcommand("manual", "Print the manual page, for man");
  add_out(*manual, requests->page);
  manual->callback([&app, &action, requests] {
    action = [&app, requests] { return write_text(requests->page, manual_page(app, build_facts().version)); };
  });

  CLI::App* completion =
      app.add_subcommand("completion", "Print the script that completes this command in a shell");
  completion->add_option("SHELL", requests->shell, "The shell")
      ->required()
      ->check(CLI::IsMember({"bash", "zsh", "fish"}));
  add_out(*completion, requests->script);
  completion->callback([&app, &action, requests] {
    action = [&app, requests] {
      return write_text(requests->script, completion_script(app, requests->shell));
    };
  });
}

}  // namespace loopwright
