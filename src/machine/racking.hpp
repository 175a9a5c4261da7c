// Racking: how far the back bed stands to the right of the front bed, in needle pitches. This file owns the
// sign.
#pragma once
#include <cmath>
#include <cstdio>
#include <string>

#include "notation/program.hpp"

namespace loopwright {

// At racking R the back needle B faces the front needle B + R (knitout 0.5 and later). A fraction is the
// all-needle position: the back needle stands between front needles B + floor(R) and B + floor(R) + 1, and
// faces none. Shima's quarter pitch and Kniterate's half pitch give the same order of needles, so only
// "between" matters for it.
class Racking {
 public:
  explicit Racking(double value = 0)
      : value_(value),
        whole_(static_cast<long long>(std::floor(value))),
        between_(value != std::floor(value)) {}

  double value() const { return value_; }
  bool between() const { return between_; }
  long long whole() const { return whole_; }  // floor of the racking

  // Front needle that a back needle faces, or the one to its left in an all-needle position.
  long long front_index(int back_index) const { return back_index + whole_; }

  // Place on the common axis, in needle pitches: front i -> i, back i -> i + R.
  double slot(Needle needle) const { return is_front(needle.bed) ? needle.index : needle.index + value_; }

  // Place on the common axis in half pitches, for the order of needles: an all-needle position counts as
  // half-way.
  long long order(Needle needle) const {
    return is_front(needle.bed) ? 2LL * needle.index : 2 * front_index(needle.index) + (between_ ? 1 : 0);
  }

  // Whether loops can be moved between two needles of opposite beds.
  bool face(Needle a, Needle b) const {
    return is_front(a.bed) != is_front(b.bed) && !between_ && order(a) == order(b);
  }

  friend bool operator==(const Racking& a, const Racking& b) { return a.value_ == b.value_; }

 private:
  double value_;
  long long whole_;
  bool between_;
};

// As a programme would write it, e.g. "-0.75".
inline std::string to_string(const Racking& racking) {
  char text[32];
  std::snprintf(text, sizeof text, "%g", racking.value());
  return text;
}

}  // namespace loopwright
