// Places of a piece that are brought to rest by themselves.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <tuple>

#include "geometry/interlacing.hpp"
#include "mechanics/fabrics.hpp"
#include "mechanics/hot_spots.hpp"

namespace loopwright {
namespace {

struct Piece {
  YarnModel model;
  YarnState state;
  ContactHistory history;
  Fabric fabric;
};

// Plain with friction, relaxed once for all tests.
const Piece& at_rest() {
  static const Piece piece = [] {
    RelaxOptions options = with_friction(0.25, 1e-8);
    const RelaxResult rest = relax(knitted("g", "held", "16 wales x 16 courses"), options);
    EXPECT_TRUE(rest.converged) << rest.message;
    options.model.plates = rest.plates;
    return Piece{build_yarn_model(rest.fabric, options.model), build_yarn_state(rest.fabric), rest.history,
                 rest.fabric};
  }();
  return piece;
}

Unknowns forces(const Piece& piece, const YarnState& state, const ContactHistory& history) {
  Assembly assembly(piece.model);
  assembly.set_history(history);
  assembly.update_pairs(state, piece.model.contact.outer + 0.6);
  Unknowns gradient;
  BlockMatrix unused;
  assembly.hessian(state, gradient, unused);
  return gradient;
}

double largest(const Unknowns& gradient) {
  double most = 0;
  for (const Vec3& f : gradient.u) most = std::max(most, norm(f));
  return most;
}

// A free control point near the middle of the piece.
std::size_t middle_node(const Piece& piece) {
  Vec3 middle;
  for (const Vec3& p : piece.state.nodes) middle += p / static_cast<double>(piece.state.nodes.size());
  std::size_t nearest = 0;
  for (std::size_t i = 0; i < piece.state.nodes.size(); ++i)
    if (piece.model.held[i] == 0 &&
        distance(piece.state.nodes[i], middle) < distance(piece.state.nodes[nearest], middle))
      nearest = i;
  return nearest;
}

// Yarn pushed out of its place in the middle of a piece at rest goes back by itself; what is far from it does
// not move, nor does what friction knows of it change.
TEST(HotSpots, GoBackToRestByThemselves) {
  const Piece& piece = at_rest();
  const std::size_t pushed = middle_node(piece);
  YarnState state = piece.state;
  for (std::size_t i = pushed; i < pushed + 2; ++i) state.nodes[i] += Vec3{0.05, -0.04, 0.1};
  ContactHistory history = piece.history;
  const YarnState before = state;
  const Unknowns gradient = forces(piece, state, history);
  ASSERT_GT(largest(gradient), 1);
  const SpotsReport report = settle_hot_spots(piece.model, gradient, 2e-4, state, piece.history);
  history = report.history;
  EXPECT_EQ(report.spots, 1);
  EXPECT_GT(report.iterations, 1);
  EXPECT_LT(largest(forces(piece, state, history)), 0.02 * largest(gradient));

  int moved = 0;
  for (std::size_t i = 0; i < state.nodes.size(); ++i) {
    if (state.nodes[i] == before.nodes[i]) continue;
    ++moved;
    EXPECT_LT(distance(before.nodes[i], before.nodes[pushed]), 16);
    EXPECT_LT(distance(state.nodes[i], piece.state.nodes[i]), 0.3);
  }
  EXPECT_GT(moved, 10);
  EXPECT_LT(moved, static_cast<int>(state.nodes.size()) / 3);
  const auto key = [](const ContactSlip& c) { return std::tie(c.a, c.b, c.m, c.n); };
  EXPECT_TRUE(std::is_sorted(history.begin(), history.end(),
                             [&](const auto& a, const auto& b) { return key(a) < key(b); }));
  EXPECT_FALSE(history.empty());
  // The first yarn lies at the piece's lower edge.
  const auto segments = piece.model.yarns[0].segments;
  const auto of_first = [&](const ContactHistory& all) {
    std::vector<double> slips;
    for (const ContactSlip& c : all)
      if (c.a < segments && c.b < segments) slips.insert(slips.end(), {c.slip.x, c.slip.y, c.slip.z});
    return slips;
  };
  EXPECT_EQ(of_first(history), of_first(piece.history));
  const InterlacingCheck check = check_interlacings(with_state(piece.fabric, state));
  EXPECT_EQ(check.intact, check.expected);
}

TEST(HotSpots, NothingIsDoneWhereForcesAreSpread) {
  const Piece& piece = at_rest();
  YarnState state = piece.state;
  for (Vec3& p : state.nodes) p.x *= 1.02;
  const YarnState before = state;
  ContactHistory history;
  EXPECT_EQ(settle_hot_spots(piece.model, forces(piece, state, history), 2e-4, state, history).spots, 0);
  EXPECT_EQ(state.nodes, before.nodes);
}

// A yarn's twist is that of its whole length, and a cell's images are not known to a spot.
TEST(HotSpots, NothingIsDoneWithTwistOrInCells) {
  Piece piece = at_rest();
  YarnState state = piece.state;
  state.nodes[middle_node(piece)] += Vec3{0, 0, 0.3};
  ContactHistory history;
  const Unknowns gradient = forces(piece, state, history);
  for (YarnModel::Yarn& yarn : piece.model.yarns) yarn.twist_stiffness = 0.3;
  EXPECT_EQ(settle_hot_spots(piece.model, gradient, 2e-4, state, history).spots, 0);
  for (YarnModel::Yarn& yarn : piece.model.yarns) yarn.twist_stiffness = 0;
  piece.model.periodic = true;
  EXPECT_EQ(settle_hot_spots(piece.model, gradient, 2e-4, state, history).spots, 0);
  piece.model.periodic = false;
  EXPECT_EQ(settle_hot_spots(piece.model, gradient, 2e-4, state, history).spots, 1);
}

}  // namespace
}  // namespace loopwright
