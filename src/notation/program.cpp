#include "notation/program.hpp"

namespace loopwright {

std::string to_string(Needle needle) {
  std::string text = is_front(needle.bed) ? "f" : "b";
  if (is_slider(needle.bed)) text += 's';
  return text + std::to_string(needle.index);
}

}  // namespace loopwright
