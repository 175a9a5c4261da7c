// What manual page and completions need to know of the options, read off the parser.
#pragma once
#include <CLI/CLI.hpp>
#include <string>
#include <vector>

namespace loopwright {

struct OptionFacts {
  std::vector<std::string> names;  // with their dashes, short ones first; none: told by its place
  std::string place;               // FILE, of an option without dashes
  std::string value;               // what follows the name, as --help has it; empty: nothing
  std::string description;
  std::vector<std::string> choices;  // the only words it takes; empty: any
  bool takes_value = false, repeats = false, required = false, names_file = false, names_folder = false;
};

struct SubcommandFacts {
  std::string name, description;
  std::vector<OptionFacts> options, places;
};

std::vector<OptionFacts> options_of(const CLI::App& app);
std::vector<SubcommandFacts> subcommands_of(const CLI::App& app);

}  // namespace loopwright
