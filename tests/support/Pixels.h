#pragma once
/// \file Pixels.h
/// \brief Reads a PNG with MRPT's image class, which is independent of the writer.

#include <mrpt/img/CImage.h>

#include <filesystem>
#include <stdexcept>
#include <utility>

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
  /// First and last column that is not white between two rows; (width, -1) if all are white.
  std::pair<int, int> inkColumns(int top, int bottom) const {
    std::pair<int, int> columns{width(), -1};
    for (int y = top; y < bottom; ++y)
      for (int x = 0; x < width(); ++x)
        if (at(x, y) != 0xffffffu) {
          columns.first = std::min(columns.first, x);
          columns.second = std::max(columns.second, x);
        }
    return columns;
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
