/// \file DetectionsEval.cpp
/// \brief `pole-eval detections`: the poles of each scan against the true ones of a simulated
/// folder (core/evaluation/DetectionEvaluation.h). Scans and poles belong together by their times.

#include <algorithm>
#include <cmath>

#include "core/common/PoseInterpolation.h"
#include "core/evaluation/DetectionEvaluation.h"
#include "eval/DriveTruth.h"
#include "eval/EvalApp.h"
#include "eval/Figures.h"
#include "io/dataset/LabelledScans.h"
#include "io/dataset/ScanFolder.h"
#include "io/file/AtomicFile.h"
#include "io/file/TextFile.h"

namespace polemcl::apps {
namespace {

struct DetectionsOptions : EvalOptions {
  std::filesystem::path scans, poles;
  double radius = 0.5;
  std::optional<std::filesystem::path> visible;
  std::size_t minScans = 1;
};

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

Figures detectionsFigures(const DetectionsOptions& options) {
  DetectionEvaluation evaluation(options.radius);
  SimulatedDrive drive(options.scans);
  streamStoredPoles(options.poles, [&](const ReadScan& scan) {
    evaluation.add(scan.observation->poles, drive.polesFor(scan));
  });
  const DetectionScore s = evaluation.score();
  if (options.visible) drive.writeVisible(*options.visible, options.minScans);
  const Json json{{"scans", s.scans},
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
  return {json,
          filled("scans {scans}, detections {detections} ({right} right), visible poles {visible} "
                 "({found} found)\n"
                 "precision {precision:4}  recall {recall:4}\n"
                 "centre error: median {centre_median_m:1*100}  mean {centre_mean_m:1*100}  90 % "
                 "{centre_p90_m:1*100} cm; mean along the ray {bias_along_m:1*100}  across "
                 "{bias_across_m:1*100} cm\n"
                 "radius error: mean {radius_bias_m:1*100}  median of the absolute "
                 "{radius_abs_median_m:1*100} cm\n"
                 "normalised squared error: mean {nees_mean:2}  median {nees_median:2} (2 and 1.39 "
                 "are right)\n"
                 "confidence: area under the ROC {auc:4}\n",
                 json)};
}

void declareDetections(CLI::App& cli, DetectionsOptions& options) {
  addFolder(cli, "--scans", options.scans, "Folder that pole-simulate wrote")->required();
  addFile(cli, "--poles", options.poles, "Rawlog of poles extracted from these scans")->required();
  addNumber(cli, "--radius", options.radius, "Distance within which a pole is right, m",
            CLI::PositiveNumber);
  addOutput(cli, "--visible", options.visible,
            "Write the true poles visible in the scans to this table (CSV)");
  addNumber(cli, "--min-scans", options.minScans,
            "Least number of scans that see a pole of that table", CLI::PositiveNumber);
}

}  // namespace

Subcommand detectionsCommand(CLI::App& program) {
  return evalCommand<DetectionsOptions>(
      program, "detections",
      "Compares the poles of single scans with the true poles of a simulated folder",
      declareDetections, detectionsFigures);
}

}  // namespace polemcl::apps
