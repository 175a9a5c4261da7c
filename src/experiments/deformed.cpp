#include "experiments/deformed.hpp"

namespace loopwright {

Fabric deformed(const Fabric& fabric, double width, double height, double skew) {
  Fabric result = fabric;
  for (FabricYarn& yarn : result.yarns)
    for (Vec3& p : yarn.control_points) {
      const double eta = p.y / fabric.height, xi = (p.x - eta * fabric.skew) / fabric.width;
      p.x = xi * width + eta * skew;
      p.y = eta * height;
    }
  result.width = width, result.height = height, result.skew = skew;
  return result;
}

}  // namespace loopwright
