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
std::vector<std::uint8_t> png_bytes(const Image& image) {
  if (image.width <= 0 || image.height <= 0 ||
      image.pixels.size() !=
          4 * static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height))
    throw FileError("the picture is empty");
  const bool plain = opaque(image);
  const std::vector<std::uint8_t> rgb = plain ? without_alpha(image) : std::vector<std::uint8_t>{};
  png_image header{};
  header.version = PNG_IMAGE_VERSION;
  header.width = static_cast<png_uint_32>(image.width);
  header.height = static_cast<png_uint_32>(image.height);
  header.format = plain ? PNG_FORMAT_RGB : PNG_FORMAT_RGBA;
  header.flags = PNG_IMAGE_FLAG_FAST;
  const void* pixels = plain ? rgb.data() : image.pixels.data();
  png_alloc_size_t size = PNG_IMAGE_PNG_SIZE_MAX(header);
  std::vector<std::uint8_t> bytes(size);
  if (png_image_write_to_memory(&header, bytes.data(), &size, 0, pixels, 0, nullptr) == 0)
    throw FileError(header.message);
  bytes.resize(size);
  return bytes;
}

void write_png(const std::filesystem::path& path, const Image& image) {
  AtomicFile file(path);
  try {
    const std::vector<std::uint8_t> bytes = png_bytes(image);
    file.stream().write(reinterpret_cast<const char*>(bytes.data()),
                        static_cast<std::streamsize>(bytes.size()));
  } catch (const FileError& fault) {
    throw FileError("cannot write " + path.string() + ": " + fault.what());
  }
  file.commit();
}

}  // namespace loopwright
