#include "notation/material.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "notation/embedded_materials.hpp"
#include "notation/scan.hpp"

namespace loopwright {
namespace {

struct YarnKey {
  std::string_view name;
  std::optional<double> YarnData::*value;
  Dimension dimension;
  std::string_view unit;  // as it is written behind a number
};
constexpr std::array yarn_keys{
    YarnKey{"linear-density", &YarnData::linear_density_tex, Dimension::linear_density, " tex"},
    YarnKey{"diameter", &YarnData::diameter_mm, Dimension::length, " mm"},
    YarnKey{"core-diameter", &YarnData::core_diameter_mm, Dimension::length, " mm"},
    YarnKey{"bend-stiffness", &YarnData::bend_stiffness_mN_mm2, Dimension::bend_stiffness, " mN mm^2"},
    YarnKey{"stretch-stiffness", &YarnData::stretch_stiffness_cN, Dimension::force, " cN"},
    YarnKey{"twist-stiffness", &YarnData::twist_stiffness_mN_mm2, Dimension::bend_stiffness, " mN mm^2"},
    YarnKey{"liveliness", &YarnData::liveliness_per_m, Dimension::twist, " tpm"},
    YarnKey{"shell-stiffness", &YarnData::shell_stiffness, Dimension::shell_stiffness, " N/mm^3"},
    YarnKey{"shell-exponent", &YarnData::shell_exponent, Dimension::share, ""},
    YarnKey{"friction", &YarnData::friction_coefficient, Dimension::share, ""},
};

constexpr double most_turns_per_m = 1e5;

std::string known_keys() {
  std::string names;
  for (const YarnKey& key : yarn_keys) names += std::string(key.name) + ", ";
  return names + "colour";
}

SourceLocation moved(SourceLocation at, std::size_t columns) {
  return {at.line, at.column + static_cast<int>(columns)};
}

// Sets one value of a yarn; `at` is the place of the value.
void set_yarn_value(std::string_view name, std::string_view value, SourceLocation key_at, SourceLocation at,
                    YarnData& yarn, Diagnostics& diagnostics) {
  if (name == "colour" || name == "color") {
    if (is_colour(value))
      yarn.colour = value;
    else
      diagnostics.error(at, "expected a colour such as #b03020, not " + quoted(value));
    return;
  }
  for (const YarnKey& key : yarn_keys) {
    if (key.name != name) continue;
    const Quantity quantity = parsed_quantity(value, key.dimension);
    if (!quantity.problem.empty()) {
      diagnostics.error(at, quantity.problem);
    } else if (key.dimension == Dimension::twist && std::abs(quantity.value) > most_turns_per_m) {
      diagnostics.error(at, std::string(name) + " can be 100000 tpm at most, not " + quoted(value));
    } else if (key.dimension != Dimension::twist &&
               (quantity.value < 0 || (quantity.value == 0 && name != "friction"))) {
      diagnostics.error(at, std::string(name) + " must be greater than zero, not " + quoted(value));
    } else {
      yarn.*key.value = quantity.value;
    }
    return;
  }
  diagnostics.error(key_at, "unknown yarn key " + quoted(name) + "; known are " + known_keys());
}

void check_diameters(const YarnData& yarn, SourceLocation at, Diagnostics& diagnostics) {
  if (yarn.diameter_mm && yarn.core_diameter_mm && *yarn.core_diameter_mm > *yarn.diameter_mm) {
    diagnostics.error(at,
                      "the core diameter is greater than the diameter; the core lies inside, give it less");
  }
}

// Lower case, blanks joined: what names are compared by.
std::string comparable(std::string_view name) {
  std::string result;
  WordReader words(name);
  Word word;
  while (words.next(word)) {
    if (!result.empty()) result += ' ';
    result += lower_case(word.text);
  }
  return result;
}

std::vector<Material> built_in_materials() {
  std::vector<Material> list;
  for (const EmbeddedFile& file : embedded_materials()) {
    Diagnostics diagnostics{std::string(file.name)};
    list.push_back(read_material(file.text, diagnostics));
    list.back().text = file.text;
  }
  return list;
}

}  // namespace

bool is_colour(std::string_view text) {
  return (text.size() == 7 || text.size() == 4) && text.front() == '#' &&
         text.find_first_not_of("0123456789abcdefABCDEF", 1) == std::string_view::npos;
}

std::span<const Material> materials() {
  static const std::vector<Material> list = built_in_materials();
  return list;
}

const Material* find_material(std::string_view name) {
  if (name.size() > 200) return nullptr;
  const std::string wanted = comparable(name);
  for (const Material& material : materials()) {
    if (comparable(material.name) == wanted) return &material;
    for (const std::string& alias : material.aliases) {
      if (comparable(alias) == wanted) return &material;
    }
  }
  return nullptr;
}

Material read_material(std::string_view text, Diagnostics& diagnostics) {
  Material material;
  LineReader lines(text);
  TextLine line;
  while (lines.next(line)) {
    const std::string_view content = line.text.substr(0, line.text.find(';'));
    if (trimmed(content).empty()) continue;
    const std::size_t equals = content.find('=');
    const SourceLocation at{line.number, 1};
    if (equals == std::string_view::npos) {
      diagnostics.error(at, "expected 'key = value', not " + quoted(content));
      continue;
    }
    const std::string_view key = trimmed(content.substr(0, equals));
    const std::string_view value = trimmed(content.substr(equals + 1));
    if (key == "name")
      material.name = value;
    else if (key == "alias")
      material.aliases.emplace_back(value);
    else
      set_yarn_value(key, value, at, moved(at, equals + 1), material.yarn, diagnostics);
  }
  if (material.name.empty()) diagnostics.error({}, "the material has no name; add 'name = ...'");
  check_diameters(material.yarn, {}, diagnostics);
  material.yarn.material = material.name;
  return material;
}

void read_yarn(std::string_view value, SourceLocation at, YarnData& yarn, Diagnostics& diagnostics) {
  constexpr std::size_t longest = 2000;
  if (value.size() > longest) {
    diagnostics.error(at, "a yarn is told in at most " + std::to_string(longest) + " bytes");
    return;
  }
  // The name ends and a value ends where the next word with a '=' in it starts.
  struct Part {
    std::size_t begin, equals, end;
  };
  std::vector<Part> parts;
  std::size_t name_end = value.size();
  for (std::size_t equals = value.find('='); equals != std::string_view::npos;
       equals = value.find('=', equals + 1)) {
    std::size_t begin = equals;
    while (begin > 0 && is_blank(value[begin - 1])) --begin;  // `key = value` is as good as `key=value`
    while (begin > 0 && !is_blank(value[begin - 1]) && value[begin - 1] != ',') --begin;
    if (parts.empty())
      name_end = begin;
    else
      parts.back().end = std::max(begin, parts.back().equals + 1);
    parts.push_back({begin, equals, value.size()});
  }
  const std::string_view name = trimmed(value.substr(0, name_end));
  if (!name.empty()) {
    if (const Material* material = find_material(name)) {
      yarn = material->yarn;
    } else {
      std::string known;
      for (const Material& each : materials()) known += (known.empty() ? "'" : ", '") + each.name + "'";
      diagnostics.error(at, "unknown material " + quoted(name) + "; known are " + known +
                                ", or give the yarn by key=value pairs: " + known_keys());
    }
  }
  for (const Part& part : parts) {
    std::string_view text = trimmed(value.substr(part.equals + 1, part.end - part.equals - 1));
    while (text.ends_with(',')) text = trimmed(text.substr(0, text.size() - 1));
    set_yarn_value(trimmed(value.substr(part.begin, part.equals - part.begin)), text, moved(at, part.begin),
                   moved(at, part.equals + 1), yarn, diagnostics);
  }
  check_diameters(yarn, at, diagnostics);
}

std::string yarn_value(const YarnData& yarn) {
  const Material* material = find_material(yarn.material);
  const YarnData base = material ? material->yarn : YarnData{};
  std::string value = base.material;
  const auto add = [&](std::string_view key, const std::string& written) {
    value += (value.empty() ? "" : " ") + std::string(key) + '=' + written;
  };
  for (const YarnKey& key : yarn_keys) {
    const std::optional<double>& number = yarn.*key.value;
    if (number && number != base.*key.value) add(key.name, written_number(*number) + std::string(key.unit));
  }
  if (yarn.colour != base.colour) add("colour", yarn.colour);
  return value;
}

bool read_yarn_if_known(std::string_view value, YarnData& yarn) {
  Diagnostics diagnostics;
  YarnData read;
  read_yarn(value, {}, read, diagnostics);
  if (!diagnostics.ok()) return false;
  yarn = std::move(read);
  return true;
}

}  // namespace loopwright
