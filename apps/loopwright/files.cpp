#include "files.hpp"

#include <charconv>
#include <filesystem>
#include <iostream>
#include <sstream>
#include <stdexcept>
#include <tuple>

#include "experiments/modes.hpp"
#include "notation/read_program.hpp"
#include "notation/scan.hpp"
#include "outputs/atomic_file.hpp"
#include "outputs/exchange/curve_file.hpp"
#include "outputs/state.hpp"
#include "outputs/write_fabric.hpp"

namespace loopwright {
namespace {

std::optional<int> parsed_pixels(std::string_view text) {
  int value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return value;
}

// Curves of another program. What was not said and had to be found is told.
std::optional<Piece> read_curves(const std::string& file, const PieceRequest& request) {
  if (request.periodic || request.window)
    throw std::invalid_argument(file + ": curves are one piece; a window or cell is taken of a notation");
  Diagnostics diagnostics("--yarn");
  std::optional<Piece> piece;
  try {
    const ImportedCurves imported = import_curves(file, request, diagnostics);
    if (diagnostics.ok()) {
      const Fabric& fabric = imported.curves.fabric;
      std::ostringstream line;
      line.precision(3);
      if (imported.curves.diameter_guessed)
        line << file << ": the yarn's diameter is not said; " << fabric.diameter_mm
             << " mm is taken, the distance that 95 % of it keep from other curves (--yarn diameter=... says "
                "it)\n";
      std::cerr << line.str();
      piece = piece_of(imported);
    }
  } catch (const std::invalid_argument& fault) {
    throw std::invalid_argument(file + ": " + fault.what());
  }
  std::cerr << diagnostics;
  return piece;
}

}  // namespace

bool names_a_state(const std::string& file) {
  try {
    return fabric_format(file) == FabricFormat::state;
  } catch (const std::invalid_argument&) {
    return false;
  }
}

std::optional<Piece> read_piece(const std::string& file, const PieceRequest& request) {
  if (names_a_state(file)) {
    if (request.periodic || request.window)
      throw std::invalid_argument(file +
                                  ": a saved state is one piece; take a window or cell of the notation");
    return piece_of(read_state(file));
  }
  if (names_curves(file)) return read_curves(file, request);
  Diagnostics diagnostics(file);
  const Knitting knitting = knit(file, request, diagnostics);
  std::optional<Piece> piece;
  if (diagnostics.ok()) {
    try {
      piece = first_piece(knitting, request);
    } catch (const std::invalid_argument& fault) {
      diagnostics.error({}, fault.what());
    }
  }
  std::cerr << diagnostics;
  return piece;
}

std::optional<State> read_fabric(const std::string& file, const PieceRequest& request) {
  if (names_a_state(file) && !request.periodic && !request.window) return read_state(file);
  std::optional<Piece> piece = read_piece(file, request);
  if (!piece) return std::nullopt;
  return std::move(piece->state);
}

void keep_notation(const std::string& file, State& state) {
  if (names_a_state(file) || names_curves(file)) return;
  Diagnostics unread;
  std::optional<std::string> text = read_text(file, unread);
  if (text) keep_notation(state, std::move(*text), std::filesystem::path(file).extension().string());
}

void require_writable(const std::string& file) {
  // made and taken away again: nothing is left
  if (!file.empty() && file != "-") const AtomicFile probe{std::filesystem::path(file)};
}

RenderOptions render_options(const PictureRequest& request, const std::string& png) {
  if (!png.ends_with(".png") && !png.ends_with(".PNG"))
    throw std::invalid_argument("a picture is a PNG file: give '" + png + "' the suffix .png");
  RenderOptions options;
  options.view = view_named(request.view).value_or(View::front);
  const std::size_t cross = request.size.find('x');
  std::optional<int> width, height;
  if (cross != std::string::npos) {
    width = parsed_pixels(std::string_view(request.size).substr(0, cross));
    height = parsed_pixels(std::string_view(request.size).substr(cross + 1));
  }
  if (!width || !height || *width < 16 || *height < 16 || *width > 16384 || *height > 16384)
    throw std::invalid_argument("a picture's size is WIDTHxHEIGHT, each from 16 to 16384 pixels, not '" +
                                request.size + "'");
  std::tie(options.width, options.height) = std::pair(*width, *height);
  return options;
}

std::ostream& people(const std::string& json) { return json == "-" ? std::cerr : std::cout; }

std::string summary(const Assessment& assessment) {
  const Measurements& m = assessment.measured;
  std::ostringstream line;
  line.precision(3);
  if (m.loops == 0) {
    line << m.yarns << " yarns, " << m.yarn_m << " m, " << m.width_mm << " x " << m.height_mm << " x "
         << m.thickness_mm << " mm, nearest " << assessment.clearance.distance << " d";
    if (assessment.closed_yarns > 0)
      line << ", " << assessment.closed_yarns << " closed, " << assessment.linked.size()
           << " pairs of them linked";
    return line.str();
  }
  line << m.loops << " loops, " << m.width_mm << " x " << m.height_mm << " mm, " << m.wales_per_cm
       << " wales and " << m.courses_per_cm << " courses per cm, loop length " << m.loop_length_mm
       << " mm, Kc " << m.Kc << ", Kw " << m.Kw;
  constexpr double told_from = 0.5;  // degrees
  if (std::abs(m.wale_lean_degrees) >= told_from)
    line << ", wales lean by " << std::abs(m.wale_lean_degrees) << " degrees to the "
         << (m.wale_lean_degrees > 0 ? "right" : "left");
  if (m.areal_density_g_m2) line << ", " << *m.areal_density_g_m2 << " g/m^2";
  line << ", " << assessment.interlacings.intact << " of " << assessment.interlacings.expected
       << " interlacings intact";
  return line.str();
}

bool say_if_broken(const std::string& file, const Assessment& assessment, int pass_throughs) {
  if (is_whole(assessment, pass_throughs)) return false;
  const InterlacingCheck& check = assessment.interlacings;
  std::cerr << file << ": error: broken: " << check.intact << " of " << check.expected
            << " interlacings intact, " << pass_throughs << " pass-throughs\n";
  return true;
}

void tell_stability(const std::string& file, const Fabric& fabric, const RelaxOptions& options, int modes,
                    JsonObject& all, std::ostream& out) {
  const Stability found = stability(fabric, options.model, modes);
  JsonArray list;
  std::ostringstream line;
  line.precision(3);
  line << file << ": " << (found.stable ? "stable" : "unstable") << " without friction, lowest modes (B/d^4)";
  for (const Mode& mode : found.modes) {
    list.emplace_back(JsonObject{{"lambda_B_d4", mode.lambda}, {"along", mode.along}});
    line << ' ' << mode.lambda << (mode.along > 0.5 ? " (slides)" : "");
  }
  all.emplace_back("stable", found.stable);
  all.emplace_back("modes", std::move(list));
  if (found.sizes)
    all.emplace_back("size_eigenvalues_B_d3", std::vector<double>(found.sizes->begin(), found.sizes->end()));
  if (found.sizes && (*found.sizes)[0] <= 0) line << "; the cell changes its size or shears by itself";
  out << line.str() << '\n';
}

}  // namespace loopwright
