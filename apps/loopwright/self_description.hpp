// What the command says of itself beside --help: a manual page and completions for shells. All three are read
// off the options that the command understands, so that none can name one that is not there or forget one.
#pragma once
#include <functional>
#include <string>

namespace CLI {  // NOLINT(readability-identifier-naming): CLI11's own name
class App;
}

namespace loopwright {

// The manual page loopwright(1) in roff with the man macros; `version` is named in its footer.
std::string manual_page(const CLI::App& app, const std::string& version);

// A script for "bash", "zsh" or "fish" that completes subcommands, options and the words an option allows.
std::string completion_script(const CLI::App& app, const std::string& shell);

// The subcommands manual, completion and version, and --version.
void add_self_description(CLI::App& app, std::function<int()>& action);

}  // namespace loopwright
