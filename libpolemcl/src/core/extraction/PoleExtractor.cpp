#include "core/extraction/PoleExtractor.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "core/extraction/range_image/RangeImageExtractor.h"
#include "core/extraction/scan_line/ScanLineExtractor.h"

namespace polemcl {

struct PoleExtractor::Impl {
  std::optional<NativeExtractor> native;
  std::optional<PaperExtractor> paper;
  std::vector<PoleDetection> poles;
  ExtractionReport report;
};

PoleExtractor::PoleExtractor(const SensorOptions& sensor, const ExtractionOptions& extraction)
    : m_impl(std::make_unique<Impl>()) {
  extraction.validate();
  sensor.validate();
  if (extraction.method == ExtractionMethod::native)
    m_impl->native.emplace(SensorModel(sensor), sensor, extraction.native);
  else
    m_impl->paper.emplace(sensor, extraction.paper);
}
PoleExtractor::PoleExtractor(const PinholeCamera& camera, const SensorOptions& sensor,
                             const NativeOptions& options)
    : m_impl(std::make_unique<Impl>()) {
  options.validate();
  sensor.validate();
  m_impl->native.emplace(SensorModel(camera), sensor, options);
}
PoleExtractor::~PoleExtractor() = default;
PoleExtractor::PoleExtractor(PoleExtractor&&) noexcept = default;
PoleExtractor& PoleExtractor::operator=(PoleExtractor&&) noexcept = default;

const std::vector<PoleDetection>& PoleExtractor::extract(const PointsView& points,
                                                         const Eigen::Vector2f& upright) {
  m_impl->poles.clear();
  m_impl->report = {};
  if (m_impl->native)
    m_impl->native->extract(points, upright, m_impl->poles, m_impl->report);
  else
    m_impl->paper->extract(points, m_impl->poles, m_impl->report);
  std::sort(m_impl->poles.begin(), m_impl->poles.end(),
            [](const PoleDetection& a, const PoleDetection& b) {
              const double aa = std::atan2(a.y, a.x), ab = std::atan2(b.y, b.x);
              return aa != ab ? aa < ab : a.x * a.x + a.y * a.y < b.x * b.x + b.y * b.y;
            });
  return m_impl->poles;
}

const std::vector<float>& PoleExtractor::freeRange() const {
  static const std::vector<float> none;
  return m_impl->native ? m_impl->native->freeRange() : none;
}

const ExtractionReport& PoleExtractor::report() const {
  return m_impl->report;
}

}  // namespace polemcl
