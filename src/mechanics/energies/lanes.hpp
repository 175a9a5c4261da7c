// Several doubles at once, each in a lane of its own: what is written for one number serves them too. They go
// by reference, never by value: how they are passed by value depends on the processor that is compiled for.
#pragma once
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>

#include "base/wide.hpp"

namespace loopwright {

using Lanes = double __attribute__((vector_size(32)));
inline constexpr std::size_t lanes = sizeof(Lanes) / sizeof(double);

LOOPWRIGHT_INLINE void load(const double* from, Lanes& to) { std::memcpy(&to, from, sizeof to); }

// Zeroes, stored one by one: what the compiler makes of `= {}` (a string instruction) takes longer than the
// sums that follow.
LOOPWRIGHT_INLINE void clear(double& x) { x = 0; }
LOOPWRIGHT_INLINE void clear(Lanes& x) { x = Lanes{}; }
template <class Inner, std::size_t count>
LOOPWRIGHT_INLINE void clear(std::array<Inner, count>& all) {
  for (std::size_t k = 0; k < count; ++k) clear(all[k]);
}

inline void square_root(const double& x, double& root) { root = std::sqrt(x); }
LOOPWRIGHT_INLINE void square_root(const Lanes& x, Lanes& root) {
  for (std::size_t l = 0; l < lanes; ++l) root[l] = std::sqrt(x[l]);
}

// Four lanes each, turned: what were lane k of a, b, c and d becomes the k-th.
LOOPWRIGHT_INLINE void transpose(Lanes& a, Lanes& b, Lanes& c, Lanes& d) {
  const Lanes ab_even = __builtin_shufflevector(a, b, 0, 4, 2, 6),
              ab_odd = __builtin_shufflevector(a, b, 1, 5, 3, 7),
              cd_even = __builtin_shufflevector(c, d, 0, 4, 2, 6),
              cd_odd = __builtin_shufflevector(c, d, 1, 5, 3, 7);
  a = __builtin_shufflevector(ab_even, cd_even, 0, 1, 4, 5);
  b = __builtin_shufflevector(ab_odd, cd_odd, 0, 1, 4, 5);
  c = __builtin_shufflevector(ab_even, cd_even, 2, 3, 6, 7);
  d = __builtin_shufflevector(ab_odd, cd_odd, 2, 3, 6, 7);
}

namespace lanes_detail {
using Bits = std::uint64_t __attribute__((vector_size(32)));
LOOPWRIGHT_INLINE void bits_of(const Lanes& x, Bits& bits) { std::memcpy(&bits, &x, sizeof bits); }
LOOPWRIGHT_INLINE void from_bits(const Bits& bits, Lanes& x) { std::memcpy(&x, &bits, sizeof x); }
inline constexpr double ln2_high = 0x1.62e42fefa0000p-1, ln2_low = 0x1.cf79abc9e3b3ap-40;
}  // namespace lanes_detail

// Natural logarithm of positive normal numbers, within some units of the last place. x = 2^k m with m round
// 1, log m = 2 artanh((m - 1) / (m + 1)) by its series.
LOOPWRIGHT_INLINE void logarithm(const Lanes& x, Lanes& result) {
  using namespace lanes_detail;
  constexpr std::uint64_t root_half = 0x3fe6a09e667f3bcd, bias = 1024;
  Bits bits;
  bits_of(x, bits);
  const Bits exponent = (bits - root_half + (bias << 52)) >> 52;
  Lanes k, m;
  from_bits(exponent | 0x4330000000000000, k);  // 2^52 + exponent
  k -= 0x1p52 + static_cast<double>(bias);
  from_bits(bits - ((exponent - bias) << 52), m);
  const Lanes s = (m - 1.0) / (m + 1.0), z = s * s;
  // Even and odd powers of z apart: two chains of sums, which do not wait for each other.
  const Lanes z2 = z * z;
  Lanes even = Lanes{} + 1.0 / 23, odd = Lanes{} + 1.0 / 21;
  for (int n = 19; n >= 3; n -= 4) even = even * z2 + 1.0 / n;
  for (int n = 17; n >= 5; n -= 4) odd = odd * z2 + 1.0 / n;
  const Lanes series = even + z * odd;
  result = k * ln2_high + (2.0 * s + (2.0 * s * z * series + k * ln2_low));
}

// e^x for |x| up to 700 (what is beyond is taken for that), within some units of the last place.
LOOPWRIGHT_INLINE void exponential(const Lanes& power, Lanes& result) {
  using namespace lanes_detail;
  constexpr double round_to_integer = 0x1.8p52, most = 700;
  Lanes x = power > most ? Lanes{} + most : power;
  x = x < -most ? Lanes{} - most : x;
  const Lanes rounded = x * 1.4426950408889634 + round_to_integer, n = rounded - round_to_integer;
  const Lanes r = (x - n * ln2_high) - n * ln2_low;
  // Even and odd powers apart, as above.
  const Lanes r2 = r * r;
  Lanes odd = Lanes{} + 1.0 / 6227020800.0, even = Lanes{} + 1.0 / 479001600.0;  // 1 / 13!, 1 / 12!
  double factorial = 479001600.0;
  for (int k = 12; k >= 2; k -= 2) {
    odd = odd * r2 + k / factorial;  // 1 / (k - 1)!
    factorial /= k * (k - 1);
    even = even * r2 + 1.0 / factorial;
  }
  const Lanes series = even + r * odd;
  Bits two_to_n, value;
  bits_of(rounded, two_to_n);
  bits_of(series, value);
  from_bits(value + (two_to_n << 52), result);
}

}  // namespace loopwright
