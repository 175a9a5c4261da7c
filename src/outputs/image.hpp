// Pictures in memory and as PNG files.
#pragma once
#include <array>
#include <cstdint>
#include <filesystem>
#include <vector>

namespace loopwright {

// Rows from top to bottom, 4 bytes a pixel: red, green, blue (sRGB), alpha (not premultiplied).
struct Image {
  int width = 0, height = 0;
  std::vector<std::uint8_t> pixels;

  std::array<std::uint8_t, 4> at(int x, int y) const {
    const std::size_t i =
        4 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x));
    return {pixels[i], pixels[i + 1], pixels[i + 2], pixels[i + 3]};
  }
};

// The bytes of an 8-bit PNG (RGBA, or RGB where every pixel is opaque). Throws FileError for an empty
// picture.
std::vector<std::uint8_t> png_bytes(const Image& image);

// Writes them. Throws FileError.
void write_png(const std::filesystem::path& path, const Image& image);

}  // namespace loopwright
