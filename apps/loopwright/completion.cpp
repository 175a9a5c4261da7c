#include <string_view>

#include "option_facts.hpp"
#include "self_description.hpp"

namespace loopwright {
namespace {

std::string joined(const std::vector<std::string>& words, std::string_view between) {
  std::string out;
  for (const std::string& word : words) (out += out.empty() ? "" : between) += word;
  return out;
}

std::vector<std::string> names_of(const std::vector<OptionFacts>& options) {
  std::vector<std::string> names;
  for (const OptionFacts& option : options)
    names.insert(names.end(), option.names.begin(), option.names.end());
  return names;
}

// The first line of a description, with the marks of a shell's quoting escaped.
std::string brief(const std::string& description, std::string_view special) {
  std::string out;
  for (const char c : description.substr(0, description.find('\n'))) {
    if (c == '\'') {
      out += "'\\''";
    } else {
      if (special.find(c) != std::string_view::npos) out += '\\';
      out += c;
    }
  }
  return out;
}

// The subcommands' names, and arms of two `case`s: what may follow an option, and the options of a
// subcommand.
struct BashArms {
  std::string names, values, lists;
};

void add_arms(BashArms& arms, const SubcommandFacts& subcommand) {
  const std::string& name = subcommand.name;
  arms.names += (arms.names.empty() ? "" : "|") + name;
  std::string others;
  for (const OptionFacts& option : subcommand.options) {
    if (!option.takes_value) continue;
    std::vector<std::string> after;  // subcommand:option
    for (const std::string& word : option.names) after.push_back(name + ':' + word);
    const std::string keys = joined(after, "|");
    if (option.choices.empty()) {
      others += (others.empty() ? "" : "|") + keys;
    } else {
      arms.values += "    " + keys + ") words='" + joined(option.choices, " ") + "' ;;\n";
    }
  }
  if (!others.empty()) arms.values += "    " + others + ") return ;;\n";
  // what is told by its place is a file, which is left to bash, or one of some words
  std::string places;
  for (const OptionFacts& place : subcommand.places) places += joined(place.choices, " ");
  arms.lists += "        " + name + ") options='" + joined(names_of(subcommand.options), " ") + "' places='" +
                places + "' ;;\n";
}

std::string bash_script(const CLI::App& app) {
  BashArms arms;
  std::vector<std::string> first = names_of(options_of(app));
  for (const SubcommandFacts& subcommand : subcommands_of(app)) {
    add_arms(arms, subcommand);
    first.push_back(subcommand.name);
  }
  return R"(# Completes loopwright in bash. Printed by `loopwright completion bash`.
_loopwright() {
  local current=${COMP_WORDS[COMP_CWORD]} previous=${COMP_WORDS[COMP_CWORD-1]}
  local subcommand='' words='' options='' places='' i
  COMPREPLY=()
  for ((i = 1; i < COMP_CWORD; ++i)); do
    case ${COMP_WORDS[i]} in
      )" +
         arms.names + R"() subcommand=${COMP_WORDS[i]}; break ;;
    esac
  done
  # an empty answer leaves the word to bash, which completes the names of files
  case $subcommand:$previous in
)" + arms.values +
         R"(    *)
      case $subcommand in
        '') options=')" +
         joined(first, " ") + R"(' places=$options ;;
)" + arms.lists +
         R"(      esac
      if [[ $current == -* ]]; then words=$options; else words=$places; fi ;;
  esac
  COMPREPLY=($(compgen -W "$words" -- "$current" || :))
}
complete -o default -F _loopwright loopwright
)";
}

// What zsh is to offer for a value: words, files, folders or nothing.
std::string zsh_value(const OptionFacts& option) {
  if (!option.choices.empty()) return '(' + joined(option.choices, " ") + ')';
  if (option.names_folder) return "_files -/";
  return option.names_file ? "_files" : " ";
}

std::string zsh_arguments(const std::vector<OptionFacts>& options) {
  std::string out;
  for (const OptionFacts& option : options) {
    const std::string what = brief(option.description, "[]:\\");
    if (option.names.empty()) {
      out += std::string(" \\\n          '") + (option.repeats ? "*" : "1") + ':' + what + ':' +
             zsh_value(option) + '\'';
    }
    for (const std::string& name : option.names) {
      out.append(" \\\n          '").append(name).append("[").append(what).append("]");
      if (option.takes_value) out.append(":value:").append(zsh_value(option));
      out += '\'';
    }
  }
  return out;
}

std::string zsh_script(const CLI::App& app) {
  std::string described, arms;
  for (const SubcommandFacts& subcommand : subcommands_of(app)) {
    described += "    '" + subcommand.name + ':' + brief(subcommand.description, ":\\") + "'\n";
    arms += "        " + subcommand.name + ")\n          _arguments" + zsh_arguments(subcommand.options) +
            zsh_arguments(subcommand.places) + "\n          ;;\n";
  }
  return R"(#compdef loopwright
# Completes loopwright in zsh. Printed by `loopwright completion zsh`.
_loopwright() {
  local context state line
  local -a subcommands
  subcommands=(
)" + described +
         R"(  )
  _arguments -C)" +
         zsh_arguments(options_of(app)) +
         R"( \
          '1: :->subcommand' '*:: :->rest'
  case $state in
    subcommand) _describe subcommand subcommands ;;
    rest)
      case $words[1] in
)" + arms +
         R"(      esac
      ;;
  esac
}
if [ "$funcstack[1]" = _loopwright ]; then _loopwright "$@"; else compdef _loopwright loopwright; fi
)";
}

std::string fish_option(const std::string& condition, const OptionFacts& option) {
  std::string line = "complete -c loopwright -n '" + condition + '\'';
  for (const std::string& name : option.names) {
    line += name.starts_with("--") ? " -l " + name.substr(2) : " -s " + name.substr(1);
  }
  if (option.names_folder) {
    line += " -x -a '(__fish_complete_directories)'";
  } else if (option.takes_value) {
    line += option.names_file ? " -r" : " -x";
  }
  if (!option.choices.empty()) line += " -a '" + joined(option.choices, " ") + '\'';
  return line + " -d '" + brief(option.description, "\\") + "'\n";
}

std::string fish_script(const CLI::App& app) {
  std::string script = "# Completes loopwright in fish. Printed by `loopwright completion fish`.\n";
  for (const OptionFacts& option : options_of(app)) script += fish_option("__fish_use_subcommand", option);
  for (const SubcommandFacts& subcommand : subcommands_of(app)) {
    script += "complete -c loopwright -n __fish_use_subcommand -f -a " + subcommand.name + " -d '" +
              brief(subcommand.description, "\\") + "'\n";
    const std::string condition = "__fish_seen_subcommand_from " + subcommand.name;
    for (const OptionFacts& option : subcommand.options) script += fish_option(condition, option);
    for (const OptionFacts& place : subcommand.places) {
      if (!place.choices.empty()) script += fish_option(condition, place);
    }
  }
  return script;
}

}  // namespace

std::string completion_script(const CLI::App& app, const std::string& shell) {
  if (shell == "bash") return bash_script(app);
  return shell == "zsh" ? zsh_script(app) : fish_script(app);
}

}  // namespace loopwright
