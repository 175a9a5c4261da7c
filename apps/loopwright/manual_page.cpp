#include <string_view>

#include "option_facts.hpp"
#include "self_description.hpp"

namespace loopwright {
namespace {

// Text for roff: a hyphen would become a typographic one, a backslash or a dot at the start of a line a
// command.
std::string roff(std::string_view text) {
  std::string out;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const bool starts_line = i == 0 || text[i - 1] == '\n';
    if (starts_line && (text[i] == '.' || text[i] == '\'')) out += "\\&";
    if (text[i] == '\\') {
      out += "\\e";
    } else if (text[i] == '-') {
      out += "\\-";
    } else if (text[i] == '\n') {
      out += "\n.br\n";
    } else {
      out += text[i];
    }
  }
  return out;
}

std::string bold(std::string_view text) { return "\\fB" + roff(text) + "\\fR"; }
std::string italic(std::string_view text) { return "\\fI" + roff(text) + "\\fR"; }

// "-o, --out OUT" and below it what it is for.
std::string paragraph(const OptionFacts& option) {
  std::string names;
  for (const std::string& name : option.names) names += (names.empty() ? "" : ", ") + bold(name);
  if (names.empty()) names = italic(option.place + (option.repeats ? "..." : ""));
  // of what is told by its place the type says nothing more, unless it is a choice of words
  if (!option.value.empty() && (option.place.empty() || !option.choices.empty()))
    names += ' ' + italic(option.value);
  return ".TP\n" + names + '\n' + roff(option.description) + '\n';
}

std::string synopsis(const SubcommandFacts& subcommand) {
  std::string line = bold("loopwright " + subcommand.name);
  for (const OptionFacts& option : subcommand.options) {
    if (option.required)
      line += ' ' + bold(option.names.front()) + ' ' + italic(option.value.substr(0, option.value.find(' ')));
  }
  line += " [" + italic("OPTION") + "]...";
  for (const OptionFacts& place : subcommand.places) {
    line += ' ' + italic(place.place) + (place.repeats ? "..." : "");
  }
  return line + "\n.br\n";
}

// What no option says. The example lines stand in README.md too, where a test runs them.
constexpr std::string_view about = R"(.SH DESCRIPTION
.B loopwright
reads a knitting programme, a fabric file in vermiculation letters (.verm) or a knitout file (.k, .knitout), does one
stretch of the road to relaxed cloth and writes what it found: every yarn in three dimensions, in mechanical equilibrium,
with its sizes, forces and pictures.
.PP
Without an option a fabric file gives what its header Edges says and a knitout file the whole piece. The suffix of an
output file chooses its format. A file appears under its name only when it is complete. Every physical number carries
its unit in its key.
)";
constexpr std::string_view closing = R"(.SH EXIT STATUS
.TP
.B 0
Done.
.TP
.B 1
An error; what is wrong is said on standard error and nothing half\-written is left.
.TP
.B 130
Stopped by Ctrl\-C; what was reached is written, and the command says how to go on.
.SH EXAMPLES
.EX
loopwright check examples/swatch.k
loopwright relax examples/structures/rib.verm \-o rib.h5 \-\-periodic \-\-json \- \-\-render rib.png
loopwright measure rib.h5
loopwright stretch examples/acrylic_jersey.verm \-\-periodic \-\-to 0.2 \-\-csv plain.csv
.EE
.SH SEE ALSO
The manual in the folder docs of the source, installed as /usr/share/doc/loopwright/manual.
)";

}  // namespace

std::string manual_page(const CLI::App& app, const std::string& version) {
  std::string page =
      ".\\\" Printed by `loopwright manual`.\n.TH LOOPWRIGHT 1 \"\" \"loopwright " + roff(version) +
      "\" \"User Commands\"\n.SH NAME\nloopwright \\- from a knitting notation to relaxed cloth\n" +
      ".SH SYNOPSIS\n.nh\n.ad l\n";
  const std::vector<SubcommandFacts> subcommands = subcommands_of(app);
  for (const SubcommandFacts& subcommand : subcommands) page += synopsis(subcommand);
  page += ".ad b\n.hy\n";
  page += about;
  page += ".SH OPTIONS\n";
  for (const OptionFacts& option : options_of(app)) page += paragraph(option);
  page += ".SH COMMANDS\n";
  for (const SubcommandFacts& subcommand : subcommands) {
    page += ".SS loopwright " + roff(subcommand.name) + '\n' + roff(subcommand.description) + ".\n";
    for (const OptionFacts& place : subcommand.places) page += paragraph(place);
    for (const OptionFacts& option : subcommand.options) page += paragraph(option);
  }
  page += closing;
  return page;
}

}  // namespace loopwright
