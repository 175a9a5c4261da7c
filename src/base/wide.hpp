// A function marked LOOPWRIGHT_WIDE is compiled twice, the second time for processors with four doubles in a
// vector; which one runs is chosen when the program starts. No fused products, so both give the same numbers.
// What it calls is compiled twice as well if it is LOOPWRIGHT_INLINE.
#pragma once

#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) && !defined(__SANITIZE_ADDRESS__) && \
    !defined(__SANITIZE_THREAD__)
#define LOOPWRIGHT_WIDE __attribute__((target_clones("avx2", "default")))
#else
#define LOOPWRIGHT_WIDE
#endif

#if defined(__GNUC__)
#define LOOPWRIGHT_INLINE inline __attribute__((always_inline))
#define LOOPWRIGHT_INLINE_LAMBDA __attribute__((always_inline))
#else
#define LOOPWRIGHT_INLINE inline
#define LOOPWRIGHT_INLINE_LAMBDA
#endif
