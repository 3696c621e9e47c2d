#include "sim/detections/DetectionSummary.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "core/evaluation/DetectionEvaluation.h"
#include "sim/detections/DetectionTracks.h"

namespace polemcl::sim {
namespace {

std::optional<double> mean(const std::vector<double>& values) {
  if (values.empty()) return std::nullopt;
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

/// Lengths of runs with equal outcome in consecutive scans. The first and the last run are left
/// out, because they are cut off at the limits of visibility.
void addRuns(const Track& track, double spacing, std::vector<double>& found,
             std::vector<double>& missed) {
  const auto& chances = track.chances;
  std::size_t start = 0;
  bool whole = false;
  for (std::size_t i = 1; i < chances.size(); ++i) {
    const bool gap = chances[i].scan != chances[i - 1].scan + 1 || chances[i].hidden;
    const bool now = chances[i].detection, before = chances[i - 1].detection;
    if (!gap && now == before) continue;
    if (!gap && whole)
      (before ? found : missed).push_back(spacing * static_cast<double>(i - start));
    whole = !gap;
    start = i;
  }
}

}  // namespace

DetectionSummary summarizeDetections(const ObservedDrive& observed, double maxRange) {
  if (observed.poles.empty()) throw Error("no scan to summarize");
  constexpr double kBin = 5;
  const TrackedDrive tracked = trackDrive(observed, maxRange);
  const auto bins = static_cast<std::size_t>(std::ceil(maxRange / kBin));
  std::vector<double> chances(bins, 0), hits(bins, 0);
  std::vector<double> centre, nees, confidence, found, missed;
  double lasting = 0, right = 0;
  for (const Track& track : tracked.tracks) {
    const bool isPole = track.kind != DetectionClass::clutter;
    if (isPole) addRuns(track, observed.drive->options().spacing, found, missed);
    for (const Chance& chance : track.chances) {
      if (isPole && !chance.hidden) {
        const auto bin = std::min(static_cast<std::size_t>(chance.range / kBin), bins - 1);
        ++chances[bin];
        hits[bin] += chance.detection != nullptr;
      }
      if (!chance.detection) continue;
      (isPole ? right : lasting) += 1;
      if (!isPole) continue;
      const auto& r = chance.reported;
      centre.push_back(std::hypot(r[0] * r[2], r[1] * r[3]));
      nees.push_back(r[2] * r[2] + r[3] * r[3]);
      confidence.push_back(chance.detection->confidence);
    }
  }
  DetectionSummary summary;
  summary.scans = tracked.scans;
  const auto scans = static_cast<double>(tracked.scans);
  summary.detections = static_cast<std::size_t>(right + lasting) + tracked.passing.size();
  summary.perScan = static_cast<double>(summary.detections) / scans;
  summary.falsePerScan = (lasting + static_cast<double>(tracked.passing.size())) / scans;
  summary.lastingFalsePerScan = lasting / scans;
  for (std::size_t i = 0; i < bins; ++i) {
    summary.rangeEdges.push_back(kBin * static_cast<double>(i));
    summary.recall.push_back(chances[i] > 0 ? std::optional(hits[i] / chances[i]) : std::nullopt);
  }
  summary.rangeEdges.push_back(maxRange);
  summary.centreMedian = quantile(centre, 0.5);
  summary.centre90 = quantile(centre, 0.9);
  summary.neesMean = mean(nees);
  summary.neesMedian = quantile(nees, 0.5);
  summary.foundRun = mean(found);
  summary.missedRun = mean(missed);
  summary.confidence = mean(confidence);
  return summary;
}

}  // namespace polemcl::sim
