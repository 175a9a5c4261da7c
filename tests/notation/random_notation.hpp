// Valid fabric files as chance writes them: all letters, groups, rackings, feeders, brackets, comments,
// blanks.
#pragma once
#include <random>
#include <string>

namespace loopwright {

class RandomNotation {
 public:
  explicit RandomNotation(unsigned seed) : random_(seed) { write(); }
  const std::string& text() const { return text_; }
  std::size_t below(std::size_t count) { return random_() % count; }

 private:
  bool chance(int percent) { return below(100) < static_cast<std::size_t>(percent); }
  std::string blanks() { return std::string(chance(20) ? 1 + below(3) : 0, chance(80) ? ' ' : '\t'); }
  template <class... Texts>
  std::string one_of(Texts... texts) {
    const std::string list[] = {texts...};
    return list[below(sizeof...(texts))];
  }
  std::string comment() { return chance(30) ? "  ; " + one_of("note", "g e", "x ; y", "") : ""; }

  void write() {
    text_ = ";!vermiculation-1\n";
    const auto add = [&](int percent, const std::string& line) {
      if (chance(percent)) text_ += line + comment() + "\n";
      if (chance(10)) text_ += one_of("", "; a word", "   ", ";; no: header") + "\n";
    };
    add(50, ";;Name: " + one_of("rib", "a 'b' c"));
    add(50, ";;Gauge: " + one_of("12", "7 npi", "E14"));
    add(60, ";;Yarn-A: " +
                one_of("wool 2/28 Nm", "wool 2/28 Nm  colour = #b03020", "linear-density=2/30 Nm", ""));
    yarns_ = text_.find("Yarn-A") != text_.npos ? 1 : 0;
    if (yarns_ == 1 && chance(60)) {
      text_ += ";;Yarn-B2: friction=0.2\n";
      yarns_ = 2;
    }
    add(30, ";;Loop-Length: " + one_of("5.9 mm", "0.59 cm", "0.2323 in"));
    add(30, ";;Set: " + one_of("0", "25 %", "1"));
    add(20, ";;Float-Slack: 5 %");
    if (yarns_ > 0) add(20, ";;Carriers: 3  5");
    add(20, ";;Gating: " + one_of("opposite", "half-pitch"));
    add(40, ";;Size: " + one_of("12 x 8", "8 courses x 12 wales", "3 wales x 4 courses"));
    add(40, ";;Edges: " + one_of("held", "free", "periodic", "bound-off"));
    add(20, ";;X-Mine: 3");
    lines(2);
    text_ += blanks() + "ge" + comment() + "\n";
  }

  void lines(int depth) {
    for (std::size_t i = 0; i < 1 + below(3); ++i) {
      if (chance(15)) text_ += one_of("", "; a word", begun_ ? ";;Gauge: 3" : ";") + "\n";
      if (depth > 0 && chance(25)) {
        begun_ = true;
        text_ += blanks() + "[" + comment() + "\n";
        lines(depth - 1);
        text_ += "]" + blanks() + "*" + std::to_string(1 + below(4)) + comment() + "\n";
      } else {
        text_ += blanks() + line() + comment() + "\n";
      }
    }
  }

  std::string line() {
    begun_ = true;
    std::string text = pass();
    while (chance(20)) text += blanks() + "&" + blanks() + pass();
    return text;
  }

  std::string pass() {
    if (chance(10)) return racking();
    if (chance(20)) return chance(50) ? row("tTdD.-") : row("td.-") + "/" + row("TD.-", false);
    const bool both = chance(40);
    const std::string head = chance(40) ? yarn() + one_of(":", "<", ">") : one_of("", "<", ">");
    return head + blanks() + (both ? row("gvs.-") + "/" + row("enS.-", false) : row("gevnsS.-"));
  }

  std::string yarn() {
    return yarns_ == 2 ? one_of("A", "B2", "B2+A", "A + B2", "") : yarns_ == 1 ? "A" : "";
  }
  std::string racking() {
    return one_of("R", "r") + one_of("0", "1", "-1", "+2", "0.5", "-0.25", ".5") + " ";
  }

  // At least one letter; rackings only where they may stand.
  std::string row(const std::string& letters, bool rackings = true) {
    std::string text;
    for (std::size_t i = 0; i < 1 + below(4); ++i) {
      if (rackings && chance(10)) text += racking();
      const bool group = chance(20);
      text += group ? "(" : "";
      for (std::size_t k = 0; k < 1 + below(3); ++k) text += letters[below(letters.size())] + blanks();
      text += group ? ")" : "";
      if (chance(20)) text += "*" + std::to_string(1 + below(12)) + " ";
    }
    return text + (rackings ? "" : blanks()) + (chance(5) ? racking() : "");
  }

  std::mt19937 random_;
  std::string text_;
  int yarns_ = 0;
  bool begun_ = false;  // a course was written: headers are too late
};

}  // namespace loopwright
