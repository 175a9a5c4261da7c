// Whatever bytes come in, the readers of curve files must come back with sound curves or say what is wrong,
// and what they found must become yarn or be refused. The first byte chooses the reader.
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <stdexcept>

#include "geometry/linking.hpp"
#include "outputs/atomic_file.hpp"
#include "outputs/exchange/curves_to_fabric.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace loopwright;
  if (size == 0) return 0;
  const std::string_view bytes(reinterpret_cast<const char*>(data) + 1, size - 1);
  try {
    const CurveFile file = data[0] % 3 == 0   ? read_bcc(bytes, "fuzz.bcc")
                           : data[0] % 3 == 1 ? read_yarns(bytes, "fuzz.yarns")
                                              : read_obj_curves(bytes, "fuzz.obj");
    std::size_t points = 0;
    if (file.curves.empty()) std::abort();
    for (const FileCurve& curve : file.curves) {
      points += curve.points.size();
      for (const Vec3& p : curve.points)
        if (!is_finite(p)) std::abort();
    }
    if (points > size) std::abort();  // never more than the bytes can hold
    CurveOptions options;
    options.most_segments = 2e4;
    const Fabric fabric = fabric_of_curves(file, options).fabric;
    for (const FabricYarn& yarn : fabric.yarns) {
      if (yarn.segments() < 4 || !(yarn.segment_rest_length > 0) || !(yarn.diameter > 0)) std::abort();
      for (const Vec3& q : yarn.control_points)
        if (!is_finite(q)) std::abort();
    }
    linking_numbers(fabric);
  } catch (const FileError&) {
  } catch (const std::invalid_argument&) {
  }
  return 0;
}
