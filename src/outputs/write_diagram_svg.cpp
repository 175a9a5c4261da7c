#include "outputs/write_diagram_svg.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <iostream>

#include "outputs/atomic_file.hpp"

namespace loopwright {
namespace {

// Lengths are in needle pitches unless their name says mm.
constexpr double page_width_mm = 186, page_height_mm = 273;  // A4 less 12 mm on each side
constexpr double widest_pitch_mm = 7, narrowest_pitch_mm = 2.6, least_text_mm = 2;
constexpr double bed_distance = 0.9;     // of the two rows of dots
constexpr double half_loop_width = 0.3;  // a loop round a needle
constexpr double loop_depth = 0.36;      // how far it reaches past the needle
constexpr double yarn_width = 0.085;
constexpr double line_space = 0.42;                      // between the loops of two lines of graph
constexpr double least_label_mm = 4.3;                   // unit of the columns of labels: a pitch, or this
constexpr double left_labels = 2.6, right_labels = 1.7;  // course, yarn, arrow; racking
constexpr std::array yarn_colours{"#1f3a5f", "#b03020", "#2e7d4f", "#8a5a00", "#6a3d8a", "#00707a"};

std::string escaped(const std::string& text) {
  std::string out;
  for (const char c : text) {
    if (c == '&')
      out += "&amp;";
    else if (c == '<')
      out += "&lt;";
    else if (c == '>')
      out += "&gt;";
    else if (c == '"')
      out += "&quot;";
    else if (static_cast<unsigned char>(c) >= 0x20)
      out += c;
  }
  return out;
}

// Brightness from 0 to 1 (ITU-R BT.601 weights) of "#rrggbb" or "#rgb".
double brightness(const std::string& colour) {
  const bool is_short = colour.size() == 4;
  double sum = 0;
  for (int i = 0; i < 3; ++i) {
    const auto at = static_cast<std::size_t>(1 + i * (is_short ? 1 : 2));
    const int value = std::stoi(colour.substr(at, is_short ? 1 : 2), nullptr, 16);
    sum += (i == 0 ? 0.299 : i == 1 ? 0.587 : 0.114) * value / (is_short ? 15 : 255);
  }
  return sum;
}

// A pass as it stands on the paper, over the height of its line.
struct Line {
  const DiagramPass* pass = nullptr;
  double front = 0, rear = 0,
         yarn = 0;             // heights of the rows of dots and of the yarn, upwards from the bottom
  double bottom = 0, top = 0;  // of what is drawn
  bool has_rear = false;       // the rear bed is drawn
  int column = 0;              // of the sheet
};

class Drawing {
 public:
  explicit Drawing(const NeedleDiagram& diagram) : diagram_(diagram) {}

  std::string svg() {
    lay_out();
    open();
    title();
    shade_courses();
    for (const Line& line : lines_) {
      column_ = line.column;
      draw(line);
    }
    for (column_ = 0; column_ < columns_; ++column_) {
      needle_numbers();
      repeat_mark();
    }
    text_ += "</svg>\n";
    return std::move(text_);
  }

 private:
  // --- places

  void lay_out() {
    least_slot_ = diagram_.first_needle;
    most_slot_ = diagram_.first_needle + std::max(diagram_.wales, 1) - 1;
    for (const DiagramPass& pass : diagram_.passes) lines_.push_back(line_of(pass));
    used_.assign(diagram_.yarns.size(), false);
    for (const DiagramPass& pass : diagram_.passes)
      for (const int yarn : pass.yarns) used_[static_cast<std::size_t>(yarn)] = true;
    several_ = std::count(used_.begin(), used_.end(), true) > 1;
    // columns where the lines would become too small for one
    constexpr int most_columns = 4;
    constexpr double easily_read_mm = 4;
    pitch_mm_ = fitting_pitch(1);
    for (int columns = 2; columns <= most_columns && pitch_mm_ < easily_read_mm; ++columns) {
      const double pitch = fitting_pitch(columns);
      if (pitch < 1.2 * pitch_mm_) continue;
      pitch_mm_ = pitch;
      columns_ = columns;
    }
    if (pitch_mm_ < narrowest_pitch_mm) columns_ = 1;
    pitch_mm_ = std::clamp(pitch_mm_, narrowest_pitch_mm, widest_pitch_mm);
    stack(columns_);
    column_mm_ = graph_width() * pitch_mm_ + (left_labels + right_labels) * label_mm();
    width_mm_ = std::max(columns_ * column_mm_, 6 + 2.5 * static_cast<double>(diagram_.name.size()));
    height_mm_ = height_ * pitch_mm_ + title_mm();
  }

  // A line by itself, standing on 0.
  Line line_of(const DiagramPass& pass) {
    // a pass that keeps to the front bed needs one row of dots, transfers need both and no room for loops
    const auto meant = [](const DiagramNeedle& needle) {
      return needle.operation != NeedleOperation::unused && needle.operation != NeedleOperation::inactive;
    };
    Line line;
    line.pass = &pass;
    const auto gives = [](const DiagramNeedle& needle) { return needle.operation == NeedleOperation::split; };
    line.has_rear =
        diagram_.rear_bed && (!pass.carries_yarn || std::any_of(pass.rear.begin(), pass.rear.end(), meant) ||
                              std::any_of(pass.front.begin(), pass.front.end(), gives));
    const double reach = pass.carries_yarn ? loop_depth : 0;
    line.front = reach;
    line.rear = line.front + bed_distance;
    line.yarn = line.front + bed_distance / 2;
    line.top = line.has_rear ? line.rear + reach : line.yarn;
    for (const DiagramNeedle& needle : pass.rear) {
      if (!line.has_rear) break;
      least_slot_ = std::min(least_slot_, needle.slot);
      most_slot_ = std::max(most_slot_, needle.slot);
    }
    return line;
  }

  double graph_width() const { return most_slot_ - least_slot_ + 2; }

  // The pitch at which so many columns fit the page.
  double fitting_pitch(int columns) {
    stack(columns);
    const double room_mm = page_width_mm / columns, labels = left_labels + right_labels;
    return std::min({(room_mm - labels * least_label_mm) / graph_width(), room_mm / (graph_width() + labels),
                     (page_height_mm - title_mm()) / height_, widest_pitch_mm});
  }

  // Stacks the lines in so many columns of like height, upwards, without parting a course; sets height_.
  void stack(int columns) {
    constexpr double numbers = 0.9;  // needle numbers stand below
    double all = 0;
    for (const Line& line : lines_) all += line.top - line.bottom + line_space;
    for (double limit = all / columns;; limit *= 1.02) {
      int column = 0;
      double top = 0;
      height_ = 0;
      for (std::size_t i = 0; i < lines_.size();) {
        std::size_t end = i;
        double course = 0;
        for (; end < lines_.size() && lines_[end].pass->course == lines_[i].pass->course; ++end)
          course += lines_[end].top - lines_[end].bottom + line_space;
        if (top > 0 && top + course > limit * (1 + 1e-9)) {
          ++column;
          top = 0;
        }
        for (; i < end; ++i) {
          Line& line = lines_[i];
          const double rise = numbers + top - line.bottom;
          for (double* height : {&line.front, &line.rear, &line.yarn, &line.bottom, &line.top})
            *height += rise;
          line.column = column;
          top += line.top - line.bottom + line_space;
        }
        height_ = std::max(height_, numbers + top);
      }
      if (column < columns) return;
    }
  }

  double title_mm() const { return (diagram_.name.empty() ? 1 : 8) + (several_ ? 5 : 0); }

  double label_mm() const { return std::max(pitch_mm_, least_label_mm); }
  double x(double slot) const { return (slot - least_slot_ + 1) * pitch_mm_ + left(left_labels); }
  double left(double labels) const { return column_ * column_mm_ + labels * label_mm(); }
  double y(double height) const { return height_mm_ - height * pitch_mm_; }
  double text_mm() const { return std::max(0.48 * pitch_mm_, least_text_mm); }

  // --- SVG

  void put(const char* text) { text_ += text; }
  template <class... Values>
  void put(const char* format, double first, Values... more) {
    std::array<char, 512> buffer{};
    const int size = std::snprintf(buffer.data(), buffer.size(), format, first, more...);
    text_.append(buffer.data(), static_cast<std::size_t>(std::clamp(size, 0, 511)));
  }

  void open() {
    put("<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"%.2fmm\" height=\"%.2fmm\" viewBox=\"0 0 %.2f "
        "%.2f\" ",
        width_mm_, height_mm_, width_mm_, height_mm_);
    text_ +=
        "font-family=\"'DejaVu Sans', Arial, sans-serif\" fill=\"none\" stroke-linecap=\"round\" "
        "stroke-linejoin=\"round\">\n";
    text_ += "<title>" + escaped(diagram_.name.empty() ? "needle diagram" : diagram_.name) + "</title>\n";
    put("<rect width=\"%.2f\" height=\"%.2f\" fill=\"#ffffff\"/>\n", width_mm_, height_mm_);
  }

  void write(double at_x, double at_y, double size_mm, const char* anchor, const std::string& what,
             const char* more = "") {
    put("<text x=\"%.2f\" y=\"%.2f\" font-size=\"%.2f\" text-anchor=\"%s\" fill=\"#333333\"%s>", at_x, at_y,
        size_mm, anchor, more);
    text_ += escaped(what) + "</text>\n";
  }

  void title() {
    double at = 1;
    if (!diagram_.name.empty()) write(2, 5.2, 3.8, "start", diagram_.name, " font-weight=\"bold\"");
    if (!diagram_.name.empty()) at = 8;
    if (!several_) return;
    double at_x = 2;
    for (std::size_t i = 0; i < diagram_.yarns.size(); ++i) {
      if (!used_[i]) continue;
      const std::string& name = diagram_.yarns[i].name;
      put("<path d=\"M%.2f %.2fh6\"", at_x, at + 1.6);
      stroke_yarn(static_cast<int>(i), 0.9);
      write(at_x + 7.5, at + 2.7, 3, "start", name);
      at_x += 12 + 2.2 * static_cast<double>(name.size());
      if (at_x > width_mm_ - 12) break;
    }
  }

  const char* colour_of(int yarn) const {
    const auto place = static_cast<std::size_t>(yarn);
    if (place < diagram_.yarns.size() && !diagram_.yarns[place].colour.empty())
      return diagram_.yarns[place].colour.c_str();
    return yarn_colours[place % yarn_colours.size()];
  }

  // Ends a path element that was begun: a light yarn gets a dark rim, so that it is seen on white paper.
  void stroke_yarn(int yarn, double width) {
    const std::string path = text_.substr(text_.rfind("<path"));
    const char* colour = colour_of(yarn);
    if (brightness(colour) > 0.7) {
      put(" stroke=\"#555555\" stroke-width=\"%.2f\"/>\n", width * 1.5);
      text_ += path;
    }
    text_ += std::string(" stroke=\"") + colour;
    put("\" stroke-width=\"%.2f\"/>\n", width);
  }

  void shade_courses() {
    for (std::size_t i = 0; i < lines_.size();) {
      std::size_t end = i;
      while (end < lines_.size() && lines_[end].pass->course == lines_[i].pass->course) ++end;
      const double bottom = lines_[i].bottom - line_space / 2;
      const double top = lines_[end - 1].top + line_space / 2;
      column_ = lines_[i].column;
      if (lines_[i].pass->course % 2 == 0)
        put("<rect x=\"%.2f\" y=\"%.2f\" width=\"%.2f\" height=\"%.2f\" fill=\"#f3f1ea\"/>\n",
            x(least_slot_ - 0.8), y(top), (most_slot_ - least_slot_ + 1.6) * pitch_mm_,
            (top - bottom) * pitch_mm_);
      // the number stands with the pass that knits
      std::size_t knits = i;
      while (knits < end && !lines_[knits].pass->carries_yarn) ++knits;
      if (knits < end)
        write(left(0.9), y(lines_[knits].yarn) + 0.35 * text_mm(), text_mm(), "end",
              std::to_string(lines_[i].pass->course));
      i = end;
    }
  }

  // --- a line of graph

  void draw(const Line& line) {
    const DiagramPass& pass = *line.pass;
    put("<g><title>");
    if (pass.at.line > 0) text_ += "line " + std::to_string(pass.at.line) + ": ";
    text_ += pass.carries_yarn ? "course " + std::to_string(pass.course) : "transfers";
    put("</title>\n");
    draw_needles(pass.front, line.front, pass);
    if (line.has_rear) draw_needles(pass.rear, line.rear, pass);
    if (pass.carries_yarn) {
      draw_yarn(line);
      label_feeder(line);
    }
    draw_transfers(line);
    label_racking(line);
    put("</g>\n");
  }

  void draw_needles(const std::vector<DiagramNeedle>& needles, double height, const DiagramPass& pass) {
    const double r = 0.075 * pitch_mm_, arm = 0.13 * pitch_mm_;
    std::string dots, faint, crosses, rings;
    const auto add = [](std::string& path, const char* format, auto... values) {
      std::array<char, 128> buffer{};
      std::snprintf(buffer.data(), buffer.size(), format, values...);
      path += buffer.data();
    };
    for (const DiagramNeedle& needle : needles) {
      const double cx = x(needle.slot), cy = y(height);
      const bool at_rest = needle.operation == NeedleOperation::unused ||
                           (!pass.carries_yarn && needle.operation != NeedleOperation::drop &&
                            needle.operation != NeedleOperation::transfer);
      if (needle.operation == NeedleOperation::inactive && pass.carries_yarn) {
        add(crosses, "M%.2f %.2fl%.2f %.2fm0 %.2fl%.2f %.2f", cx - arm, cy - arm, 2 * arm, 2 * arm, -2 * arm,
            -2 * arm, 2 * arm);
      } else if (needle.operation == NeedleOperation::drop) {
        add(rings, "M%.2f %.2fa%.2f %.2f 0 1 0 %.2f 0a%.2f %.2f 0 1 0 %.2f 0", cx - arm, cy, arm, arm,
            2 * arm, arm, arm, -2 * arm);
      } else {
        add(at_rest ? faint : dots, "M%.2f %.2fh0", cx, cy);
      }
    }
    const auto finish = [&](const std::string& path, const char* colour, double width) {
      if (path.empty()) return;
      text_ += "<path d=\"" + path;
      text_ += std::string("\" stroke=\"") + colour;
      put("\" stroke-width=\"%.2f\"/>\n", width);
    };
    // a stroke of no length with round ends is a dot
    finish(faint, "#b5b5b5", 1.5 * r);
    finish(dots, "#222222", 2 * r);
    finish(crosses, "#222222", 0.05 * pitch_mm_);
    finish(rings, "#222222", 0.05 * pitch_mm_);
  }

  struct Stop {
    double slot = 0;
    NeedleOperation operation = NeedleOperation::missed;
    bool front = true;
  };

  static std::vector<Stop> stops_of(const DiagramPass& pass) {
    std::vector<Stop> stops;
    const auto meets = [](NeedleOperation operation) {
      return operation == NeedleOperation::stitch || operation == NeedleOperation::tuck ||
             operation == NeedleOperation::split || operation == NeedleOperation::missed;
    };
    for (const auto* row : {&pass.front, &pass.rear})
      for (const DiagramNeedle& needle : *row)
        if (meets(needle.operation)) stops.push_back({needle.slot, needle.operation, row == &pass.front});
    std::stable_sort(stops.begin(), stops.end(),
                     [](const Stop& a, const Stop& b) { return a.slot < b.slot; });
    // where a missed needle faces another, the yarn passes once
    std::vector<Stop> met;
    for (const Stop& stop : stops) {
      if (!met.empty() && met.back().slot == stop.slot) {
        if (met.back().operation == NeedleOperation::missed) met.back() = stop;
        if (stop.operation == NeedleOperation::missed) continue;
        if (met.back().front == stop.front) continue;
      }
      met.push_back(stop);
    }
    return met;
  }

  // The yarn from left to right, whatever way the carriage goes; plating yarns run side by side.
  void draw_yarn(const Line& line) {
    const std::vector<Stop> stops = stops_of(*line.pass);
    if (stops.empty()) return;
    for (std::size_t strand = 0; strand < line.pass->yarns.size(); ++strand) {
      const double shift = 1.3 * yarn_width * static_cast<double>(strand);
      put("<path d=\"M%.2f %.2f", x(stops.front().slot - 0.75), y(line.yarn - shift));
      put("H%.2f", x(stops.front().slot - 0.5));
      for (std::size_t i = 0; i < stops.size(); ++i) {
        const double before = i == 0 ? 0.5 : std::min(0.5, (stops[i].slot - stops[i - 1].slot) / 2);
        const double after =
            i + 1 == stops.size() ? 0.5 : std::min(0.5, (stops[i + 1].slot - stops[i].slot) / 2);
        go_round(line, stops[i], before, after, shift);
      }
      put("H%.2f\"", x(stops.back().slot + 0.75));
      stroke_yarn(line.pass->yarns[strand], yarn_width * pitch_mm_);
    }
  }

  // From `before` left of a needle to `after` right of it.
  void go_round(const Line& line, const Stop& stop, double before, double after, double shift) {
    const double needle = stop.front ? line.front : line.rear;
    const double down = stop.front ? -1 : 1;  // from the yarn to the needle and past it
    const double yarn = line.yarn - shift, s = stop.slot;
    const double half = half_loop_width - shift * 0.9;
    const double end = needle + down * (loop_depth - shift * 0.9);
    put("H%.2f", x(s - before));
    if (stop.operation == NeedleOperation::missed) {
      put("H%.2f", x(s + after));
      return;
    }
    const auto curve = [&](double x1, double y1, double x2, double y2, double x3, double y3) {
      put("C%.2f %.2f %.2f %.2f %.2f %.2f", x(x1), y(y1), x(x2), y(y2), x(x3), y(y3));
    };
    const double neck = needle - down * 0.24, leg = needle + down * 0.04, belly = needle + down * 0.22;
    if (stop.operation == NeedleOperation::tuck) {
      // its legs stand apart: the yarn goes into the hook and out again
      const double left = std::min(half, 0.85 * before), right = std::min(half, 0.85 * after);
      curve(s - left - 0.2 * (before - left), yarn, s - left, neck, s - left, leg);
      curve(s - left, belly, s - left * 0.55, end, s, end);
      curve(s + right * 0.55, end, s + right, belly, s + right, leg);
      curve(s + right, neck, s + right + 0.2 * (after - right), yarn, s + after, yarn);
      return;
    }
    // its legs cross, so that the yarn closes round the needle
    curve(s - before * 0.1, yarn, s + half, neck, s + half, leg);
    curve(s + half, belly, s + half * 0.55, end, s, end);
    curve(s - half * 0.55, end, s - half, belly, s - half, leg);
    curve(s - half, neck, s + after * 0.1, yarn, s + after, yarn);
  }

  // Upright arrows from the needle that gives; of a split as well, whose old loops go over.
  void draw_transfers(const Line& line) {
    std::string shafts, heads;
    for (const auto* row : {&line.pass->front, &line.pass->rear}) {
      const bool front = row == &line.pass->front;
      for (const DiagramNeedle& needle : *row) {
        if (needle.operation != NeedleOperation::transfer && needle.operation != NeedleOperation::split)
          continue;
        const double up = front ? 1 : -1, tip = (front ? line.rear : line.front) - up * 0.16;
        std::array<char, 128> buffer{};
        std::snprintf(buffer.data(), buffer.size(), "M%.2f %.2fV%.2f", x(needle.slot),
                      y((front ? line.front : line.rear) + up * 0.16), y(tip - up * 0.1));
        shafts += buffer.data();
        std::snprintf(buffer.data(), buffer.size(), "M%.2f %.2fL%.2f %.2fL%.2f %.2fz", x(needle.slot), y(tip),
                      x(needle.slot - 0.11), y(tip - up * 0.22), x(needle.slot + 0.11), y(tip - up * 0.22));
        heads += buffer.data();
      }
    }
    if (shafts.empty()) return;
    text_ += "<path d=\"" + shafts;
    put("\" stroke=\"#222222\" stroke-width=\"%.2f\"", 0.06 * pitch_mm_);
    if (line.pass->implied) put(" stroke-dasharray=\"%.2f %.2f\"", 0.08 * pitch_mm_, 0.12 * pitch_mm_);
    text_ += "/>\n<path d=\"" + heads + "\" fill=\"#222222\"/>\n";
  }

  void label_feeder(const Line& line) {
    const DiagramPass& pass = *line.pass;
    std::string names;
    for (const int yarn : pass.yarns)
      names += (names.empty() ? "" : "+") + diagram_.yarns[static_cast<std::size_t>(yarn)].name;
    if (several_) write(left(1.2), y(line.yarn) + 0.35 * text_mm(), text_mm(), "start", names);
    // an arrow of the carriage's direction
    const bool right = pass.direction != Direction::left;
    const double tail = left(right ? 2.05 : 2.65), tip = left(right ? 2.65 : 2.05), at = y(line.yarn);
    const double barb = (right ? -0.2 : 0.2) * pitch_mm_, half = 0.13 * pitch_mm_;
    put("<path d=\"M%.2f %.2fH%.2fm%.2f %.2fl%.2f %.2fl%.2f %.2f\" stroke=\"#333333\" "
        "stroke-width=\"%.2f\"/>\n",
        tail, at, tip, barb, -half, -barb, half, barb, half, 0.06 * pitch_mm_);
  }

  // Where the beds do not stand at home: the arrow shows from where to where the rear bed was racked.
  void label_racking(const Line& line) {
    const DiagramPass& pass = *line.pass;
    const double gating = pass.carries_yarn ? diagram_.gating : 0;
    const double shown = pass.racking - gating;
    const double end = x(most_slot_ + 1.1);
    if (!line.has_rear) return;
    double last = shown;
    for (const DiagramNeedle& needle : pass.rear) {
      const double index = diagram_.first_needle + static_cast<double>(&needle - pass.rear.data());
      last = needle.slot - index - gating;
    }
    if (shown == 0 && last == 0) return;
    std::string label = "R" + number_text(shown);
    if (last != shown) label += pass.direction == Direction::left ? "\u2190" : "\u2192R" + number_text(last);
    write(end, y(line.rear) + 0.35 * text_mm(), text_mm(), "start", label);
    if (shown == 0) return;
    // in the place that the bed has left
    const double from =
        shown > 0 ? diagram_.first_needle + gating : diagram_.first_needle + diagram_.wales - 1 + gating;
    const double tip = x(from + shown) + (shown > 0 ? -0.2 : 0.2) * pitch_mm_, at = y(line.rear);
    const double barb = (shown > 0 ? -0.2 : 0.2) * pitch_mm_, half = 0.13 * pitch_mm_;
    put("<path d=\"M%.2f %.2fH%.2fm%.2f %.2fl%.2f %.2fl%.2f %.2f\" stroke=\"#222222\" "
        "stroke-width=\"%.2f\"/>\n",
        x(from), at, tip, barb, -half, -barb, half, barb, half, 0.06 * pitch_mm_);
  }

  // --- round the graph

  void needle_numbers() {
    const int step = diagram_.wales <= 12 ? 1 : diagram_.wales <= 60 ? 5 : 10;
    for (int w = diagram_.first_needle; w < diagram_.first_needle + diagram_.wales; ++w)
      if (w % step == 0) write(x(w), y(0.18), 0.85 * text_mm(), "middle", std::to_string(w));
  }

  // A bar over one repeat, where more than one is drawn.
  void repeat_mark() {
    if (diagram_.repeat_wales == 0 || diagram_.repeat_wales >= diagram_.wales) return;
    const double left = x(-0.45), right = x(diagram_.repeat_wales - 0.55), at = y(0.72),
                 tick = 0.12 * pitch_mm_;
    put("<path d=\"M%.2f %.2fv%.2fH%.2fv%.2f\" stroke=\"#777777\" stroke-width=\"%.2f\"/>\n", left, at - tick,
        tick, right, -tick, 0.05 * pitch_mm_);
  }

  const NeedleDiagram& diagram_;
  std::vector<Line> lines_;
  std::vector<bool> used_;        // by yarn
  bool several_ = false;          // yarns are used
  int columns_ = 1, column_ = 0;  // of the sheet; the one being drawn
  double least_slot_ = 0, most_slot_ = 0, height_ = 0, column_mm_ = 0;
  double pitch_mm_ = widest_pitch_mm, width_mm_ = 0, height_mm_ = 0;
  std::string text_;
};

}  // namespace

std::string diagram_svg(const NeedleDiagram& diagram) { return Drawing(diagram).svg(); }

void write_diagram_svg(const std::filesystem::path& path, const NeedleDiagram& diagram) {
  const std::string text = diagram_svg(diagram);
  if (path == "-") {
    std::cout << text << std::flush;
    if (!std::cout) throw FileError("cannot write the diagram to standard output");
    return;
  }
  AtomicFile file(path);
  file.stream() << text;
  file.commit();
}

}  // namespace loopwright
