// The reader of polylines in Wavefront OBJ: `v` places and `l` elements. A long `l` is a curve (Houdini and
// Loopwright write it so); those of two places are edges, in any order, and are chained (Blender writes
// them). Faces and all else are passed over.
#include <array>
#include <charconv>
#include <limits>
#include <optional>

#include "outputs/atomic_file.hpp"
#include "outputs/exchange/curve_file.hpp"

namespace loopwright {
namespace {

class ObjReader {
 public:
  ObjReader(std::string_view text, const std::string& name) : rest_(text), name_(name) {}

  CurveFile read() {
    while (next_line()) {
      const std::string_view key = word();
      if (key == "v") place();
      if (key == "l") line();
      if (key == "f") faces_ = true;
      if (key.starts_with('#')) comment();
    }
    chain_edges();
    if (file_.curves.empty()) {
      line_ = 0;
      fail(faces_ ? "it holds faces and no lines (l elements): centrelines are read, surfaces are not"
                  : "it holds no lines (l elements)");
    }
    return std::move(file_);
  }

 private:
  [[noreturn]] void fail(const std::string& why) const {
    throw FileError("cannot read " + name_ + ":" + (line_ > 0 ? std::to_string(line_) + ": " : " ") + why);
  }

  // The next line; one that ends in a backslash goes on on the next.
  bool next_line() {
    if (rest_.empty()) return false;
    joined_.clear();
    for (bool more = true; more && !rest_.empty();) {
      const std::size_t end = std::min(rest_.find('\n'), rest_.size());
      std::string_view row = rest_.substr(0, end);
      rest_.remove_prefix(std::min(end + 1, rest_.size()));
      ++line_;
      if (row.ends_with('\r')) row.remove_suffix(1);
      more = row.ends_with('\\');
      if (more) row.remove_suffix(1);
      joined_ += row;
      joined_ += ' ';
    }
    row_ = joined_;
    return true;
  }

  std::string_view word() {
    const std::size_t begin = std::min(row_.find_first_not_of(" \t"), row_.size());
    row_.remove_prefix(begin);
    const std::size_t end = std::min(row_.find_first_of(" \t"), row_.size());
    const std::string_view found = row_.substr(0, end);
    row_.remove_prefix(end);
    return found;
  }

  template <class T>
  static std::optional<T> number(std::string_view text) {
    T value{};
    if (text.starts_with('+')) text.remove_prefix(1);
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
    return value;
  }

  void place() {
    Vec3 p;
    for (int c = 0; c < 3; ++c) {
      const std::string_view text = word();
      const std::optional<double> value = number<double>(text);
      if (!value || !std::isfinite(*value))
        fail("a place needs three numbers; here is '" + std::string(text.substr(0, 40)) + "'");
      p[c] = *value;
    }
    places_.push_back(p);
  }

  // "7", "-1" (counted back from the latest), "7/3" (with a texture coordinate)
  std::size_t index(std::string_view text) const {
    const std::optional<long long> value = number<long long>(text.substr(0, text.find('/')));
    const auto count = static_cast<long long>(places_.size());
    const long long at = !value ? -1 : *value > 0 ? *value - 1 : *value < 0 ? count + *value : -1;
    if (at < 0 || at >= count)
      fail("'" + std::string(text.substr(0, 40)) + "' is not one of the " + std::to_string(count) +
           " places so far");
    return static_cast<std::size_t>(at);
  }

  void line() {
    std::vector<std::size_t> indices;
    for (std::string_view text = word(); !text.empty(); text = word()) indices.push_back(index(text));
    if (indices.size() < 2) fail("a line needs two places or more");
    if (indices.size() == 2)
      edges_.push_back({indices[0], indices[1]});
    else
      add_curve(std::move(indices));
  }

  void add_curve(std::vector<std::size_t> indices) {
    FileCurve curve;
    for (const std::size_t k : indices) curve.points.push_back(places_[k]);
    // a ring ends in its first place, under the same number or another
    curve.closed = curve.points.size() > 3 && curve.points.front() == curve.points.back();
    if (curve.closed) curve.points.pop_back();
    curve.radius = 0.5 * diameter_;
    file_.curves.push_back(std::move(curve));
  }

  // Follows edges from end to end, then round what is left: rings.
  void chain_edges() {
    constexpr std::size_t none = std::numeric_limits<std::size_t>::max();
    std::vector<std::array<std::size_t, 2>> neighbours(edges_.empty() ? 0 : places_.size(), {none, none});
    const auto join = [&](std::size_t a, std::size_t b) {
      auto& of_a = neighbours[a];
      if (of_a[0] == b || of_a[1] == b) return;  // told twice
      if (of_a[1] != none)
        fail("three edges meet at place " + std::to_string(a + 1) + ": a yarn does not branch");
      of_a[of_a[0] == none ? 0 : 1] = b;
    };
    for (const auto& [a, b] : edges_) {
      if (a == b) continue;
      join(a, b);
      join(b, a);
    }
    const auto follow = [&](std::size_t start) {
      std::vector<std::size_t> chain{start};
      for (std::size_t at = start, next = neighbours[start][0]; next != none;) {
        chain.push_back(next);
        neighbours[at] = {none, none};
        const auto& of_next = neighbours[next];
        const std::size_t after = of_next[0] == at ? of_next[1] : of_next[0];
        at = next;
        next = after;
      }
      neighbours[chain.back()] = {none, none};
      add_curve(std::move(chain));
    };
    for (std::size_t k = 0; k < neighbours.size(); ++k)
      if (neighbours[k][0] != none && neighbours[k][1] == none) follow(k);
    for (std::size_t k = 0; k < neighbours.size(); ++k)
      if (neighbours[k][0] != none) follow(k);
  }

  // What Loopwright's own files say in their comments: the unit, the diameter of the yarn that follows.
  void comment() {
    const std::string_view key = word(), second = word();
    if (key == "unit:" && second.starts_with("millimetre")) file_.millimetres = true;
    const bool of_reference = key == "yarn" && second == "diameter:";
    if (of_reference || key == "diameter:") {
      const std::optional<double> value = number<double>(of_reference ? word() : second);
      if (!value || !(*value > 0) || !std::isfinite(*value)) return;
      (of_reference ? file_.diameter_mm : diameter_) = *value;
    }
  }

  std::string_view rest_;
  const std::string& name_;
  std::string joined_;
  std::string_view row_;
  int line_ = 0;
  bool faces_ = false;
  double diameter_ = 0;
  std::vector<Vec3> places_;
  std::vector<std::array<std::size_t, 2>> edges_;
  CurveFile file_;
};

}  // namespace

CurveFile read_obj_curves(std::string_view text, const std::string& name) {
  return ObjReader(text, name).read();
}

}  // namespace loopwright
