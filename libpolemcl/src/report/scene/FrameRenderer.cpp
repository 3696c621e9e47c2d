#include "report/scene/FrameRenderer.h"

#include <mrpt/img/CImage.h>
#include <mrpt/opengl/CFBORender.h>

#include <polemcl/core/common/Types.h>

namespace polemcl::report {

namespace {

struct Rectangle {
  int x = 0, y = 0, width = 0, height = 0;
};

/// A viewport's place in the picture, from its upper left corner. Positions up to 1 are shares.
Rectangle pixelsOf(viz::Viewport& viewport, int width, int height) {
  double x = 0, y = 0, w = 0, h = 0;
  viewport.getViewportPosition(x, y, w, h);
  const auto pixels = [](double value, int whole) {
    return static_cast<int>(value > 1 ? value : value * whole);
  };
  const Rectangle place{pixels(x, width), pixels(y, height), pixels(w, width), pixels(h, height)};
  return {place.x, height - place.y - place.height, place.width, place.height};
}

}  // namespace

struct FrameRenderer::Buffer {
  Buffer(unsigned width, unsigned height) : renderer(width, height) {}
  void render(const viz::Scene& scene, const viz::Viewport& viewport, mrpt::img::CImage& image) {
    renderer.setCamera(scene, viewport.getCamera());
    renderer.render_RGB(scene, image);
  }
  mrpt::opengl::CFBORender renderer;
  mrpt::img::CImage large, other, patch, small;
};

FrameRenderer::FrameRenderer(unsigned width, unsigned height) {
  try {
    m_buffer = std::make_unique<Buffer>(2 * width, 2 * height);
  } catch (const std::exception& error) {
    throw Error(
        std::string("frames cannot be rendered: OpenGL without a display (EGL) is missing: ") +
        error.what());
  }
}

FrameRenderer::~FrameRenderer() = default;

void FrameRenderer::render(const viz::Scene& scene, const std::filesystem::path& file) {
  Buffer& b = *m_buffer;
  b.render(scene, *scene.getViewport(), b.large);
  // CFBORender looks at all viewports with one camera: those over the main one, once more, and
  // without the main one's objects, which would take the time again.
  const auto show = [&](bool visible) {
    for (const auto& object : *scene.getViewport()) object->setVisibility(visible);
  };
  show(false);
  for (const auto& viewport : scene.viewports()) {
    if (viewport->getName() == "main" || viewport->empty()) continue;
    const Rectangle part = pixelsOf(*viewport, static_cast<int>(b.large.getWidth()),
                                    static_cast<int>(b.large.getHeight()));
    b.render(scene, *viewport, b.other);
    const auto pixels = [](int number) { return static_cast<unsigned>(number); };
    b.other.extract_patch(b.patch, pixels(part.x), pixels(part.y), pixels(part.width),
                          pixels(part.height));
    b.large.drawImage(part.x, part.y, b.patch);
  }
  show(true);
  b.large.scaleHalf(b.small, mrpt::img::IMG_INTERP_AREA);
  if (!b.small.saveToFile(file.string()))
    throw Error(file.string() + ": cannot be written: is the disk full?");
}

}  // namespace polemcl::report
