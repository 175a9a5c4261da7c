// The top of a knitout file: its magic line, the `;;Name: value` headers, and the carriers that they list.
#pragma once
#include <string_view>

#include "notation/knitout_report.hpp"
#include "notation/program.hpp"

namespace loopwright {

/// `;;Name: value`; a `;;` line without `: ` is a comment and ends the headers.
bool is_knitout_header(std::string_view line);

/// Fills carriers, yarns, settings, headers and version of a Program.
class KnitoutHeaders {
 public:
  KnitoutHeaders(Program& program, KnitoutReport& report) : program_(program), report_(report) {}

  /// False, and said, if the line is not `;!knitout-N`: it may be a header or an operation then.
  bool read_magic(std::string_view line);
  void read(std::string_view line);
  /// When the body starts: a missing Carriers header, and what Yarn- headers say of the carriers.
  void end();
  /// A header line after the headers have ended counts for nothing: said of those that look meant.
  void meet_late(std::string_view line);
  /// Whether a Carriers header lists the carriers; if not, each is known from its first use on.
  bool list_carriers() const { return list_carriers_; }

 private:
  void read_gauge(std::string_view value, int column);
  void read_carriers(std::string_view value, int column);
  bool declare_carrier(std::string_view name, int column);

  Program& program_;
  KnitoutReport& report_;
  bool list_carriers_ = false, said_late_ = false;
};

/// Place of a carrier in Program::carriers, or none.
CarrierId carrier_named(const Program& program, std::string_view name);
/// Bytes that no name may hold, line ends and other control characters: they would not survive writing.
bool holds_control_byte(std::string_view name);

}  // namespace loopwright
