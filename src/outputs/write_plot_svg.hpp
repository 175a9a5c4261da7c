// Curves in a plane as an SVG drawing: axes with round ticks, one line per curve, a legend.
#pragma once
#include <filesystem>
#include <string>
#include <vector>

namespace loopwright {

struct PlotCurve {
  std::string name;
  std::vector<double> x, y;  // of equal length; points that are not finite break the line
  bool marks = false;        // points only, as for measured values
};

struct Plot {
  std::string title, x_label, y_label;
  std::vector<PlotCurve> curves;
};

// Throws FileError; std::invalid_argument for a curve whose x and y differ in length or a plot without a
// point.
void write_plot_svg(const std::filesystem::path& path, const Plot& plot);

// Places of ticks: multiples of 1, 2 or 5 times a power of ten that lie in [low, high], about `wanted` of
// them.
std::vector<double> round_ticks(double low, double high, int wanted);

}  // namespace loopwright
