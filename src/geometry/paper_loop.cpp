#include "geometry/paper_loop.hpp"

namespace loopwright {

Vec3 paper_lower(int course, int wale, double r) { return {8 * wale * r, 7 * course * r, 0}; }

Vec3 paper_upper(const Vec3& lower, double r) { return lower + Vec3{0, 7 * r, 0}; }

std::array<Vec3, 9> paper_loop(const Vec3& lower, const Vec3& upper, const Vec3& lower_left,
                               const Vec3& lower_right, double r) {
  const Vec3 middle = (lower + upper) / 2;
  return {(lower + lower_left) / 2 + Vec3{0, -3 * r, -1.5 * r},    // T0, eq. (5)
          lower + Vec3{-r, 0, 0},                                  // T1, eq. (4)
          middle + Vec3{-2 * r, 0, 1.5 * r},                       // T2, eq. (3)
          upper + Vec3{-3 * r, 0, 0},                              // T3
          upper + Vec3{0, 3 * r, -1.5 * r},                        // T4
          upper + Vec3{3 * r, 0, 0},                               // T5
          middle + Vec3{2 * r, 0, 1.5 * r},                        // T6
          lower + Vec3{r, 0, 0},                                   // T7
          (lower + lower_right) / 2 + Vec3{0, -3 * r, -1.5 * r}};  // T8
}

}  // namespace loopwright
