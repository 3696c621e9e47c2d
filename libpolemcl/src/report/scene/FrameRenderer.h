#pragma once
/// \file FrameRenderer.h
/// \brief A scene as a PNG, without a display.

#include <filesystem>
#include <memory>

#include <polemcl/mrpt/common/Compatibility.h>

namespace polemcl::report {

/// \brief Renders at twice the size and halves the picture, for smooth edges. To be made, used and
/// destroyed in one thread: OpenGL's contexts belong to threads.
class FrameRenderer {
 public:
  /// \brief Factor for letters and points: they fill the same share of the picture at any height.
  static constexpr double textScale(unsigned height) { return 2 * height / 720.0; }
  /// \param width,height Size of the pictures, pixels.
  /// \throws Error when OpenGL cannot be had off-screen.
  FrameRenderer(unsigned width, unsigned height);
  ~FrameRenderer();
  FrameRenderer(const FrameRenderer&) = delete;
  FrameRenderer& operator=(const FrameRenderer&) = delete;

  /// \throws Error when the file, a `.png`, cannot be written. It is written in place.
  void render(const viz::Scene& scene, const std::filesystem::path& file);

 private:
  struct Buffer;
  std::unique_ptr<Buffer> m_buffer;
};

}  // namespace polemcl::report
