#include "PaperExtractor.h"

#include <polemcl/core/Segmentation.h>

#include <algorithm>
#include <cmath>

namespace polemcl {

PaperExtractor::PaperExtractor(const SensorOptions& sensor, const PaperOptions& options)
    : m_sensor(sensor),
      m_options(options),
      m_heightOffset(options.heightsAboveGround ? sensor.height : 0),
      m_image(options.rows, options.columns),
      m_cells(2 * (static_cast<int>(std::ceil(options.maxRange)) + 1)) {}

void PaperExtractor::extract(const PointsView& points, std::vector<PoleDetection>& poles,
                             ExtractionReport& report) {
  RangeImageOptions projection;
  projection.rows = m_options.rows;
  projection.columns = m_options.columns;
  projection.fovUp = m_options.fovUp;
  projection.fovDown = m_options.fovDown;
  projection.minRange = m_sensor.minRange;
  projection.maxRange = m_options.maxRange;
  const PointCounts counts = project(points, projection, m_options.minZ - m_heightOffset,
                                     m_options.maxZ - m_heightOffset, m_image);
  report.points = points.size;
  report.invalid = counts.invalid;
  report.outOfView = counts.outOfView;
  report.outOfRange = counts.outOfRange;
  report.ground = -m_sensor.height;

  SegmentationOptions growing;
  growing.epsilon = m_options.epsilon;
  growing.wrapAround = m_options.wrapAround;
  growing.growUpwards = m_options.growUpwards;
  const Segmentation segmentation(m_image, growing);
  report.candidates = segmentation.segments().size();
  sortIntoCells(points);
  for (std::size_t i = 0; i < segmentation.segments().size(); ++i) {
    HeightRange heights;
    PoleDetection pole;
    Refusal refusal = testCandidate(m_image, segmentation, static_cast<std::int32_t>(i), points,
                                    m_options, m_heightOffset, heights);
    if (refusal == Refusal::count_)
      refusal = fitPole(segmentation.segments()[i], heights, points, pole);
    if (refusal == Refusal::count_)
      poles.push_back(pole);
    else
      ++report.refused[static_cast<int>(refusal)];
  }
}

std::vector<Eigen::Vector2d> PaperExtractor::segmentPoints(const Segment& segment,
                                                           const PointsView& points) const {
  std::vector<Eigen::Vector2d> xy;
  for (const Pixel& pixel : segment.pixels) {
    const auto i = m_image.point(pixel.row, pixel.column);
    xy.emplace_back(points.x[i], points.y[i]);
  }
  return xy;
}

std::optional<Circle> PaperExtractor::fit(const std::vector<Eigen::Vector2d>& points) const {
  if (m_options.circleFit == "taubin") return fitCircleTaubin(points);
  if (m_options.circleFit == "silhouette") return fitCircleSilhouette(points, 0);
  return fitCircleKasa(points);
}

/// A coarse circle from the segment's pixels, then the circle of all points in a box around it.
Refusal PaperExtractor::fitPole(const Segment& segment, const HeightRange& heights,
                                const PointsView& points, PoleDetection& pole) const {
  const auto coarse = fit(segmentPoints(segment, points));
  if (!coarse || coarse->radius > m_options.maxRange) return Refusal::badFit;
  const double half = coarse->radius + m_options.fitMargin;
  if (half > 2) return Refusal::badFit;
  const double low = heights.low - m_heightOffset;
  const double high = std::min(heights.high, m_options.fitMaxZ) - m_heightOffset;
  std::vector<Eigen::Vector2d> xy;
  eachInBox(*coarse, half, [&](std::uint32_t i) {
    const double dx = std::abs(points.x[i] - coarse->x), dy = std::abs(points.y[i] - coarse->y);
    if (dx < half && dy < half && points.z[i] > low && points.z[i] < high)
      xy.emplace_back(points.x[i], points.y[i]);
  });
  if (xy.size() < static_cast<std::size_t>(m_options.minFitPoints)) return Refusal::tooFewPoints;
  const auto circle = fit(xy);
  if (!circle || !(circle->radius > m_options.minRadius && circle->radius < m_options.maxRadius))
    return Refusal::badFit;
  if (!isFree(*coarse, half, low, high, xy.size(), points)) return Refusal::notFree;
  pole.x = circle->x;
  pole.y = circle->y;
  pole.radius = circle->radius;
  pole.bottom = heights.low - m_heightOffset + m_sensor.height;
  pole.top = heights.high - m_heightOffset + m_sensor.height;
  pole.points = static_cast<std::uint32_t>(xy.size());
  return Refusal::count_;
}

bool PaperExtractor::isFree(const Circle& coarse, double half, double low, double high,
                            std::size_t fitted, const PointsView& points) const {
  const double outer = half + m_options.freeRing;
  const bool ring = m_options.freeSpace == "ring";
  std::size_t intruders = 0;
  eachInBox(coarse, outer, [&](std::uint32_t i) {
    if (!(points.z[i] > low && points.z[i] < high)) return;
    const double dx = std::abs(points.x[i] - coarse.x), dy = std::abs(points.y[i] - coarse.y);
    if (ring) {
      const double distance = std::hypot(dx, dy);
      intruders += distance > half && distance < outer;
    } else {
      intruders += dx > half && dx < outer && dy > half && dy < outer;
    }
  });
  return static_cast<double>(intruders) < m_options.freeShare * static_cast<double>(fitted);
}

void PaperExtractor::sortIntoCells(const PointsView& points) {
  const auto cell = [&](std::size_t i) -> std::ptrdiff_t {
    const double cx = std::floor(points.x[i]) + m_cells / 2,
                 cy = std::floor(points.y[i]) + m_cells / 2;
    if (!(cx >= 0 && cx < m_cells && cy >= 0 && cy < m_cells)) return -1;
    return static_cast<std::ptrdiff_t>(cy) * m_cells + static_cast<std::ptrdiff_t>(cx);
  };
  m_cellStart.assign(static_cast<std::size_t>(m_cells) * m_cells + 1, 0);
  for (std::size_t i = 0; i < points.size; ++i)
    if (const auto c = cell(i); c >= 0) ++m_cellStart[c + 1];
  for (std::size_t c = 1; c < m_cellStart.size(); ++c) m_cellStart[c] += m_cellStart[c - 1];
  m_cellPoints.resize(m_cellStart.back());
  std::vector<std::uint32_t> next(m_cellStart.begin(), m_cellStart.end() - 1);
  for (std::size_t i = 0; i < points.size; ++i)
    if (const auto c = cell(i); c >= 0) m_cellPoints[next[c]++] = static_cast<std::uint32_t>(i);
}

template <class F>
void PaperExtractor::eachInBox(const Circle& centre, double half, F f) const {
  const auto column = [&](double v) {
    return std::clamp(static_cast<int>(std::floor(v)) + m_cells / 2, 0, m_cells - 1);
  };
  for (int cy = column(centre.y - half); cy <= column(centre.y + half); ++cy)
    for (int cx = column(centre.x - half); cx <= column(centre.x + half); ++cx) {
      const std::size_t c = static_cast<std::size_t>(cy) * m_cells + cx;
      for (std::uint32_t k = m_cellStart[c]; k < m_cellStart[c + 1]; ++k) f(m_cellPoints[k]);
    }
}

}  // namespace polemcl
