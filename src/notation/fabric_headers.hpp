// The headers of a fabric file that fill FabricSettings. A knitout file carries the same ones as `X-...`.
#pragma once
#include <optional>
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

/// `held`, `bound-off`, `free`, `periodic`.
std::optional<Edges> parsed_edges(std::string_view text);
std::string_view to_string(Edges edges);

}  // namespace loopwright
