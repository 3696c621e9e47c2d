#include <algorithm>
#include <cmath>
#include <optional>

#include <polemcl/core/extraction/PoleExtractor.h>
#include "core/common/Binder.h"
#include "core/extraction/range_image/RangeImageExtractor.h"
#include "core/extraction/scan_line/ScanLineExtractor.h"
#include "core/sensor/PinholeCamera.h"

namespace polemcl {
namespace {

/// Corrects the distances as `range_offset_m` and `range_scale` say.
void correctDistances(const SensorOptions& sensor, std::vector<PoleDetection>& poles) {
  if (sensor.rangeOffset == 0 && sensor.rangeScale == 1) return;
  for (PoleDetection& pole : poles) {
    const double distance = std::hypot(pole.x, pole.y);
    if (distance <= 0) continue;
    const double factor = std::max(0.0, sensor.rangeScale + sensor.rangeOffset / distance);
    pole.x *= factor;
    pole.y *= factor;
  }
}

}  // namespace

struct PoleExtractor::Impl {
  SensorOptions sensor;
  std::optional<ScanLineExtractor> scanLine;
  std::optional<RangeImageExtractor> rangeImage;
  std::vector<PoleDetection> poles;
  ExtractionReport report;

  explicit Impl(const SensorOptions& options) : sensor(options) {}
  void emplace(const SensorModel& beams, const ExtractionOptions& extraction) {
    if (extraction.method == ExtractionMethod::scanLine)
      scanLine.emplace(beams, sensor, extraction.scanLine);
    else
      rangeImage.emplace(beams, sensor, extraction.rangeImage);
  }
};

PoleExtractor::PoleExtractor(const SensorOptions& sensor, const ExtractionOptions& extraction)
    : m_impl(std::make_unique<Impl>(sensor)) {
  checkOptions(extraction);
  checkOptions(sensor);
  m_impl->emplace(SensorModel(sensor), extraction);
}
PoleExtractor::PoleExtractor(const PinholeCamera& camera, const SensorOptions& sensor,
                             const ExtractionOptions& extraction)
    : m_impl(std::make_unique<Impl>(sensor)) {
  checkOptions(extraction);
  checkOptions(sensor);
  m_impl->emplace(SensorModel(camera), extraction);
}
PoleExtractor::~PoleExtractor() = default;
PoleExtractor::PoleExtractor(PoleExtractor&&) noexcept = default;
PoleExtractor& PoleExtractor::operator=(PoleExtractor&&) noexcept = default;

const std::vector<PoleDetection>& PoleExtractor::extract(const PointsView& points,
                                                         const Eigen::Vector2f& upright) {
  m_impl->poles.clear();
  m_impl->report = {};
  if (m_impl->scanLine)
    m_impl->scanLine->extract(points, upright, m_impl->poles, m_impl->report);
  else
    m_impl->rangeImage->extract(points, m_impl->poles, m_impl->report);
  correctDistances(m_impl->sensor, m_impl->poles);
  std::sort(m_impl->poles.begin(), m_impl->poles.end(),
            [](const PoleDetection& a, const PoleDetection& b) {
              const double aa = std::atan2(a.y, a.x), ab = std::atan2(b.y, b.x);
              return aa != ab ? aa < ab : a.x * a.x + a.y * a.y < b.x * b.x + b.y * b.y;
            });
  return m_impl->poles;
}

const std::vector<float>& PoleExtractor::visibilityRange() const {
  static const std::vector<float> none;
  return m_impl->scanLine ? m_impl->scanLine->visibilityRange() : none;
}

const ExtractionReport& PoleExtractor::report() const {
  return m_impl->report;
}

}  // namespace polemcl
