#pragma once
// Reads a PNG with MRPT's image class, which is independent of the writer.

#include <mrpt/img/CImage.h>

#include <filesystem>
#include <stdexcept>

namespace polemcl::report {

class Pixels {
 public:
  explicit Pixels(const std::filesystem::path& file) {
    if (!m_image.loadFromFile(file.string()))
      throw std::runtime_error("no image: " + file.string());
  }
  int width() const { return static_cast<int>(m_image.getWidth()); }
  int height() const { return static_cast<int>(m_image.getHeight()); }
  /// 0xRRGGBB.
  unsigned at(int x, int y) const {
    const auto column = static_cast<unsigned>(x), row = static_cast<unsigned>(y);
    const auto channel = [&](int c) {
      return static_cast<unsigned>(m_image.at<std::uint8_t>(column, row, static_cast<int8_t>(c)));
    };
    return channel(2) << 16 | channel(1) << 8 | channel(0);  // stored as BGR
  }
  std::size_t count(unsigned color) const {
    std::size_t pixels = 0;
    for (int y = 0; y < height(); ++y)
      for (int x = 0; x < width(); ++x) pixels += at(x, y) == color;
    return pixels;
  }

 private:
  mrpt::img::CImage m_image;
};

}  // namespace polemcl::report
