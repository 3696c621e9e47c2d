#include "eval/LabelledFeatures.h"

#include <Eigen/Cholesky>
#include <cmath>
#include <memory>
#include <sstream>
#include <unordered_map>

#include "cli/Outputs.h"
#include "core/common/Deskew.h"
#include "core/common/Transform.h"
#include "core/evaluation/MultiScanLabels.h"
#include "core/extraction/CovarianceScale.h"
#include "core/extraction/scan_line/ScanLineExtractor.h"
#include "eval/EvalApp.h"
#include "import/DatasetImport.h"
#include "io/dataset/LabelledScans.h"
#include "io/dataset/ScanFolder.h"
#include "io/file/AtomicFile.h"
#include "io/file/ErrorPlace.h"
#include "io/file/TextFile.h"

namespace polemcl::apps {
namespace {

constexpr double kPoleRadius = 0.3;   ///< a candidate this near to a true pole is one, m
constexpr double kOtherRadius = 0.5;  ///< one farther away is something else; between is unsure
constexpr double kSamePlace = 0.2;    ///< candidates nearer than this are one place, m
constexpr int kDigits = 9;            ///< significant ones in the table
/// Terms of the covariance from here on do not depend on the weights.
constexpr int kFirstMeasured = static_cast<int>(CovarianceTerm::residual);

/// The scans of a drive with poses, corrected for motion where the timing is known.
class LabelledDrive {
 public:
  LabelledDrive(const FeaturesOptions& options, const ScanTiming& timing)
      : m_mounting(options.T_robot_sensor),
        m_timing(timing),
        m_folder(std::filesystem::is_directory(options.scans / "velodyne")
                     ? io::readScanFolder(options.scans, options.T_robot_sensor)
                     : io::readPcdFolder(options.scans, options.T_robot_sensor)) {
    if (!m_folder.scans.front().T_map_robot)
      throw Error(options.scans.string() + ": has no poses.txt, which labels need");
  }
  std::size_t size() const { return m_folder.scans.size(); }
  io::Cloud cloud(std::size_t i) const {
    const io::ScanEntry& entry = m_folder.scans[i];
    return m_folder.read ? m_folder.read(entry) : io::readKittiBin(entry.cloud);
  }
  Eigen::Isometry3d T_map_lidar(std::size_t i) const {
    return *m_folder.scans[i].T_map_robot * m_mounting;
  }
  /// A planar point of scan i, where it is seen from at the time stamp.
  Eigen::Vector2d atStamp(const Velocity& velocity, double x, double y) const {
    const double offset = m_timing.offset(std::atan2(y, x));
    if (offset == 0) return {x, y};
    const Pose2D place = compose(motionAfter(velocity, offset), {x, y, 0});
    return {place.x, place.y};
  }
  Velocity velocity(std::size_t i) const {
    if (!m_timing.known() || size() < 2) return {};
    const std::size_t from = i == 0 ? 0 : i - 1, to = std::min(i + 1, size() - 1);
    const Eigen::Isometry3d step = T_map_lidar(from).inverse() * T_map_lidar(to);
    const Eigen::Matrix3d turn = step.linear();
    return velocityOf(
        {step.translation().x(), step.translation().y(), std::atan2(turn(1, 0), turn(0, 0))},
        m_folder.scans[to].time - m_folder.scans[from].time);
  }

 private:
  Eigen::Isometry3d m_mounting;
  ScanTiming m_timing;
  io::ScanFolder m_folder;
};

struct FoundCandidate {
  std::size_t scan;
  PoleCandidate candidate;  ///< x, y at the time stamp, LiDAR frame
  Eigen::Vector2d place_map;
};

std::vector<FoundCandidate> findCandidates(const LabelledDrive& drive, const AllSettings& settings,
                                           const Eigen::Matrix3d& R_robot_sensor) {
  ScanLineExtractor extractor(SensorModel(settings.sensor), settings.sensor,
                              settings.extraction.scanLine);
  std::vector<PoleCandidate> recorded;
  extractor.recordCandidates(&recorded);
  const Eigen::Vector3f up = R_robot_sensor.row(2).cast<float>();
  const Eigen::Vector2f upright = up.head<2>() / up.z();
  std::vector<FoundCandidate> all;
  std::vector<PoleDetection> poles;
  ExtractionReport report;
  for (std::size_t i = 0; i < drive.size(); ++i) {
    const io::Cloud cloud = drive.cloud(i);
    poles.clear();
    report = {};
    extractor.extract(cloud.view(), upright, poles, report);
    const Velocity velocity = drive.velocity(i);
    const Eigen::Isometry3d T_map_lidar = drive.T_map_lidar(i);
    const Eigen::Vector3f trueUp = T_map_lidar.linear().row(2).cast<float>();
    const Eigen::Vector2f trueUpright = trueUp.head<2>() / trueUp.z();
    for (PoleCandidate each : recorded) {
      // A detection is moved by the estimated tilt of the sensor, which depends on the classifier.
      const Eigen::Vector2f shift = shiftBy(each.tilt, upright, trueUpright);
      each.x += shift.x();
      each.y += shift.y();
      const Eigen::Vector2d at = drive.atStamp(velocity, each.x, each.y);
      each.x = at.x();
      each.y = at.y();
      const Eigen::Vector3d map = T_map_lidar * Eigen::Vector3d(at.x(), at.y(), 0);
      all.push_back({i, each, map.head<2>()});
    }
  }
  return all;
}

struct Label {
  Standing standing = Standing::unsure;
  std::optional<double> squaredError;
};

/// Labels by the true poles, which are upright in the map: compared at the height of the sensor.
std::vector<Label> labelsByPoles(const LabelledDrive& drive,
                                 const std::vector<FoundCandidate>& found,
                                 const std::vector<WorldPole>& poles) {
  std::vector<Label> labels;
  labels.reserve(found.size());
  for (const FoundCandidate& each : found) {
    const Eigen::Isometry3d T_map_lidar = drive.T_map_lidar(each.scan);
    const Eigen::Isometry3d T_lidar_map = T_map_lidar.inverse();
    double nearest = 1e9;
    Eigen::Vector2d error = Eigen::Vector2d::Zero();
    for (const WorldPole& pole : poles) {
      if ((each.place_map - Eigen::Vector2d(pole.x, pole.y)).norm() > 2) continue;
      const Eigen::Vector3d truth =
          T_lidar_map * Eigen::Vector3d(pole.x, pole.y, T_map_lidar.translation().z());
      const Eigen::Vector2d e(each.candidate.x - truth.x(), each.candidate.y - truth.y());
      if (e.norm() >= nearest) continue;
      nearest = e.norm();
      error = e;
    }
    Label label;
    if (nearest < kPoleRadius) {
      label = {Standing::pole, error.dot(each.candidate.covariance.llt().solve(error))};
    } else if (nearest > kOtherRadius) {
      label.standing = Standing::other;
    }
    labels.push_back(label);
  }
  return labels;
}

/// Groups candidates to places: the index of the place of each.
class Places {
 public:
  std::size_t indexOf(const Eigen::Vector2d& at) {
    const auto cx = cell(at.x()), cy = cell(at.y());
    for (auto x = cx - 1; x <= cx + 1; ++x)
      for (auto y = cy - 1; y <= cy + 1; ++y) {
        const auto found = m_grid.find(key(x, y));
        if (found == m_grid.end()) continue;
        for (const std::size_t i : found->second)
          if ((m_centres[i] - at).norm() < kSamePlace) return i;
      }
    m_centres.push_back(at);
    m_grid[key(cx, cy)].push_back(m_centres.size() - 1);
    return m_centres.size() - 1;
  }
  const std::vector<Eigen::Vector2d>& centres() const { return m_centres; }

 private:
  static std::int64_t cell(double value) {
    return static_cast<std::int64_t>(std::floor(value / kSamePlace));
  }
  static std::int64_t key(std::int64_t x, std::int64_t y) { return x * 0x100000000ll + y; }
  std::vector<Eigen::Vector2d> m_centres;
  std::unordered_map<std::int64_t, std::vector<std::size_t>> m_grid;
};

/// Labels by what all scans of the drive show at the place of a candidate.
std::vector<Label> labelsByManyScans(const LabelledDrive& drive,
                                     const std::vector<FoundCandidate>& found,
                                     const SensorOptions& sensor) {
  Places places;
  std::vector<std::size_t> placeOf;
  placeOf.reserve(found.size());
  for (const FoundCandidate& each : found) placeOf.push_back(places.indexOf(each.place_map));
  MultiScanLabels evidence(places.centres());
  const double topSlope = SensorModel(sensor).beam(0).slope;
  std::vector<Eigen::Vector3f> points_map;
  for (std::size_t i = 0; i < drive.size(); ++i) {
    const io::Cloud cloud = drive.cloud(i);
    const Velocity velocity = drive.velocity(i);
    const Eigen::Isometry3f T_map_lidar = drive.T_map_lidar(i).cast<float>();
    points_map.clear();
    for (std::size_t k = 0; k < cloud.size(); ++k) {
      if (std::hypot(cloud.x[k], cloud.y[k]) < sensor.minRange) continue;
      const Eigen::Vector2d at = drive.atStamp(velocity, cloud.x[k], cloud.y[k]);
      points_map.push_back(T_map_lidar * Eigen::Vector3f(static_cast<float>(at.x()),
                                                         static_cast<float>(at.y()), cloud.z[k]));
    }
    evidence.add(points_map, drive.T_map_lidar(i).translation(), topSlope);
  }
  const std::vector<Standing> verdicts = evidence.judge();
  std::vector<Label> labels;
  labels.reserve(found.size());
  for (const std::size_t place : placeOf) labels.push_back({verdicts[place], std::nullopt});
  return labels;
}

/// The terms of both regressions but the constant one and the odds, which depend on the weights.
void writeHeader(std::ostream& out, const FeaturesOptions& options, const std::string& sensor) {
  out << "# sensor " << sensor << "\n# labels " << (options.poles ? "true_poles" : "many_scans")
      << "\nscan,x,y,pole,squared_error,odds";
  for (int i = 1; i < kClassifierTerms; ++i) out << ',' << name(static_cast<ClassifierTerm>(i));
  for (int i = kFirstMeasured; i < kCovarianceTerms; ++i)
    out << ",covariance_" << name(static_cast<CovarianceTerm>(i));
  out << '\n';
}

void writeRow(std::ostream& out, const FoundCandidate& each, const Label& label,
              double columnAngle) {
  const double odds = poleOdds(each.candidate.features);
  const ClassifierTerms terms = classifierTerms(each.candidate.features);
  const CovarianceTerms scaleTerms = covarianceTerms(each.candidate.features, odds, columnAngle);
  out << each.scan << ',' << io::fixed(each.place_map.x(), 3) << ','
      << io::fixed(each.place_map.y(), 3) << ',' << (label.standing == Standing::pole) << ',';
  if (label.squaredError) out << io::significant(*label.squaredError, kDigits);
  out << ',' << io::significant(odds, kDigits);
  for (int i = 1; i < kClassifierTerms; ++i) out << ',' << io::significant(terms[i], kDigits);
  for (int i = kFirstMeasured; i < kCovarianceTerms; ++i)
    out << ',' << io::significant(scaleTerms[i], kDigits);
  out << '\n';
}

void requireOwnFrame(const SensorOptions& sensor) {
  if (sensor.upsideDown || sensor.originX != 0 || sensor.originY != 0 || sensor.originZ != 0)
    throw Error(
        "pole-eval features takes clouds in the LiDAR's own frame, upright: remove [sensor] "
        "upside_down and origin");
}

std::string summaryText(const FeaturesSummary& s) {
  std::ostringstream out;
  out << "scans " << s.scans << ", candidates: " << s.poles << " poles, " << s.others << " others, "
      << s.unsure << " unsure (left out)\n";
  return out.str();
}

}  // namespace

FeaturesSummary writeFeatures(const FeaturesOptions& options, const AllSettings& settings) {
  requireOwnFrame(settings.sensor);
  const LabelledDrive drive(options, settings.sensor.timing);
  const auto found = findCandidates(drive, settings, options.T_robot_sensor.linear());
  const auto labels = options.poles
                          ? labelsByPoles(drive, found, io::readWorldPoles(*options.poles))
                          : labelsByManyScans(drive, found, settings.sensor);
  io::AtomicFile file(options.output);
  std::ostream& out = file.stream();
  const SensorModel sensor(settings.sensor);
  writeHeader(out, options, settings.sensor.model);
  FeaturesSummary summary;
  summary.scans = drive.size();
  for (std::size_t i = 0; i < found.size(); ++i) {
    summary.poles += labels[i].standing == Standing::pole;
    summary.others += labels[i].standing == Standing::other;
    summary.unsure += labels[i].standing == Standing::unsure;
    if (labels[i].standing != Standing::unsure)
      writeRow(out, found[i], labels[i], sensor.columnAngle());
  }
  file.commit();
  return summary;
}

Subcommand featuresCommand(CLI::App& program) {
  auto& cli = *program.add_subcommand(
      "features", "Writes the features of the candidates of a drive, with labels");
  const auto options = std::make_shared<FeaturesOptions>();
  const auto config = std::make_shared<std::string>();
  const auto pose = std::make_shared<std::string>("0 0 0 0 0 0");
  const auto set = std::make_shared<std::vector<std::string>>();
  addConfigOption(cli, *config)->required();
  addSetOption(cli, *set);
  addFolder(cli, "--scans", options->scans,
            "Folder with velodyne/*.bin or *.pcd, and poses.txt; in the LiDAR's own frame")
      ->required();
  cli.add_option("--sensor-pose", *pose, "Frame of the clouds on the robot, m and deg")
      ->type_name("'X Y Z YAW_DEG PITCH_DEG ROLL_DEG'")
      ->default_str("0")
      ->check(
          [](const std::string& text) { return io::problemOf([&] { parseSensorPose(text); }); });
  addFile(cli, "--poles", options->poles,
          "True poles (CSV: id, x, y, radius, top); without them, all scans together label the "
          "candidates");
  addOutput(cli, "--output", options->output, "Table to write (CSV)")->required();
  return {&cli, [options, config, pose, set](bool) {
            options->T_robot_sensor = parseSensorPose(*pose);
            return summaryText(writeFeatures(*options, loadSettings(*config, *set)));
          }};
}

}  // namespace polemcl::apps
