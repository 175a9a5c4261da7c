#include "outputs/image.hpp"

#include <png.h>

#include "outputs/atomic_file.hpp"

namespace loopwright {
namespace {

bool opaque(const Image& image) {
  for (std::size_t i = 3; i < image.pixels.size(); i += 4)
    if (image.pixels[i] != 255) return false;
  return true;
}

std::vector<std::uint8_t> without_alpha(const Image& image) {
  std::vector<std::uint8_t> rgb;
  rgb.reserve(image.pixels.size() / 4 * 3);
  for (std::size_t i = 0; i < image.pixels.size(); i += 4)
    rgb.insert(rgb.end(), image.pixels.begin() + static_cast<std::ptrdiff_t>(i),
               image.pixels.begin() + static_cast<std::ptrdiff_t>(i) + 3);
  return rgb;
}

}  // namespace

// libpng's simplified interface: it reports errors by value, where the older one jumps over destructors.
void write_png(const std::filesystem::path& path, const Image& image) {
  if (image.width <= 0 || image.height <= 0 ||
      image.pixels.size() !=
          4 * static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height))
    throw FileError("cannot write " + path.string() + ": the picture is empty");
  AtomicFile file(path);
  const bool plain = opaque(image);
  const std::vector<std::uint8_t> rgb = plain ? without_alpha(image) : std::vector<std::uint8_t>{};
  png_image header{};
  header.version = PNG_IMAGE_VERSION;
  header.width = static_cast<png_uint_32>(image.width);
  header.height = static_cast<png_uint_32>(image.height);
  header.format = plain ? PNG_FORMAT_RGB : PNG_FORMAT_RGBA;
  header.flags = PNG_IMAGE_FLAG_FAST;
  const void* bytes = plain ? rgb.data() : image.pixels.data();
  if (png_image_write_to_file(&header, file.temporary().c_str(), 0, bytes, 0, nullptr) == 0)
    throw FileError("cannot write " + path.string() + ": " + header.message);
  file.commit();
}

}  // namespace loopwright
