// Typed indices: a LoopId is not a YarnId. -1 means none.
#pragma once
#include <compare>
#include <cstddef>
#include <cstdint>
#include <functional>

namespace loopwright {

template <class Tag>
struct Index {
  std::int32_t value = -1;

  constexpr Index() = default;
  constexpr explicit Index(std::int32_t v) : value(v) {}
  constexpr explicit Index(std::size_t v) : value(static_cast<std::int32_t>(v)) {}
  constexpr bool valid() const { return value >= 0; }
  constexpr std::size_t position() const { return static_cast<std::size_t>(value); }  // for vector access
  friend constexpr auto operator<=>(const Index&, const Index&) = default;
};

using LoopId = Index<struct LoopTag>;
using YarnId = Index<struct YarnTag>;
using CarrierId = Index<struct CarrierTag>;

}  // namespace loopwright

template <class Tag>
struct std::hash<loopwright::Index<Tag>> {
  std::size_t operator()(loopwright::Index<Tag> i) const noexcept {
    return std::hash<std::int32_t>()(i.value);
  }
};
