#include "mechanics/tiled_history.hpp"

#include <algorithm>
#include <tuple>

#include "mechanics/contact/segment_pairs.hpp"

namespace loopwright {
namespace {

// A segment of the piece and what it is a copy of: segments of the cell are counted over all its yarns.
struct Copy {
  std::int32_t of = 0, m = 0, n = 0;
  std::int32_t segment = 0;  // of the piece, counted over all its yarns
};

bool before(const Copy& a, const Copy& b) { return std::tie(a.of, a.m, a.n) < std::tie(b.of, b.m, b.n); }

// All segments of the piece, sorted by what they are copies of.
class Copies {
 public:
  Copies(const Fabric& cell, const StartFromCell& start) {
    std::vector<std::int32_t> first{0};  // segment of every yarn of the cell
    for (const FabricYarn& yarn : cell.yarns) first.push_back(first.back() + yarn.segments());
    for (const auto& yarn : start.images)
      for (const SegmentImage& image : yarn)
        copies_.push_back({first[static_cast<std::size_t>(image.yarn)] + image.segment, image.shift[0],
                           image.shift[1], static_cast<std::int32_t>(copies_.size())});
    std::sort(copies_.begin(), copies_.end(), before);
  }
  // visit(copy, other) for all copies of segment a; other: that of segment b at image (m, n) from it, or
  // null.
  template <class Visit>
  void each_pair(std::int32_t a, std::int32_t b, int m, int n, const Visit& visit) const {
    const auto [begin, end] =
        std::equal_range(copies_.begin(), copies_.end(), Copy{a, 0, 0, 0},
                         [](const Copy& one, const Copy& other) { return one.of < other.of; });
    for (auto copy = begin; copy != end; ++copy) {
      const Copy wanted{b, copy->m + m, copy->n + n, 0};
      const auto other = std::lower_bound(copies_.begin(), copies_.end(), wanted, before);
      visit(*copy, other == copies_.end() || before(wanted, *other) ? nullptr : &*other);
    }
  }

 private:
  std::vector<Copy> copies_;
};

}  // namespace

ContactHistory tiled_history(const Fabric& cell, const ContactHistory& history, const StartFromCell& start) {
  const Copies copies(cell, start);
  ContactHistory tiled;
  for (const ContactSlip& contact : history)
    copies.each_pair(contact.a, contact.b, contact.m, contact.n, [&](const Copy& a, const Copy* b) {
      if (!b) return;
      const bool in_order = a.segment < b->segment;  // pairs are listed once, the lower segment first
      tiled.push_back({std::min(a.segment, b->segment), std::max(a.segment, b->segment), 0, 0,
                       in_order ? contact.slip : -contact.slip});
    });
  std::sort(tiled.begin(), tiled.end(), [](const ContactSlip& a, const ContactSlip& b) {
    return std::tie(a.a, a.b) < std::tie(b.a, b.b);
  });
  tiled.shrink_to_fit();
  return tiled;
}

void hold_cut_contacts(const Fabric& cell, const ModelOptions& options, StartFromCell& start) {
  if (start.images.empty()) return;
  const YarnModel model = build_yarn_model(cell, options);
  SamplePlaces places;
  const std::vector<SegmentPair> pairs =
      pairs_within(model, build_yarn_state(cell), model.contact.outer, places);
  const Copies copies(cell, start);
  std::vector<std::uint8_t> cut;  // [segment of the piece]
  for (const auto& yarn : start.images) cut.resize(cut.size() + yarn.size(), 0);
  const auto mark = [&cut](const Copy& copy, const Copy* other) {
    if (!other) cut[static_cast<std::size_t>(copy.segment)] = 1;
  };
  for (const SegmentPair& pair : pairs) {
    copies.each_pair(pair.a, pair.b, pair.m, pair.n, mark);
    copies.each_pair(pair.b, pair.a, -pair.m, -pair.n, mark);
  }
  std::size_t segment = 0;
  for (FabricYarn& yarn : start.fabric.yarns)
    for (std::size_t e = 0; e < static_cast<std::size_t>(yarn.segments()); ++e, ++segment)
      if (cut[segment] != 0)
        std::fill_n(yarn.held.begin() + static_cast<std::ptrdiff_t>(e), 4, std::uint8_t{1});
}

}  // namespace loopwright
