#include "notation/fabric_headers.hpp"

#include <array>

#include "notation/scan.hpp"

namespace loopwright {
namespace {

struct NumberHeader {
  std::string_view name;
  std::optional<double> FabricSettings::*value;
  Dimension dimension;
  double least, most;  // least is allowed only where it is 0 and `zero_allowed`
  bool zero_allowed;
};
constexpr std::array number_headers{
    NumberHeader{"Gauge", &FabricSettings::gauge_npi, Dimension::gauge, 0, 100, false},
    NumberHeader{"Bed-Gap", &FabricSettings::bed_gap_mm, Dimension::length, 0, 1000, true},
    NumberHeader{"Loop-Length", &FabricSettings::loop_length_mm, Dimension::length, 0, 1000, false},
    NumberHeader{"Tuck-Length", &FabricSettings::tuck_length_mm, Dimension::length, 0, 1000, false},
    NumberHeader{"Float-Slack", &FabricSettings::float_slack, Dimension::share, 0, 10, true},
    NumberHeader{"Bed-Change", &FabricSettings::bed_change_mm, Dimension::length, 0, 1000, true},
};
constexpr std::array<std::string_view, 4> edge_names{"held", "bound-off", "free", "periodic"};

std::string number_text(double value) {
  const long long whole = static_cast<long long>(value);
  return std::to_string(whole);
}

void read_set(std::string_view value, SourceLocation at, FabricSettings& settings, Diagnostics& diagnostics) {
  const Quantity set = parsed_quantity(value, Dimension::share);
  if (!set.problem.empty()) {
    diagnostics.error(at, set.problem);
  } else if (set.value < 0 || set.value > 1) {
    diagnostics.error(at, "Set is a share from 0 (straight yarn) to 1 (fully set), not " + quoted(value));
  } else {
    settings.set = set.value;
  }
}

// `24 wales x 16 courses`, in either order, or `24 x 16` (wales first).
void read_size(std::string_view value, SourceLocation at, FabricSettings& settings,
               Diagnostics& diagnostics) {
  const auto wrong = [&](std::string_view text, std::size_t column, const std::string& what) {
    diagnostics.error({at.line, at.column + static_cast<int>(column)},
                      what + ", not " + quoted(text) + "; write e.g. '24 wales x 16 courses'");
  };
  int numbers[2] = {0, 0};
  int is_courses[2] = {-1, -1};
  std::size_t column = 0;
  for (int side = 0; side < 2; ++side) {
    while (column < value.size() && is_blank(value[column])) ++column;
    std::size_t end = column;
    while (end < value.size() && (is_digit(value[end]) || value[end] == '-' || value[end] == '+')) ++end;
    const std::string_view digits = value.substr(column, end - column);
    const auto number = parsed_integer(digits);
    const bool huge = !number && !digits.empty() && digits.find_first_not_of("0123456789") == digits.npos;
    if (!number && !huge) return wrong(value.substr(column), column, "expected a number of wales or courses");
    if (huge || *number > largest_size) {
      return wrong(digits, column, "a size is at most " + std::to_string(largest_size));
    }
    if (*number < 1) return wrong(digits, column, "a size is at least 1");
    numbers[side] = *number;
    column = end;
    while (column < value.size() && is_blank(value[column])) ++column;
    end = column;
    while (end < value.size() && is_letter(value[end])) ++end;
    const std::string word = lower_case(value.substr(column, std::min<std::size_t>(end - column, 20)));
    if (word == "wale" || word == "wales")
      is_courses[side] = 0;
    else if (word == "course" || word == "courses")
      is_courses[side] = 1;
    else
      end = column;
    column = end;
    while (column < value.size() && is_blank(value[column])) ++column;
    if (side == 1) break;
    if (column == value.size() || value[column] != 'x')
      return wrong(value.substr(column), column, "expected 'x'");
    ++column;
  }
  if (column != value.size()) return wrong(value.substr(column), column, "expected the end of the size");
  if ((is_courses[0] < 0) != (is_courses[1] < 0) || (is_courses[0] >= 0 && is_courses[0] == is_courses[1])) {
    return wrong(value, 0, "a size names wales and courses once each");
  }
  const bool swapped = is_courses[0] == 1;
  settings.size_wales = numbers[swapped ? 1 : 0];
  settings.size_courses = numbers[swapped ? 0 : 1];
}

}  // namespace

bool is_fabric_header(std::string_view name) {
  for (const NumberHeader& header : number_headers) {
    if (header.name == name) return true;
  }
  return name == "Name" || name == "Set" || name == "Size" || name == "Edges";
}

std::span<const std::string_view> fabric_headers() {
  static constexpr std::array<std::string_view, 10> names{
      "Name",        "Gauge",      "Bed-Gap", "Loop-Length", "Tuck-Length",
      "Float-Slack", "Bed-Change", "Set",     "Size",        "Edges"};
  return names;
}

std::string fabric_header_value(std::string_view name, const FabricSettings& settings) {
  if (name == "Name") return settings.name;
  if (name == "Edges") return settings.edges ? std::string(to_string(*settings.edges)) : "";
  if (name == "Set") return settings.set != 0 ? written_number(settings.set) : "";
  if (name == "Size" && settings.size_wales > 0 && settings.size_courses > 0)
    return std::to_string(settings.size_wales) + " wales x " + std::to_string(settings.size_courses) +
           " courses";
  for (const NumberHeader& header : number_headers) {
    if (header.name == name && settings.*header.value)
      return written_number(*(settings.*header.value)) + (header.dimension == Dimension::length ? " mm" : "");
  }
  return {};
}

std::optional<Edges> parsed_edges(std::string_view text) {
  for (std::size_t i = 0; i < edge_names.size(); ++i) {
    if (edge_names[i] == text) return static_cast<Edges>(i);
  }
  return std::nullopt;
}

std::string_view to_string(Edges edges) { return edge_names[static_cast<std::size_t>(edges)]; }

void read_fabric_header(std::string_view name, std::string_view value, SourceLocation at,
                        FabricSettings& settings, Diagnostics& diagnostics) {
  if (name == "Name") {
    settings.name = value;
  } else if (name == "Set") {
    read_set(value, at, settings, diagnostics);
  } else if (name == "Size") {
    read_size(value, at, settings, diagnostics);
  } else if (name == "Edges") {
    if (const auto edges = parsed_edges(value))
      settings.edges = *edges;
    else
      diagnostics.error(at, "edges are held, bound-off, free or periodic, not " + quoted(value));
  }
  for (const NumberHeader& header : number_headers) {
    if (header.name != name) continue;
    const Quantity quantity = parsed_quantity(value, header.dimension);
    if (!quantity.problem.empty()) {
      diagnostics.error(at, quantity.problem);
    } else if (quantity.value < header.least || quantity.value > header.most ||
               (quantity.value == 0 && !header.zero_allowed)) {
      diagnostics.error(at,
                        std::string(name) +
                            (header.zero_allowed ? " must not be less than 0 " : " must be greater than 0 ") +
                            "nor greater than " + number_text(header.most) + ", not " + quoted(value));
    } else {
      settings.*header.value = quantity.value;
    }
  }
}

}  // namespace loopwright
