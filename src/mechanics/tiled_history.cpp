#include "mechanics/tiled_history.hpp"

#include <algorithm>
#include <tuple>

namespace loopwright {
namespace {

// A segment of the piece and what it is a copy of: segments of the cell are counted over all its yarns.
struct Copy {
  std::int32_t of = 0, m = 0, n = 0;
  std::int32_t segment = 0;  // of the piece, counted over all its yarns
};

bool before(const Copy& a, const Copy& b) { return std::tie(a.of, a.m, a.n) < std::tie(b.of, b.m, b.n); }

}  // namespace

ContactHistory tiled_history(const Fabric& cell, const ContactHistory& history, const StartFromCell& start) {
  std::vector<std::int32_t> first{0};  // segment of every yarn of the cell
  for (const FabricYarn& yarn : cell.yarns) first.push_back(first.back() + yarn.segments());
  std::vector<Copy> copies;
  for (const auto& yarn : start.images)
    for (const SegmentImage& image : yarn)
      copies.push_back({first[static_cast<std::size_t>(image.yarn)] + image.segment, image.shift[0],
                        image.shift[1], static_cast<std::int32_t>(copies.size())});
  std::sort(copies.begin(), copies.end(), before);
  const auto copies_of = [&](std::int32_t segment) {
    return std::equal_range(copies.begin(), copies.end(), Copy{segment, 0, 0, 0},
                            [](const Copy& a, const Copy& b) { return a.of < b.of; });
  };

  ContactHistory tiled;
  for (const ContactSlip& contact : history) {
    const auto [begin, end] = copies_of(contact.a);
    for (auto a = begin; a != end; ++a) {
      const Copy wanted{contact.b, a->m + contact.m, a->n + contact.n, 0};
      const auto b = std::lower_bound(copies.begin(), copies.end(), wanted, before);
      if (b == copies.end() || before(wanted, *b)) continue;
      const bool in_order = a->segment < b->segment;  // pairs are listed once, the lower segment first
      tiled.push_back({std::min(a->segment, b->segment), std::max(a->segment, b->segment), 0, 0,
                       in_order ? contact.slip : -contact.slip});
    }
  }
  std::sort(tiled.begin(), tiled.end(), [](const ContactSlip& a, const ContactSlip& b) {
    return std::tie(a.a, a.b) < std::tie(b.a, b.b);
  });
  tiled.shrink_to_fit();
  return tiled;
}

}  // namespace loopwright
