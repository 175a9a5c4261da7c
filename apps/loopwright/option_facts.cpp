#include "option_facts.hpp"

#include <algorithm>
#include <array>
#include <string_view>

namespace loopwright {
namespace {

// CLI11 puts a choice of words into the name of the type: TEXT:{front,back}.
std::vector<std::string> choices_in(const std::string& type) {
  const std::size_t open = type.find('{'), close = type.find('}', open);
  if (open == std::string::npos || close == std::string::npos) return {};
  return CLI::detail::split(type.substr(open + 1, close - open - 1), ',');
}

// "TEXT:{front,back}" and "INT:INT in [1 - 64]" say twice what they are.
std::string said_once(const std::string& value) {
  const std::size_t colon = value.find(':');
  if (colon == std::string::npos) return value;
  const std::string type = value.substr(0, colon), rest = value.substr(colon + 1);
  return rest.starts_with('{') || rest.starts_with(type) ? rest : value;
}

OptionFacts facts_of(const CLI::Option& option, const CLI::Formatter& formatter) {
  OptionFacts facts;
  for (const std::string& name : option.get_snames()) facts.names.push_back('-' + name);
  for (const std::string& name : option.get_lnames()) facts.names.push_back("--" + name);
  if (!option.nonpositional()) facts.place = option.get_name(true, false);
  facts.description = option.get_description();
  facts.takes_value = option.get_items_expected_max() > 0;  // a flag: 0
  facts.repeats = option.get_expected_max() >= CLI::detail::expected_max_vector_size;
  facts.required = option.get_required();
  if (!facts.takes_value) return facts;
  facts.value = said_once(CLI::detail::trim_copy(formatter.make_option_opts(&option)));
  facts.choices = choices_in(option.get_type_name());
  // the words for files that the command's help uses
  constexpr std::array<std::string_view, 5> files{"FILE", "OUT", "SVG", "PNG", "STATE"};
  const std::string type = facts.place.empty() ? option.get_type_name() : facts.place;
  facts.names_file = std::find(files.begin(), files.end(), type) != files.end();
  facts.names_folder = type == "DIR";
  return facts;
}

}  // namespace

std::vector<OptionFacts> options_of(const CLI::App& app) {
  const CLI::Formatter formatter;
  std::vector<OptionFacts> all;
  for (const CLI::Option* option : app.get_options()) all.push_back(facts_of(*option, formatter));
  return all;
}

std::vector<SubcommandFacts> subcommands_of(const CLI::App& app) {
  std::vector<SubcommandFacts> all;
  for (const CLI::App* subcommand : app.get_subcommands([](const CLI::App*) { return true; })) {
    SubcommandFacts facts{subcommand->get_name(), subcommand->get_description(), {}, {}};
    for (OptionFacts& option : options_of(*subcommand)) {
      (option.place.empty() ? facts.options : facts.places).push_back(std::move(option));
    }
    all.push_back(std::move(facts));
  }
  return all;
}

}  // namespace loopwright
