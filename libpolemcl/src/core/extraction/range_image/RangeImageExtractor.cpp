#include "core/extraction/range_image/RangeImageExtractor.h"

#include <algorithm>
#include <cmath>

#include "core/extraction/range_image/Segmentation.h"

namespace polemcl {

RangeImageOptions adaptedTo(const SensorModel& beams, RangeImageOptions options) {
  constexpr int paperColumns = 500;
  const int lowest = beams.beamCount() - 1;
  if (options.columns == 0) options.columns = std::clamp(beams.columns(), 16, paperColumns);
  if (options.fovUp == 0 && options.fovDown == 0) {  // half a gap beyond the outer rings
    options.fovUp = std::atan(beams.beam(0).slope) + beams.spacingAbove(0) / 2;
    options.fovDown = std::atan(beams.beam(lowest).slope) - beams.spacingAbove(lowest) / 2;
  }
  if (options.rows == 0) {  // no row lies between two rings, or clusters would end there
    double widest = 0;
    for (int row = 0; row <= lowest; ++row) widest = std::max(widest, beams.spacingAbove(row));
    const double fit = (options.fovUp - options.fovDown) / widest + 1e-3;
    options.rows = std::clamp(static_cast<int>(fit), 2, std::max(2, beams.beamCount()));
  }
  return options;
}

namespace {

RangeImageOptions within(double maxRange, RangeImageOptions options) {
  options.maxRange = std::min(maxRange, options.maxRange);
  return options;
}

}  // namespace

RangeImageExtractor::RangeImageExtractor(const SensorModel& beams, const SensorOptions& sensor,
                                         const RangeImageOptions& options)
    : m_options(adaptedTo(beams, within(sensor.maxRange, options))),
      m_minRange(sensor.minRange),
      m_height(sensor.height - (options.projectFrom == "cloud" ? sensor.originZ : 0)),
      m_heightOffset(options.heightsAboveGround ? m_height : 0),
      m_image(m_options.rows, m_options.columns),
      m_cells(2 * (static_cast<int>(std::ceil(options.maxRange)) + 1)) {}

void RangeImageExtractor::extract(const PointsView& points, std::vector<PoleDetection>& poles,
                                  ExtractionReport& report, std::vector<SegmentOutcome>* outcomes) {
  const PointCounts counts = project(points, m_options, m_minRange, m_heightOffset, m_image);
  report.points = points.size;
  report.invalid = counts.invalid;
  report.outOfView = counts.outOfView;
  report.outOfRange = counts.outOfRange;
  report.ground = -m_height;

  const Segmentation segmentation(m_image, m_options);
  report.candidates = segmentation.segments().size();
  sortIntoCells(points);
  for (std::size_t i = 0; i < segmentation.segments().size(); ++i) {
    HeightRange heights;
    PoleDetection pole;
    auto rejection = testCandidate(m_image, segmentation, static_cast<std::int32_t>(i), points,
                                   m_options, m_heightOffset, heights);
    if (!rejection) rejection = fitPole(segmentation.segments()[i], heights, points, pole);
    if (rejection)
      ++report.refused[static_cast<int>(*rejection)];
    else
      poles.push_back(pole);
    if (outcomes) outcomes->push_back({segmentation.segments()[i].pixels, rejection});
  }
}

std::vector<Eigen::Vector2d> RangeImageExtractor::segmentPoints(const Segment& segment,
                                                                const PointsView& points) const {
  std::vector<Eigen::Vector2d> xy;
  for (const Pixel& pixel : segment.pixels) {
    const auto i = m_image.point(pixel.row, pixel.column);
    xy.emplace_back(points.x[i], points.y[i]);
  }
  return xy;
}

std::optional<Circle> RangeImageExtractor::fit(const std::vector<Eigen::Vector2d>& points,
                                               bool singlePrecision) const {
  if (m_options.details == ExtractionDetails::authors)
    return fitCircleKasaMean(points, singlePrecision);
  return fitCircleKasa(points);
}

/// A coarse circle from the segment's pixels, which hold floats, then the circle of all points in a
/// box around it.
std::optional<RejectionReason> RangeImageExtractor::fitPole(const Segment& segment,
                                                            const HeightRange& heights,
                                                            const PointsView& points,
                                                            PoleDetection& pole) const {
  const auto coarse = fit(segmentPoints(segment, points), true);
  if (!coarse) return RejectionReason::badFit;
  Box box;
  box.centre = *coarse;
  box.half = coarse->radius + m_options.fitMargin;
  box.low = heights.low - m_heightOffset;
  box.high = std::min(heights.high, m_options.fitMaxZ) - m_heightOffset;
  const auto xy = pointsInside(box, points);
  if (xy.size() < static_cast<std::size_t>(m_options.minFitPoints))
    return RejectionReason::tooFewPoints;
  const auto circle = fit(xy, m_options.singlePrecision);
  if (!circle || !(circle->radius > m_options.minRadius && circle->radius < m_options.maxRadius))
    return RejectionReason::badFit;
  if (!isFree(box, xy.size(), points)) return RejectionReason::notFree;
  pole.x = circle->x;
  pole.y = circle->y;
  pole.radius = circle->radius;
  pole.bottom = heights.low - m_heightOffset + m_height;
  pole.top = heights.high - m_heightOffset + m_height;
  pole.points = static_cast<std::uint32_t>(xy.size());
  return std::nullopt;
}

std::vector<Eigen::Vector2d> RangeImageExtractor::pointsInside(const Box& box,
                                                               const PointsView& points) const {
  std::vector<Eigen::Vector2d> xy;
  eachNear(box, box.half, points, [&](const Point& p) {
    if (between(p.x, box.centre.x - box.half, box.centre.x + box.half) &&
        between(p.y, box.centre.y - box.half, box.centre.y + box.half))
      xy.emplace_back(p.x, p.y);
  });
  return xy;
}

bool RangeImageExtractor::isFree(const Box& box, std::size_t fitted,
                                 const PointsView& points) const {
  const double outer = box.half + m_options.freeRing;
  const double side = m_options.mirrored ? -1 : 1;
  const double x = box.centre.x, y = side * box.centre.y;
  const bool cut = m_options.details == ExtractionDetails::authors,
             ring = m_options.details == ExtractionDetails::paper;
  const double lowest = cut ? y + box.half - m_options.freeRing : y - outer;
  std::size_t intruders = 0;
  eachNear(box, outer, points, [&](const Point& p) {
    const double py = side * p.y;
    if (ring) {
      const double distance = std::hypot(p.x - x, py - y);
      intruders += distance > box.half && distance < outer;
    } else {
      intruders +=
          (between(p.x, x - outer, x - box.half) || between(p.x, x + box.half, x + outer)) &&
          (between(py, lowest, y - box.half) || between(py, y + box.half, y + outer));
    }
  });
  return static_cast<double>(intruders) < m_options.freeShare * static_cast<double>(fitted);
}

/// Strictly between; in single precision the bounds are rounded, as the points are.
bool RangeImageExtractor::between(double value, double low, double high) const {
  if (m_options.singlePrecision)
    return value > static_cast<float>(low) && value < static_cast<float>(high);
  return value > low && value < high;
}

int RangeImageExtractor::cellAlong(double coordinate) const {
  const int middle = m_cells / 2;
  const double cell = std::floor(coordinate) + middle;
  return static_cast<int>(std::clamp(cell, 0.0, m_cells - 1.0));
}

void RangeImageExtractor::sortIntoCells(const PointsView& points) {
  const auto cell = [&](std::size_t i) -> std::ptrdiff_t {
    if (!std::isfinite(points.x[i]) || !std::isfinite(points.y[i])) return -1;
    return static_cast<std::ptrdiff_t>(cellAlong(points.y[i])) * m_cells + cellAlong(points.x[i]);
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
void RangeImageExtractor::eachNear(const Box& box, double reach, const PointsView& points,
                                   F f) const {
  const double step = m_options.coordinateStep;
  const int fromX = cellAlong(box.centre.x - reach), toX = cellAlong(box.centre.x + reach);
  const int fromY = cellAlong(box.centre.y - reach), toY = cellAlong(box.centre.y + reach);
  for (int cy = fromY; cy <= toY; ++cy)
    for (int cx = fromX; cx <= toX; ++cx) {
      const std::size_t c = static_cast<std::size_t>(cy) * m_cells + cx;
      for (std::uint32_t k = m_cellStart[c]; k < m_cellStart[c + 1]; ++k) {
        const std::uint32_t i = m_cellPoints[k];
        const double z = exactCoordinate(points.z[i], step);
        if (between(z, box.low, box.high))
          f(Point{exactCoordinate(points.x[i], step), exactCoordinate(points.y[i], step), z});
      }
    }
}

}  // namespace polemcl
