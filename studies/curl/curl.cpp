// A swatch between plates, then without them: how it curls. study_curl [WALES COURSES [LOOP_LENGTH_MM
// [FRICTION]]] prints a table and leaves a saved state and a picture of each structure in the working folder.
#include "experiments/curl.hpp"

#include <chrono>
#include <cstdio>
#include <fstream>
#include <iostream>
#include <string>

#include "outputs/image.hpp"
#include "outputs/render.hpp"
#include "outputs/write_fabric.hpp"
#include "pipeline.hpp"

namespace {

using namespace loopwright;

struct Swatch {
  const char* name;
  const char* courses;
};

double seconds_since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

void report(const char* name, const char* when, const RelaxResult& result, double seconds) {
  // stitches of both beds in turn would count as waves; plain has none and can be seen nearer to its edges
  const Curl c = curl(result.fabric, std::string(name) == "plain" ? 1 : 2);
  const InterlacingCheck check = check_interlacings(result.fabric);
  std::printf("%-8s %-15s %+9.4f %8.4f %+9.4f %8.4f  %4d of %4d  %3d  %5d  %8.1e  %6.1f\n", name, when,
              c.course, c.course_error, c.wale, c.wale_error, check.intact, check.expected,
              result.pass_throughs, result.newton_iterations, result.residual, seconds);
  std::fflush(stdout);
}

void curl_of(const Swatch& swatch, int wales, int courses, double loop_length_mm, double friction, int most) {
  const std::string file = std::string("curl_") + swatch.name + ".verm";
  std::ofstream(file)
      << ";!vermiculation-1\n;;Gauge: 10\n;;Bed-Gap: 2 mm\n;;Yarn-A: wool 2/28 Nm\n;;Loop-Length: "
      << loop_length_mm << " mm\n;;Size: " << wales << " wales x " << courses << " courses\n;;Edges: free\n"
      << swatch.courses << "\n";
  Diagnostics diagnostics(file);
  PieceRequest request;
  request.friction = friction;
  const Knitting knitting = knit(file, request, diagnostics);
  if (!diagnostics.ok()) {
    std::cerr << diagnostics;
    return;
  }
  const Fabric first = first_geometry(knitting, request);
  RelaxOptions options = relax_options(first, knitting.program, request);
  options.most_iterations = most;
  auto start = std::chrono::steady_clock::now();
  RelaxResult flat = relax(first, options);
  report(swatch.name, "between plates", flat, seconds_since(start));

  RelaxOptions free = options;
  free.grow_in = false;
  free.plate_room = -1;
  free.history = flat.history;
  start = std::chrono::steady_clock::now();
  const RelaxResult let_go = relax(flat.fabric, free);
  report(swatch.name, "let go", let_go, seconds_since(start));
  write_fabric(std::string("curl_") + swatch.name + ".h5", saved_state(let_go, free, 1));
  RenderOptions picture;
  picture.view = View::corner;
  picture.width = 1000, picture.height = 800;
  write_png(std::string("curl_") + swatch.name + ".png", render(let_go.fabric, picture));
}

}  // namespace

int main(int argc, char** argv) {
  const auto argument = [&](int k, double usual) { return argc > k ? std::stod(argv[k]) : usual; };
  const int wales = static_cast<int>(argument(1, 12)), courses = static_cast<int>(argument(2, 12));
  const double loop_length = argument(3, 7.4), friction = argument(4, 0.25);
  std::printf(
      "wool 2/28 Nm (d 0.37 mm), loops of %g mm, %d x %d loops, friction %g; curvatures in 1/d, toward the "
      "face positive\n",
      loop_length, wales, courses, friction);
  std::printf("%-8s %-15s %9s %8s %9s %8s  %12s  %3s  %5s  %8s  %6s\n", "", "", "course", "+-", "wale", "+-",
              "interlacings", "p-t", "steps", "residual", "s");
  const std::string only = argc > 5 ? argv[5] : "";
  const int most = static_cast<int>(argument(6, 400));
  for (const Swatch& swatch :
       {Swatch{"plain", "g"}, Swatch{"rib", "ge"}, Swatch{"garter", "g\ne"}, Swatch{"moss", "ge\neg"}})
    if (only.empty() || only == swatch.name) curl_of(swatch, wales, courses, loop_length, friction, most);
  return 0;
}
