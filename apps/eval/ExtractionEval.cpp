#include "eval/ExtractionEval.h"

#include <algorithm>
#include <cmath>

#include "cli/JsonFile.h"
#include "core/common/PoseInterpolation.h"
#include "core/evaluation/PoleVisibility.h"
#include "io/data/Trajectory.h"
#include "io/dataset/LabelledScans.h"
#include "io/dataset/ScanFolder.h"
#include "io/file/AtomicFile.h"
#include "io/file/ErrorPlace.h"
#include "io/file/TextFile.h"
#include "localize/TrialDrive.h"

namespace polemcl::apps {
namespace {

nlohmann::ordered_json extractionJson(const DetectionScore& s) {
  return {{"scans", s.scans},
          {"detections", s.detections},
          {"right", s.right},
          {"visible", s.visible},
          {"found", s.found},
          {"precision", s.precision},
          {"recall", s.recall},
          {"centre_mean_m", s.centreMean},
          {"centre_median_m", s.centreMedian},
          {"centre_p90_m", s.centre90},
          {"radius_bias_m", s.radiusMean},
          {"radius_abs_median_m", s.radiusMedian},
          {"nees_mean", s.neesMean},
          {"nees_median", s.neesMedian},
          {"bias_along_m", s.biasAlong},
          {"bias_across_m", s.biasAcross},
          {"auc", s.auc}};
}

nlohmann::ordered_json extractionJson(const RepeatabilityScore& s) {
  return {{"scans", s.scans},       {"detections", s.detections}, {"judged", s.judged},
          {"repeated", s.repeated}, {"per_scan", s.perScan},      {"share", s.share}};
}

nlohmann::ordered_json extractionJson(const RotationScore& s) {
  return {{"scans", s.scans},         {"turns", s.turns},
          {"poles", s.poles},         {"turned_poles", s.turnedPoles},
          {"matched", s.matched},     {"share", s.share},
          {"back_share", s.backShare}};
}

/// A simulated drive: its scans, its poles, and how many scans each pole was visible in.
class SimulatedDrive {
 public:
  explicit SimulatedDrive(const std::filesystem::path& folder)
      : m_folder(folder),
        m_scans(io::readScanFolder(folder, Eigen::Isometry3d::Identity()).scans),
        m_poles(io::readWorldPoles(folder / "poles_gt.csv")),
        m_visibleIn(m_poles.size(), 0) {
    if (!m_scans.front().T_map_robot)
      throw Error(folder.string() + ": no poses.txt in it, so where the poles are is not known");
  }

  /// The true poles in the planar sensor frame of the observation.
  std::vector<TruePoleInScan> polesFor(const ReadScan& scan) {
    const io::ScanEntry& entry = at(scan);
    const Eigen::Isometry3d& T_map_cloud = *entry.T_map_robot;
    const auto labelled = io::readLabelledCloud(entry.cloud, io::labelFile(entry.cloud));
    const auto sights = sightPoles(labelled.cloud.view(), labelled.labels, T_map_cloud, m_poles);
    for (std::size_t i = 0; i < sights.size(); ++i) m_visibleIn[i] += sights[i].visible;
    return polesInScan(m_poles, sights, planarFromCloud(scan) * T_map_cloud.inverse());
  }

  void writeVisible(const std::filesystem::path& file, std::size_t minScans) const {
    io::AtomicFile out(file);
    out.stream() << "id,x,y,radius,top,scans\n";
    for (std::size_t i = 0; i < m_poles.size(); ++i) {
      const WorldPole& pole = m_poles[i];
      if (m_visibleIn[i] < std::max<std::size_t>(1, minScans)) continue;
      out.stream() << pole.id;
      for (const double value : {pole.x, pole.y, pole.radius, pole.top})
        out.stream() << ',' << io::fixed(value, 4);
      out.stream() << ',' << m_visibleIn[i] << '\n';
    }
    out.commit();
  }

 private:
  const io::ScanEntry& at(const ReadScan& scan) const {
    // Rawlogs keep times in steps of 100 ns, times.txt often in microseconds.
    const auto entry = std::lower_bound(
        m_scans.begin(), m_scans.end(), scan.time - sampleTolerance,
        [](const io::ScanEntry& candidate, double time) { return candidate.time < time; });
    if (entry == m_scans.end() || entry->time > scan.time + sampleTolerance)
      throw Error(m_folder.string() + ": no scan at " + io::fixed(scan.time, 6) +
                  " s, the time of scan " + std::to_string(scan.index) +
                  " of the rawlog; check that they belong together");
    return *entry;
  }

  /// The planar sensor frame keeps the yaw of the cloud's frame and stands upright.
  static Eigen::Isometry3d planarFromCloud(const ReadScan& scan) {
    const auto& pose = scan.observation->sensorPose;
    Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
    T.linear() = Eigen::AngleAxisd(-pose.yaw(), Eigen::Vector3d::UnitZ()).toRotationMatrix() *
                 pose.getRotationMatrix().asEigen();
    return T;
  }

  std::filesystem::path m_folder;
  std::vector<io::ScanEntry> m_scans;
  std::vector<WorldPole> m_poles;
  std::vector<std::size_t> m_visibleIn;
};

Eigen::Vector2d inMap(const Pose2D& pose, const PoleDetection& pole) {
  const Pose2D moved = compose(pose, {pole.x, pole.y, 0});
  return {moved.x, moved.y};
}

}  // namespace

DetectionScore evalDetections(const EvalDetectionsOptions& options) {
  DetectionEvaluation evaluation(options.radius);
  SimulatedDrive drive(options.scans);
  streamStoredPoles(options.poles, [&](const ReadScan& scan) {
    evaluation.add(scan.observation->poles, drive.polesFor(scan));
  });
  const DetectionScore score = evaluation.score();
  if (options.visible) drive.writeVisible(*options.visible, options.minScans);
  if (options.json) writeJson(*options.json, extractionJson(score));
  return score;
}

RepeatabilityScore evalRepeatability(const EvalRepeatabilityOptions& options) {
  const auto truth = io::readPlanarTum(options.truth);
  std::vector<std::vector<Eigen::Vector2d>> scans_map;
  streamStoredPoles(options.poles, [&](const ReadScan& scan) {
    const Pose2D pose = truePose(truth, options.truth, scan.time, scan.index, options.poles);
    scans_map.emplace_back();
    for (const PoleDetection& pole : trulyDeskewed(scan, truth))
      scans_map.back().push_back(inMap(pose, pole));
  });
  const RepeatabilityScore score =
      io::located(options.poles.string() + ": ", [&] { return evaluateRepeatability(scans_map); });
  if (options.json) writeJson(*options.json, extractionJson(score));
  return score;
}

RotationScore evalRotation(const EvalRotationOptions& options, const AllSettings& settings) {
  if (options.every < 1) throw Error("--every 0 takes no scan: a number from 1 on is allowed");
  ObservationPoleExtractor source(settings.poleExtraction());
  PoleExtractor extractor(settings.sensor, settings.extraction);
  RotationScore score;
  SequenceOptions sequence = settings.reading();
  sequence.vehicle.lidars.clear();
  streamPoles(options.input.string(), sequence, [&](const ReadScan& scan) {
    if (scan.stored)
      throw Error(options.input.string() + ": holds poles, not scans; only scans can be turned");
    if (options.progress) options.progress(scan.index + 1, scan.expected);
    if (scan.index % options.every != 0 || scan.points == 0) return;
    const auto cloud = source.lidarPoints(*scan.sources.front());
    addRotations(extractor, cloud.view(), options.radius, score);
  });
  if (options.json) writeJson(*options.json, extractionJson(score));
  return score;
}

}  // namespace polemcl::apps
