#include "outputs/exchange/beam_chains.hpp"

#include <algorithm>
#include <cmath>

namespace loopwright {
namespace {

struct Cell {
  int m = 0, n = 0;
  friend bool operator==(const Cell&, const Cell&) = default;
};

// Lattice coordinates of a place: in the cell where both are from 0 to 1.
std::array<double, 2> fractions(const Fabric& fabric, const Vec3& p) {
  const double eta = p.y / fabric.height;
  return {(p.x - eta * fabric.skew) / fabric.width, eta};
}

Cell cell_of(const Fabric& fabric, const Vec3& p) {
  const auto [xi, eta] = fractions(fabric, p);
  return {static_cast<int>(std::floor(xi)), static_cast<int>(std::floor(eta))};
}

// Where a yarn goes from one cell into the next: one step of m or of n.
struct Cut {
  double t = 0;
  Cell from, to;
};

// The place between t0 and t1 where coordinate `axis` passes `level`, by halving; it does pass there.
double passing(const Fabric& fabric, const FabricYarn& yarn, double t0, double t1, std::size_t axis,
               double level) {
  const bool rises = fractions(fabric, position(fabric, yarn, t0))[axis] < level;
  for (int k = 0; k < 60; ++k) {
    const double middle = 0.5 * (t0 + t1);
    ((fractions(fabric, position(fabric, yarn, middle))[axis] < level) == rises ? t0 : t1) = middle;
  }
  return 0.5 * (t0 + t1);
}

// All cuts of one period, in order.
std::vector<Cut> cuts_of(const Fabric& fabric, const FabricYarn& yarn) {
  constexpr int steps = 8;  // a segment; what leaves and comes back within one is not cut
  std::vector<Cut> cuts;
  Cell now = cell_of(fabric, position(fabric, yarn, 0));
  for (int k = 1; k <= yarn.segments() * steps; ++k) {
    const double before = static_cast<double>(k - 1) / steps, t = static_cast<double>(k) / steps;
    const Cell next = cell_of(fabric, position(fabric, yarn, t));
    if (next == now) continue;
    // through a corner's neighbourhood both change: the earlier one first
    std::vector<std::pair<double, std::size_t>> passes;
    const std::array<int, 2> a{now.m, now.n}, b{next.m, next.n};
    for (std::size_t axis = 0; axis < 2; ++axis) {
      const int step = b[axis] > a[axis] ? 1 : -1;
      for (int at = a[axis]; at != b[axis]; at += step)
        passes.emplace_back(passing(fabric, yarn, before, t, axis, step > 0 ? at + 1 : at), axis);
    }
    std::sort(passes.begin(), passes.end());
    for (const auto& [where, axis] : passes) {
      Cell to = now;
      int& index = axis == 0 ? to.m : to.n;
      index += (axis == 0 ? next.m > now.m : next.n > now.n) ? 1 : -1;
      cuts.push_back({where, now, to});
      now = to;
    }
  }
  return cuts;
}

BeamChain chain_between(const Fabric& fabric, std::size_t yarn, double t0, double t1, const Vec3& moved,
                        const ExportOptions& options) {
  const FabricYarn& of = fabric.yarns[yarn];
  int steps = std::max(1, static_cast<int>(std::lround((t1 - t0) * options.per_segment)));
  if (options.quadratic_beams) steps += steps % 2;
  BeamChain chain;
  chain.yarn = yarn;
  for (int k = 0; k <= steps; ++k)
    chain.places.push_back(position(fabric, of, t0 + (t1 - t0) * k / steps) + moved);
  return chain;
}

CellFace face_left_through(const Cut& cut) {
  if (cut.to.m != cut.from.m) return cut.to.m > cut.from.m ? CellFace::right : CellFace::left;
  return cut.to.n > cut.from.n ? CellFace::top : CellFace::bottom;
}

CellFace opposite(CellFace face) {
  switch (face) {
    case CellFace::left:
      return CellFace::right;
    case CellFace::right:
      return CellFace::left;
    case CellFace::bottom:
      return CellFace::top;
    case CellFace::top:
      break;
  }
  return CellFace::bottom;
}

// The last two nodes of a cut onto their faces, to the bit, and one lattice vector apart.
void put_on_faces(const Fabric& fabric, BeamChains& all) {
  const auto& [out, in] = all.cuts.back();
  const bool outward = out.face == CellFace::right || out.face == CellFace::top;
  const FaceNode &near = outward ? in : out, &far = outward ? out : in;
  Vec3& at_origin = all.chains[near.chain].places[near.node];
  const bool across = near.face == CellFace::left;
  if (across)
    at_origin.x = at_origin.y / fabric.height * fabric.skew;
  else
    at_origin.y = 0;
  all.chains[far.chain].places[far.node] = at_origin + (across ? fabric.lattice(1, 0) : fabric.lattice(0, 1));
}

void add_periodic(const Fabric& fabric, std::size_t yarn, const ExportOptions& options, BeamChains& all) {
  const FabricYarn& of = fabric.yarns[yarn];
  std::vector<Cut> cuts = cuts_of(fabric, of);
  const auto home = [&fabric](const Cell& cell) { return fabric.lattice(-cell.m, -cell.n); };
  if (cuts.empty()) {  // a ring within the cell
    BeamChain chain = chain_between(fabric, yarn, 0, of.segments(),
                                    home(cell_of(fabric, position(fabric, of, 0))), options);
    chain.places.pop_back();
    chain.closed = true;
    all.chains.push_back(std::move(chain));
    return;
  }
  // From each cut to the next; the last one to the first of the next period.
  const std::size_t first = all.chains.size(), count = cuts.size();
  for (std::size_t k = 0; k < count; ++k) {
    const double end = k + 1 < count ? cuts[k + 1].t : cuts[0].t + of.segments();
    all.chains.push_back(chain_between(fabric, yarn, cuts[k].t, end, home(cuts[k].to), options));
  }
  for (std::size_t k = 0; k < count; ++k) {
    const std::size_t before = first + (k + count - 1) % count;
    const CellFace out = face_left_through(cuts[k]);
    all.cuts.push_back(
        {FaceNode{out, before, all.chains[before].places.size() - 1}, FaceNode{opposite(out), first + k, 0}});
    put_on_faces(fabric, all);
  }
}

}  // namespace

BeamChains beam_chains(const Fabric& fabric, const ExportOptions& options) {
  BeamChains all;
  for (std::size_t y = 0; y < fabric.yarns.size(); ++y) {
    const FabricYarn& yarn = fabric.yarns[y];
    if (fabric.periodic && yarn.periodic) {
      add_periodic(fabric, y, options, all);
      continue;
    }
    BeamChain chain = chain_between(fabric, y, 0, yarn.segments(), {}, options);
    chain.closed = yarn.periodic;
    if (chain.closed) chain.places.pop_back();
    all.chains.push_back(std::move(chain));
  }
  return all;
}

}  // namespace loopwright
