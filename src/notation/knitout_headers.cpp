#include "notation/knitout_headers.hpp"

#include <algorithm>
#include <array>
#include <limits>

#include "notation/fabric_headers.hpp"
#include "notation/material.hpp"
#include "notation/read_knitout.hpp"
#include "notation/scan.hpp"

namespace loopwright {
namespace {

constexpr std::string_view magic = ";!knitout-";

// Those of the specification, and two that converters read (bed width, fabric presser).
constexpr std::array<std::string_view, 6> known_headers{"Carriers", "Machine", "Gauge",
                                                        "Position", "Width",   "Presser"};

bool is_known_header(std::string_view name) {
  return std::find(known_headers.begin(), known_headers.end(), name) != known_headers.end();
}

// The version: any whole number, however large; nothing for anything else.
std::optional<int> parsed_version(std::string_view text) {
  const bool digits = !text.empty() && std::all_of(text.begin(), text.end(), is_digit);
  if (!digits) return std::nullopt;
  return parsed_integer(text).value_or(std::numeric_limits<int>::max());
}

}  // namespace

CarrierId carrier_named(const Program& program, std::string_view name) {
  const auto found = std::find(program.carriers.begin(), program.carriers.end(), name);
  return found == program.carriers.end() ? CarrierId()
                                         : CarrierId(std::size_t(found - program.carriers.begin()));
}

bool holds_control_byte(std::string_view name) {
  return std::any_of(name.begin(), name.end(), [](char c) {
    const auto byte = static_cast<unsigned char>(c);
    return byte < 32 || byte == 127;
  });
}

bool is_knitout_header(std::string_view line) {
  const std::size_t colon = line.find(": ");
  return line.starts_with(";;") && colon != std::string_view::npos && colon > 2;
}

bool KnitoutHeaders::read_magic(std::string_view line) {
  int before = 0;  // bytes of a byte-order mark
  if (line.starts_with("\xef\xbb\xbf")) {
    report_.error(
        1,
        "the file starts with a byte-order mark, and nothing may stand before ';!knitout-2'; save it "
        "as UTF-8 without one");
    line.remove_prefix(3);
    before = 3;
  }
  if (!line.starts_with(magic)) {
    report_.error(before + 1, "the first line is not ';!knitout-2' but " + quoted(line) +
                                  "; put ';!knitout-2' before everything");
    return false;
  }
  const int column = before + static_cast<int>(magic.size()) + 1;
  const std::string_view text = trimmed(line.substr(magic.size()));
  const auto version = parsed_version(text);
  if (!version) {
    report_.error(column,
                  "expected a whole number as version, not " + quoted(text) + "; write ';!knitout-2'");
    return true;
  }
  // readers compare the whole line
  if (text.size() != line.size() - magic.size()) {
    const bool after = line.substr(magic.size()).starts_with(text);
    report_.error(column + (after ? static_cast<int>(text.size()) : 0),
                  "a blank in the first line, which is ';!knitout-2' and nothing else; remove it");
  }
  program_.version = *version;
  if (*version > 2) {
    report_.warning(column, "version " + std::string(text.substr(0, 20)) +
                                " is newer than 2, the newest known; it is read as version 2");
  }
  return true;
}

void KnitoutHeaders::read(std::string_view line) {
  const std::size_t colon = line.find(": ");
  const std::string_view name = line.substr(2, colon - 2);
  const std::string_view value = trimmed(line.substr(colon + 2));
  const int column = static_cast<int>(colon) + 3;
  const auto same = [&](const auto& header) { return header.first == name; };
  if (program_.headers.size() < 1000) {
    if (std::any_of(program_.headers.begin(), program_.headers.end(), same)) {
      report_.warning(
          3, "header " + quoted(name) + " is given a second time; the last one counts, remove the others");
    }
    program_.headers.emplace_back(name, value);
  }
  if (name == "Carriers") {
    read_carriers(value, column);
  } else if (name == "Gauge") {
    read_gauge(value, column);
  } else if (name == "Position" && value != "Left" && value != "Center" && value != "Right" &&
             value != "Keep") {
    report_.warning(column, "the position is Left, Center, Right or Keep, not " + quoted(value));
  } else if (name.starts_with("X-")) {
    // our own settings travel in X- headers, so that a fabric file written as knitout keeps them
    if (is_fabric_header(name.substr(2)))
      read_fabric_header(name.substr(2), value, {report_.line, column}, program_.settings,
                         report_.diagnostics);
  } else if (!name.starts_with("Yarn-") && !is_known_header(name)) {
    const std::string_view meant = word_meant(name, known_headers);
    report_.warning(
        3, "unknown header " + quoted(name) + " is left out; " +
               (meant.empty() ? "own headers start with 'X-'" : "write '" + std::string(meant) + "'"));
  }
}

void KnitoutHeaders::read_gauge(std::string_view value, int column) {
  const Quantity gauge = parsed_quantity(value, Dimension::gauge);
  if (gauge.problem.empty() && gauge.value > 0)
    program_.settings.gauge_npi = gauge.value;
  else
    report_.warning(
        column, "the gauge is not understood and left out: " + quoted(value) + "; write needles per inch");
}

// Rails front to back, blank-separated; `L1,L2;R1,R2` names several carriers of one rail.
void KnitoutHeaders::read_carriers(std::string_view value, int column) {
  list_carriers_ = true;
  program_.carriers.clear();
  std::size_t at = 0;
  while (at < value.size()) {
    const std::size_t end = std::min(value.find_first_of(" \t,;", at), value.size());
    if (end > at && !declare_carrier(value.substr(at, end - at), column + static_cast<int>(at))) return;
    at = end + 1;
  }
  if (program_.carriers.empty())
    report_.error(column, "the Carriers header names no carrier; list them front to back");
}

bool KnitoutHeaders::declare_carrier(std::string_view name, int column) {
  if (holds_control_byte(name)) {
    report_.error(column, "carrier name " + quoted(name) + " holds a control character; remove it");
  } else if (carrier_named(program_, name).valid()) {
    report_.error(column, "carrier " + quoted(name) + " is listed twice; name each carrier once");
  } else if (program_.carriers.size() == most_carriers) {
    report_.error(column, "more than " + std::to_string(most_carriers) + " carriers; the rest is left out");
    return false;
  } else {
    program_.carriers.emplace_back(name);
  }
  return true;
}

void KnitoutHeaders::end() {
  if (!list_carriers_) {
    // writers must give it, readers only warn: so says the specification
    report_.diagnostics.warning({},
                                "the Carriers header is missing, so no carrier name can be checked; add "
                                "e.g. ';;Carriers: 1 2 3' after the first line");
  }
  program_.yarns.resize(program_.carriers.size());
  for (const auto& [name, value] : program_.headers) {
    if (!name.starts_with("Yarn-")) continue;
    const CarrierId id = carrier_named(program_, std::string_view(name).substr(5));
    // the value is free text in knitout; it counts where it names a material of ours
    if (id.valid()) read_yarn_if_known(value, program_.yarns[id.position()]);
  }
}

void KnitoutHeaders::meet_late(std::string_view line) {
  // `;;Carriers:1 2`: a comment, since no blank follows the colon
  const std::size_t colon = line.find(':');
  if (!said_late_ && line.starts_with(";;") && colon != std::string_view::npos && !is_knitout_header(line) &&
      is_known_header(line.substr(2, colon - 2))) {
    said_late_ = true;
    report_.warning(static_cast<int>(colon) + 2,
                    "a blank is missing after the colon, so the line counts as a comment; write ';;" +
                        std::string(line.substr(2, colon - 2)) + ": ...'");
  }
  if (said_late_ || !is_knitout_header(line)) return;
  const std::string_view name = line.substr(2, line.find(": ") - 2);
  if (!is_known_header(name) && !name.starts_with("Yarn-")) return;
  said_late_ = true;
  report_.warning(1, "header " + quoted(name) +
                         " comes after the headers have ended and counts as a comment; put it straight "
                         "after the first line");
}

}  // namespace loopwright
