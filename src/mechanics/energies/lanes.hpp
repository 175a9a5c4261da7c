// Several doubles at once, each in a lane of its own: what is written for one number serves them too. They go
// by reference, never by value: how they are passed by value depends on the processor that is compiled for.
#pragma once
#include <cmath>
#include <cstddef>

#include "base/wide.hpp"

namespace loopwright {

using Lanes = double __attribute__((vector_size(32)));
inline constexpr std::size_t lanes = sizeof(Lanes) / sizeof(double);

inline void square_root(const double& x, double& root) { root = std::sqrt(x); }
LOOPWRIGHT_INLINE void square_root(const Lanes& x, Lanes& root) {
  for (std::size_t l = 0; l < lanes; ++l) root[l] = std::sqrt(x[l]);
}

}  // namespace loopwright
