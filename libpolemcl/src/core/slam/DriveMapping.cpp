#include "core/slam/DriveMapping.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "core/common/DisjointSets.h"
#include "core/common/GreedyAssignment.h"
#include "core/common/KdTree2D.h"
#include "core/common/Transform.h"
#include "core/slam/LoopSearch.h"

namespace polemcl {
namespace {

/// Loops agree on a motion within what an odometry errs by between them.
constexpr double kAgree = 10, kAgreeYaw = 0.2;  ///< m, rad
constexpr std::ptrdiff_t kFewestAgreeing = 2;

/// A loop between two frames: one pose in both.
struct Bridge {
  std::size_t low = 0, high = 0;  ///< frames
  Pose2D pose_low, pose_high;
  Pose2D motion() const { return compose(pose_low, relative(pose_high, Pose2D())); }
};

Bridge bridgeOf(const Loop& loop, const std::vector<std::size_t>& frames,
                const std::vector<Pose2D>& poses) {
  const std::size_t first = frames[loop.tie.first], second = frames[loop.tie.second];
  const Pose2D& pose = poses[loop.tie.second];
  const Pose2D place = compose(poses[loop.tie.first], loop.tie.motion.mean);
  if (first <= second) return {first, second, place, pose};
  return {second, first, pose, place};
}

bool near(const Pose2D& a, const Pose2D& b) {
  return std::hypot(a.x - b.x, a.y - b.y) < kAgree &&
         std::abs(wrapAngle(a.yaw - b.yaw)) < kAgreeYaw;
}

bool agree(const Bridge& a, const Bridge& b) {
  return a.low == b.low && a.high == b.high && near(compose(a.motion(), b.pose_high), b.pose_low);
}

/// The bridge that most others agree with; none if too few do.
std::optional<Bridge> bestBridge(const std::vector<Loop>& loops,
                                 const std::vector<std::size_t>& frames,
                                 const std::vector<Pose2D>& poses) {
  std::vector<Bridge> bridges;
  for (const Loop& loop : loops) {
    const Bridge bridge = bridgeOf(loop, frames, poses);
    if (bridge.low != bridge.high) bridges.push_back(bridge);
  }
  std::optional<Bridge> best;
  std::ptrdiff_t most = kFewestAgreeing - 1;
  for (const Bridge& bridge : bridges) {
    const auto count = std::count_if(bridges.begin(), bridges.end(),
                                     [&](const Bridge& other) { return agree(bridge, other); });
    if (count <= most) continue;
    most = count;
    best = bridge;
  }
  return best;
}

/// Moves the poses of a frame and the poles of its tracks, which belong to another frame then.
/// \param motion From the frame `from` to the frame `to`.
void moveFrame(std::size_t from, std::size_t to, const Pose2D& motion, const PoleTracks& tracks,
               std::vector<std::size_t>& frames, AdjustedState& state) {
  for (std::size_t i = 0; i < tracks.tracks.size(); ++i)
    if (frames[tracks.tracks[i].last] == from)
      state.poles[i] = centreOf(compose(motion, {state.poles[i].x(), state.poles[i].y(), 0}));
  for (std::size_t i = 0; i < frames.size(); ++i) {
    if (frames[i] != from) continue;
    state.poses[i] = compose(motion, state.poses[i]);
    frames[i] = to;
  }
}

/// Moves the poses and poles of drives to the frame of earlier ones, by the rigid motion that most
/// of the loops between them agree on, two at least. \param loops Those that lead to a drive still
/// in another frame, or disagree, are removed. \return Whether anything was connected.
bool connectFrames(std::vector<Loop>& loops, const PoleTracks& tracks,
                   std::vector<std::size_t>& frames, AdjustedState& state) {
  const auto within = [&](const Loop& loop) {
    return frames[loop.tie.first] == frames[loop.tie.second];
  };
  const auto between = std::stable_partition(loops.begin(), loops.end(), within);
  std::vector<Loop> bridges(between, loops.end());
  loops.erase(between, loops.end());
  bool connected = false;
  while (const auto best = bestBridge(bridges, frames, state.poses)) {
    moveFrame(best->high, best->low, best->motion(), tracks, frames, state);
    connected = true;
  }
  for (Loop& loop : bridges) {
    const Bridge bridge = bridgeOf(loop, frames, state.poses);
    if (within(loop) && near(bridge.pose_low, bridge.pose_high)) loops.push_back(std::move(loop));
  }
  return connected;
}

constexpr double kKnotSpacing = 10;  ///< m
constexpr int kIterations = 30;      ///< of the least squares, at most
constexpr int kRounds = 2;           ///< of looking for loops
constexpr double kTieGate = 16.3;    ///< squared Mahalanobis distance: 99.9 %
constexpr double kStart = 1e-4;      ///< m, rad: how firmly the first pose of a frame stands
/// Factors of the sigmas of fixes, in this order: wide at first, while the drive is still bent.
constexpr double kWidenings[] = {20, 5, 1};
constexpr double kKnown = 0.02, kKnownYaw = 0.002;  ///< m, rad: σ of poses that are known
/// m: greatest distance between the tracks of one pole, round by round.
constexpr double kMergeGates[] = {0.8, 0.5}, kLastGate = 0.4;
constexpr std::uint32_t kFollowed = 3;  ///< scans that see a pole at least
constexpr std::ptrdiff_t kFewestTracks = 2;

class DriveMapping {
 public:
  DriveMapping(DrivesToMap drives, const AdjustmentTrust& trust)
      : m_scans(std::move(drives.scans)),
        m_names(std::move(drives.names)),
        m_knownCount(drives.known),
        m_knownCovariances(std::move(drives.knownCovariances)),
        m_fixes(std::move(drives.fixes)),
        m_trust(trust),
        m_drives(drivesOf(m_scans)) {}
  MappedDrives run();

 private:
  void chain();
  void track();
  void requirePoles() const;
  enum class Covariance { open, known };
  void adjust(const std::vector<PoseTie>& ties, Covariance covariance);
  std::vector<PoseTie> ties() const;
  void layOnFixes();
  void useFixes(double widening);
  bool closeLoops();
  std::vector<KnownPose> known() const;
  void requireConnected() const;
  void merge(double gate, Covariance covariance);
  void widenWhereFixesAreDoubtful();
  Eigen::Matrix3d covarianceOf(std::size_t scan) const;
  std::vector<PoseWithCovariance> poses() const;
  MappedDrives result() const;

  std::vector<DrivenScan> m_scans;
  std::vector<std::string> m_names;
  std::size_t m_knownCount;
  std::vector<Eigen::Matrix3d> m_knownCovariances;
  std::vector<DriveFix> m_fixes;
  AdjustmentTrust m_trust;
  std::vector<std::size_t> m_drives;  ///< of each scan
  /// Frame of each scan's pose. 0: the map. n + 1: begins where drive n begins.
  std::vector<std::size_t> m_frames;
  AdjustedState m_state;
  PoleTracks m_tracks;
  AdjustmentFactors m_factors;
  std::vector<Loop> m_loops;
  Knots m_knots;
};

/// Poses by the odometry alone; each drive in a frame of its own.
void DriveMapping::chain() {
  for (std::size_t i = 0; i < m_scans.size(); ++i) {
    const DrivenScan& scan = m_scans[i];
    m_state.poses.push_back(i < m_knownCount || !scan.motion || i == 0
                                ? scan.pose_map_robot
                                : compose(m_state.poses.back(), scan.motion->mean));
    m_frames.push_back(i < m_knownCount ? 0 : m_drives[i] + 1);
  }
  m_state.odometry.assign(m_drives.back() + 1, Eigen::Vector2d::Zero());
}

/// What says where each frame is: poses that are known, or else the first one.
std::vector<KnownPose> DriveMapping::known() const {
  std::vector<KnownPose> known;
  const Eigen::Matrix3d covariance =
      Eigen::Vector3d(kKnown, kKnown, kKnownYaw).cwiseAbs2().asDiagonal();
  for (std::size_t i = 0; i < m_scans.size(); ++i) {
    const bool begins = i == 0 || m_drives[i] != m_drives[i - 1];
    if (i < m_knownCount)
      known.push_back({i, {m_scans[i].pose_map_robot, covariance}});
    else if (begins && m_frames[i] == m_drives[i] + 1)
      known.push_back({i, {m_state.poses[i], kStart * kStart * Eigen::Matrix3d::Identity()}});
  }
  return known;
}

/// Follows the poles anew, and places each where its sightings have it on average.
void DriveMapping::track() {
  m_tracks = trackPoles(m_scans, m_state.poses);
  std::vector<double> counts(m_tracks.tracks.size());
  m_state.poles.assign(m_tracks.tracks.size(), Eigen::Vector2d::Zero());
  for (const PoleSighting& sighting : m_tracks.sightings) {
    const PoleDetection& seen = m_scans[sighting.scan].poles_robot[sighting.detection];
    m_state.poles[sighting.pole] +=
        centreOf(compose(m_state.poses[sighting.scan], {seen.x, seen.y, 0}));
    ++counts[sighting.pole];
  }
  for (std::size_t i = 0; i < counts.size(); ++i) m_state.poles[i] /= counts[i];
  m_factors.sightings = m_tracks.sightings;
}

std::vector<PoseTie> DriveMapping::ties() const {
  std::vector<PoseTie> ties;
  for (const Loop& loop : m_loops) ties.push_back(loop.tie);
  return ties;
}

void DriveMapping::requirePoles() const {
  const auto followed = std::count_if(m_tracks.tracks.begin(), m_tracks.tracks.end(),
                                      [](const PoleTrack& pole) { return pole.hits >= kFollowed; });
  if (followed < kFewestTracks)
    throw Error(m_names.back() + ": only " + std::to_string(followed) + " poles were seen in " +
                std::to_string(kFollowed) + " scans or more; " + std::to_string(kFewestTracks) +
                " are needed: without poles nothing corrects the odometry");
}

void DriveMapping::adjust(const std::vector<PoseTie>& ties, Covariance covariance) {
  m_factors.known = known();
  m_factors.ties = ties;
  JointAdjustment adjustment(m_scans, m_trust, m_factors, m_state);
  adjustment.solve(kIterations);
  if (covariance == Covariance::open) return;
  m_knots = chooseKnots(m_scans, m_state.poses, kKnotSpacing);
  m_knots.covariance = adjustment.poseCovariance(m_knots.scans);
}

/// Fixes of the drives that lie on the plane.
void DriveMapping::useFixes(double widening) {
  std::vector<DriveFix> placed;
  std::copy_if(m_fixes.begin(), m_fixes.end(), std::back_inserter(placed),
               [&](const DriveFix& fix) { return m_frames[fix.scan] == 0; });
  m_factors.gnss = fixFactors(placed, m_drives);
  m_factors.gnss.widening = widening;
  m_state.fixErrors.assign(m_factors.gnss.errors.size(), Eigen::Vector2d::Zero());
  m_state.antennas.clear();
  for (const AntennaPlace& antenna : m_factors.gnss.antennas)
    m_state.antennas.push_back(antenna.stated);
}

/// Lays each drive that has fixes on the plane, and bends it gently to them.
void DriveMapping::layOnFixes() {
  if (m_fixes.empty()) return;
  for (std::size_t drive = 0; drive <= m_drives.back(); ++drive) {
    std::vector<DriveFix> own;
    std::copy_if(m_fixes.begin(), m_fixes.end(), std::back_inserter(own),
                 [&](const DriveFix& fix) { return m_drives[fix.scan] == drive; });
    if (const auto motion = motionOntoFixes(own, m_state.poses))
      moveFrame(drive + 1, 0, *motion, m_tracks, m_frames, m_state);
  }
  for (const double widening : kWidenings) {
    useFixes(widening);
    adjust({}, Covariance::open);
  }
}

/// Looks for loops by what is known now, and lets go of those that do not fit when all are adjusted
/// together. \return Whether drives were connected that were not before.
bool DriveMapping::closeLoops() {
  track();
  adjust(ties(), Covariance::known);
  track();  // the search numbers the tracks by these poses
  m_loops = findLoops(m_scans, m_state, m_tracks, m_knots, m_frames);
  const bool connected = connectFrames(m_loops, m_tracks, m_frames, m_state);
  for (bool changed = !m_loops.empty(); changed;) {
    adjust(ties(), Covariance::open);
    const auto wrong = std::remove_if(m_loops.begin(), m_loops.end(), [&](const Loop& loop) {
      return misfit(loop.tie, m_state.poses, Eigen::Matrix3d::Zero()) > kTieGate;
    });
    changed = wrong != m_loops.end();
    m_loops.erase(wrong, m_loops.end());
  }
  return connected;
}

void DriveMapping::requireConnected() const {
  for (std::size_t i = 0; i < m_scans.size(); ++i)
    if (m_frames[i] != m_frames[0])
      throw Error(m_names.at(m_drives[i]) +
                  ": none of its places was found in the other drives; a map is made of drives "
                  "that pass the same places, over 60 m or so: leave it out, or make another "
                  "map of it");
}

/// The tracks of a submap become one with those seen earlier, where a loop was closed.
void DriveMapping::merge(double gate, Covariance covariance) {
  DisjointSets sets(m_tracks.tracks.size());  // tracks that are one pole
  std::vector<Eigen::Vector2d> places = m_state.poles;
  for (const Loop& loop : m_loops) {
    std::vector<Eigen::Vector2d> own, earlier;
    for (const std::size_t track : loop.tracks) own.push_back(places[track]);
    for (const std::size_t track : loop.earlier) earlier.push_back(places[track]);
    for (const AssignedPair& pair : greedyAssignment(own, earlier, gate))
      sets.join(loop.tracks[pair.first], loop.earlier[pair.second]);
  }
  m_factors.sightings = m_tracks.sightings;
  for (PoleSighting& sighting : m_factors.sightings) sighting.pole = sets.root(sighting.pole);
  adjust({}, covariance);
  for (std::size_t i = 0; i < m_tracks.tracks.size(); ++i)
    m_state.poles[i] = m_state.poles[sets.root(i)];
}

/// The poses stay, with the covariance that wider sigmas of the fixes give them.
void DriveMapping::widenWhereFixesAreDoubtful() {
  const std::vector<FixFit> fits = fixFits(m_factors.gnss, m_state, m_drives);
  if (std::none_of(fits.begin(), fits.end(), [](const FixFit& fit) { return fit.isDoubtful(); }))
    return;
  AdjustmentFactors wide = m_factors;
  wide.gnss = widened(m_factors.gnss, fits, m_drives);
  m_knots.covariance =
      JointAdjustment(m_scans, m_trust, wide, m_state).poseCovariance(m_knots.scans);
}

MappedDrives DriveMapping::run() {
  chain();
  track();
  requirePoles();
  adjust({}, Covariance::open);
  layOnFixes();
  for (int left = kRounds; left > 0; --left)
    if (closeLoops()) {
      useFixes(1);
      left = std::max(left, 2);  // what is connected now is searched once more
    }
  requireConnected();
  for (const double gate : kMergeGates) merge(gate, Covariance::open);
  merge(kLastGate, Covariance::known);
  widenWhereFixesAreDoubtful();
  return result();
}

/// Linear between the knots before and after.
Eigen::Matrix3d DriveMapping::covarianceOf(std::size_t scan) const {
  const auto& knots = m_knots.scans;
  const auto block = [&](std::size_t knot) -> Eigen::Matrix3d {
    const auto at = static_cast<Eigen::Index>(3 * knot);
    return m_knots.covariance.block<3, 3>(at, at);
  };
  const auto after =
      static_cast<std::size_t>(std::lower_bound(knots.begin(), knots.end(), scan) - knots.begin());
  if (knots[after] == scan) return block(after);
  const std::size_t before = after - 1;
  const double share =
      static_cast<double>(scan - knots[before]) / static_cast<double>(knots[after] - knots[before]);
  return (1 - share) * block(before) + share * block(after);
}

/// The known poses were taken as exact. The covariance of the nearest one is added to each new
/// pose.
std::vector<PoseWithCovariance> DriveMapping::poses() const {
  std::vector<PoseWithCovariance> poses;
  for (std::size_t i = 0; i < m_scans.size(); ++i)
    poses.push_back({m_state.poses[i], covarianceOf(i)});
  if (m_knownCovariances.empty()) return poses;
  const auto centres = centresOf(m_state.poses);
  const KdTree2D known(
      {centres.begin(), centres.begin() + static_cast<std::ptrdiff_t>(m_knownCount)});
  for (std::size_t i = m_knownCount; i < poses.size(); ++i)
    poses[i].covariance +=
        m_knownCovariances.at(known.nearest(centres[i].x(), centres[i].y(), INFINITY).index);
  return poses;
}

MappedDrives DriveMapping::result() const {
  MappedDrives result;
  const std::size_t knownDrives = m_knownCount == 0 ? 0 : m_drives[m_knownCount - 1] + 1;
  result.known = m_knownCount;
  const std::vector<FixFit> fits = fixFits(m_factors.gnss, m_state, m_drives);
  result.fixes.assign(fits.begin() + static_cast<std::ptrdiff_t>(knownDrives), fits.end());
  result.odometry.assign(m_state.odometry.begin() + static_cast<std::ptrdiff_t>(knownDrives),
                         m_state.odometry.end());
  result.poses = poses();
  for (const Loop& loop : m_loops) result.loops.push_back({loop.tie.first, loop.tie.second});
  for (const PoleTrack& track : m_tracks.tracks) result.tracks += track.hits >= kFollowed ? 1 : 0;
  for (std::size_t i = m_knownCount + 1; i < m_scans.size(); ++i)
    if (m_drives[i] == m_drives[i - 1])
      result.driven += (centreOf(m_state.poses[i]) - centreOf(m_state.poses[i - 1])).norm();
  return result;
}

}  // namespace

std::size_t MappedDrives::newLoops() const {
  const auto count = std::count_if(loops.begin(), loops.end(), [this](const ClosedLoop& loop) {
    return std::max(loop.first, loop.second) >= known;
  });
  return static_cast<std::size_t>(count);
}

MappedDrives mapDrives(DrivesToMap drives, const AdjustmentTrust& trust) {
  return DriveMapping(std::move(drives), trust).run();
}

}  // namespace polemcl
