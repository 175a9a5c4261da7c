#include "outputs/write_plot_svg.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <sstream>
#include <stdexcept>

#include "outputs/atomic_file.hpp"

namespace loopwright {
namespace {

constexpr double sheet_width = 160, sheet_height = 110;        // mm
constexpr double left = 22, right = 6, top = 12, bottom = 16;  // margins, mm
// Told apart by the colour-blind too (Okabe and Ito 2008).
constexpr std::array<const char*, 6> colours{"#0072b2", "#d55e00", "#009e73",
                                             "#cc79a7", "#e69f00", "#56b4e9"};

std::string escaped(const std::string& text) {
  std::string out;
  for (const char c : text) switch (c) {
      case '&':
        out += "&amp;";
        break;
      case '<':
        out += "&lt;";
        break;
      case '>':
        out += "&gt;";
        break;
      default:
        out += c;
    }
  return out;
}

struct Range {
  double low = std::numeric_limits<double>::infinity(), high = -low;
  void take(double v) {
    low = std::min(low, v);
    high = std::max(high, v);
  }
  void widen() {
    const double room = high > low ? 0.04 * (high - low) : std::max(1e-12, 0.5 * std::abs(high) + 1e-9);
    if (low != 0) low -= room;
    if (high != 0) high += room;
  }
  double share(double v) const { return (v - low) / (high - low); }
};

std::string number(double v) {
  std::ostringstream out;
  out.precision(6);
  out << (std::abs(v) < 1e-14 ? 0 : v);
  return out.str();
}

}  // namespace

std::vector<double> round_ticks(double low, double high, int wanted) {
  const double rough = (high - low) / std::max(1, wanted);
  const double power = std::pow(10, std::floor(std::log10(rough)));
  const double step = power * (rough / power < 1.5   ? 1
                               : rough / power < 3.5 ? 2
                               : rough / power < 7.5 ? 5
                                                     : 10);
  std::vector<double> ticks;
  for (double k = std::ceil(low / step - 1e-9); k * step <= high + 1e-9 * step; ++k)
    ticks.push_back(k * step);
  return ticks;
}

void write_plot_svg(const std::filesystem::path& path, const Plot& plot) {
  Range xs, ys;
  for (const PlotCurve& curve : plot.curves) {
    if (curve.x.size() != curve.y.size())
      throw std::invalid_argument("curve '" + curve.name + "' has other numbers of x and y");
    for (std::size_t i = 0; i < curve.x.size(); ++i)
      if (std::isfinite(curve.x[i]) && std::isfinite(curve.y[i])) xs.take(curve.x[i]), ys.take(curve.y[i]);
  }
  if (!(xs.low <= xs.high)) throw std::invalid_argument("a plot needs at least one point");
  xs.widen(), ys.widen();
  const double width = sheet_width - left - right, height = sheet_height - top - bottom;
  const auto px = [&](double x) { return left + width * xs.share(x); };
  const auto py = [&](double y) { return top + height * (1 - ys.share(y)); };

  std::ostringstream svg;
  svg.precision(6);
  svg << "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"" << sheet_width << "mm\" height=\""
      << sheet_height << "mm\" viewBox=\"0 0 " << sheet_width << ' ' << sheet_height
      << "\" font-family=\"sans-serif\" font-size=\"3.5\">\n<rect width=\"100%\" height=\"100%\" "
         "fill=\"white\"/>\n";
  svg << "<g stroke=\"#d8d8d8\" stroke-width=\"0.2\">\n";
  for (const double t : round_ticks(xs.low, xs.high, 7))
    svg << "<path d=\"M" << px(t) << ' ' << top << 'V' << top + height << "\"/>\n";
  for (const double t : round_ticks(ys.low, ys.high, 6))
    svg << "<path d=\"M" << left << ' ' << py(t) << 'H' << left + width << "\"/>\n";
  svg << "</g>\n<rect x=\"" << left << "\" y=\"" << top << "\" width=\"" << width << "\" height=\"" << height
      << "\" fill=\"none\" stroke=\"black\" stroke-width=\"0.3\"/>\n";
  for (const double t : round_ticks(xs.low, xs.high, 7))
    svg << "<text x=\"" << px(t) << "\" y=\"" << top + height + 4.5 << "\" text-anchor=\"middle\">"
        << number(t) << "</text>\n";
  for (const double t : round_ticks(ys.low, ys.high, 6))
    svg << "<text x=\"" << left - 1.5 << "\" y=\"" << py(t) + 1.2 << "\" text-anchor=\"end\">" << number(t)
        << "</text>\n";
  svg << "<text x=\"" << left + width / 2 << "\" y=\"" << sheet_height - 4 << "\" text-anchor=\"middle\">"
      << escaped(plot.x_label) << "</text>\n<text transform=\"translate(5 " << top + height / 2
      << ") rotate(-90)\" text-anchor=\"middle\">" << escaped(plot.y_label) << "</text>\n<text x=\""
      << left + width / 2 << "\" y=\"7\" text-anchor=\"middle\" font-size=\"4.2\">" << escaped(plot.title)
      << "</text>\n";
  for (std::size_t k = 0; k < plot.curves.size(); ++k) {
    const PlotCurve& curve = plot.curves[k];
    const char* colour = colours[k % colours.size()];
    std::ostringstream line;
    line.precision(6);
    bool pen_down = false;
    for (std::size_t i = 0; i < curve.x.size(); ++i) {
      if (!std::isfinite(curve.x[i]) || !std::isfinite(curve.y[i])) {
        pen_down = false;
        continue;
      }
      if (curve.marks)
        svg << "<circle cx=\"" << px(curve.x[i]) << "\" cy=\"" << py(curve.y[i]) << "\" r=\"0.9\" fill=\""
            << colour << "\"/>\n";
      else
        line << (pen_down ? 'L' : 'M') << px(curve.x[i]) << ' ' << py(curve.y[i]);
      pen_down = true;
    }
    if (!curve.marks)
      svg << "<path d=\"" << line.str() << "\" fill=\"none\" stroke=\"" << colour
          << "\" stroke-width=\"0.6\" stroke-linejoin=\"round\"/>\n";
    const double y = top + 5 + 5 * static_cast<double>(k);
    if (curve.marks)
      svg << "<circle cx=\"" << left + 6 << "\" cy=\"" << y - 1.2 << "\" r=\"0.9\" fill=\"" << colour
          << "\"/>\n";
    else
      svg << "<path d=\"M" << left + 3 << ' ' << y - 1.2 << "h6\" stroke=\"" << colour
          << "\" stroke-width=\"0.6\"/>\n";
    svg << "<text x=\"" << left + 11 << "\" y=\"" << y << "\">" << escaped(curve.name) << "</text>\n";
  }
  svg << "</svg>\n";
  AtomicFile file(path);
  file.stream() << svg.str();
  file.commit();
}

}  // namespace loopwright
