// Named yarns: the sets of data/materials, and the `key=value` pairs with which a header states or overrides
// them.
#pragma once
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "base/diagnostics.hpp"
#include "notation/program.hpp"

namespace loopwright {

/// A yarn under its trade name. The text of data/materials/*.yarn is built into the program, so that it needs
/// no files.
struct Material {
  std::string name;                  // "wool 2/28 Nm"
  std::vector<std::string> aliases;  // other names under which it is found
  YarnData yarn;                     // yarn.material = name
  std::string text;  // the file as it stands in data/materials: says where each value comes from
};

/// All built-in materials, in the order of their file names.
std::span<const Material> materials();

/// The material of that name or alias; letter case and the number of blanks do not matter. nullptr if there
/// is none.
const Material* find_material(std::string_view name);

/// Reads the text of a .yarn file: `key = value` lines and `;` comments. What is wrong is said in
/// `diagnostics`.
Material read_material(std::string_view text, Diagnostics& diagnostics);

/// Reads a yarn header's value: the name of a material, then `key=value` pairs that override it, e.g.
/// `wool 2/28 Nm friction=0.15 colour=#b03020`. Either part may be left out. `at` is where the value starts.
/// Keys: linear-density, diameter, core-diameter, bend-stiffness, stretch-stiffness, shell-stiffness,
/// shell-exponent, friction, colour.
void read_yarn(std::string_view value, SourceLocation at, YarnData& yarn, Diagnostics& diagnostics);

/// read_yarn where the value is free text that need not be ours (knitout): fills `yarn` only if all of it is
/// understood.
bool read_yarn_if_known(std::string_view value, YarnData& yarn);

/// The value of a yarn header: the material's name, then what differs from it. read_yarn reads the same back.
std::string yarn_value(const YarnData& yarn);

/// Whether it is a colour as we write it: `#rgb` or `#rrggbb`.
bool is_colour(std::string_view text);

}  // namespace loopwright
