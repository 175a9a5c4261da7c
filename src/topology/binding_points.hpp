// Binding points and bonding points: the sites where loops hold each other, in the words of the two papers.
//
// A binding point (first paper) is the site where a loop is drawn through others: the lower binding point O
// of the loop that is drawn lies on the upper binding point P of each loop that it is drawn through, and the
// site is the place of a mass. In plain fabric P of the loop below is O of the loop above; a stack brings
// several P to one O, plating several O to one P, and a split gives one P two O at different times. A loop
// without parents (cast-on, tuck) has its O for itself, a loop without children (held, dropped) its P.
//
// The bonding points (second paper) are the four contacts of a stitch, each with its place in the stitch and
// the needle bed: the two at the bottom belong to the loop's lower binding point, the two at the top to its
// upper one.
#pragma once
#include <array>
#include <vector>

#include "topology/yarn_graph.hpp"

namespace loopwright {

struct BindingPoint {
  std::vector<LoopId> upper_of;  // loops whose heads are here (P), by id
  std::vector<LoopId> lower_of;  // loops whose feet are here (O), by id
  // Where the oldest loop of `lower_of` was formed; if there is none, where the head of `upper_of` was last.
  double slot = 0;
  Bed bed = Bed::front;
};

enum class BondingPlace : std::uint8_t { bottom_left, top_left, top_right, bottom_right };

struct BondingPoint {
  LoopId loop;
  BondingPlace place = BondingPlace::bottom_left;
  Bed bed = Bed::front;    // bottom: on which the loop was formed; top: on which its head was last held
  int binding_point = -1;  // index into BindingPoints::points
};

struct BindingPoints {
  std::vector<BindingPoint> points;
  std::vector<int> lower, upper;                     // by loop: indices of its O and P in `points`
  std::vector<std::array<BondingPoint, 4>> bonding;  // by loop, in the order of BondingPlace
};

// Every loop's O and P and four bonding points; points in the order of the loops that first use them, O
// before P.
BindingPoints binding_points(const YarnGraph& graph);

// The bonding points of a loop in the order in which its yarn meets them: from bottom left over the head to
// bottom right if it was formed to the right, the other way round if to the left.
std::array<BondingPoint, 4> in_yarn_order(const BindingPoints& points, const YarnGraph& graph, LoopId loop);

}  // namespace loopwright
