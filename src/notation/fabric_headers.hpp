// The headers of a fabric file that fill FabricSettings. A knitout file carries the same ones as `X-...`.
#pragma once
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "base/diagnostics.hpp"
#include "notation/program.hpp"

namespace loopwright {

inline constexpr int largest_size = 10'000;  // wales or courses of ;;Size

/// Whether `name` is one of Name, Gauge, Bed-Gap, Loop-Length, Tuck-Length, Float-Slack, Bed-Change, Set,
/// Size, Edges.
bool is_fabric_header(std::string_view name);

/// Reads the value of such a header into `settings`; `at` is where the value starts. A value that is wrong is
/// said in `diagnostics` and leaves the setting as it was.
void read_fabric_header(std::string_view name, std::string_view value, SourceLocation at,
                        FabricSettings& settings, Diagnostics& diagnostics);

/// The names that is_fabric_header knows, in the order in which a file is written.
std::span<const std::string_view> fabric_headers();

/// What such a header says of `settings`, read back by read_fabric_header to the same bits; empty if they say
/// nothing.
std::string fabric_header_value(std::string_view name, const FabricSettings& settings);

/// `held`, `bound-off`, `free`, `periodic`.
std::optional<Edges> parsed_edges(std::string_view text);
std::string_view to_string(Edges edges);

}  // namespace loopwright
