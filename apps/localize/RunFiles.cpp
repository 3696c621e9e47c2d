#include "localize/RunFiles.h"

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <utility>

#include <polemcl/core/common/Types.h>
#include "cli/RunRecords.h"
#include "core/common/Angles.h"
#include "io/data/Trajectory.h"
#include "localize/LocalizeReport.h"

namespace polemcl::apps {
namespace {

constexpr double kLeastError = 0.5;  ///< m; true poses may be off, too
constexpr double kMostSpreads = 5;   ///< of the pose

void write(const std::filesystem::path& file, std::string_view text, std::ios::openmode mode) {
  errno = 0;
  std::ofstream stream(file, std::ios::binary | mode);
  stream << text;
  stream.close();
  if (!stream)
    throw Error("cannot write " + file.string() + ": " +
                (errno != 0 ? std::strerror(errno) : "a write failed"));
}

}  // namespace

GrowingFile::GrowingFile(std::filesystem::path file) : m_file(std::move(file)) {
  write(m_file, {}, std::ios::trunc);
}

void GrowingFile::add(std::string_view text) {
  m_collected += text;
  if (m_collected.size() >= kPiece) flush();
}

void GrowingFile::flush() {
  if (m_collected.empty()) return;
  write(m_file, m_collected, std::ios::app);
  m_collected.clear();
}

RunFiles::RunFiles(const RunFolder& folder, std::size_t run,
                   const std::vector<StampedPose2D>* truth)
    : m_errorsFile(folder.staged(runName(run) + "_errors.csv")),
      m_trajectory(folder.staged(runName(run) + ".tum")),
      m_covariances(folder.staged(runName(run) + "_cov.csv")),
      m_health(folder.staged(runName(run) + "_health.csv")) {
  if (truth) m_evaluator.emplace(*truth);
  m_covariances.add(kEstimateColumns);
  m_health.add(
      "scan,timestamp,state,reason,matched_share,seen_share,innovation,effective_particles,"
      "particles,"
      "mode_share,spread_m,spread_deg,poles,relocalized\n");
}

void RunFiles::add(const LocalizationUpdate& update) {
  addHealth(update);
  if (update.estimate) addPose(update);
  ++m_scan;
}

std::optional<TrajectoryErrors> RunFiles::finish(bool isCovered) {
  m_trajectory.flush();
  m_covariances.flush();
  m_health.flush();
  if (m_errors) m_errors->flush();
  if (!isCovered || !m_evaluator || m_evaluator->estimates() == 0) return std::nullopt;
  return m_evaluator->finish();
}

void RunFiles::addPose(const LocalizationUpdate& update) {
  const StampedPose2D pose{update.time, update.estimate->mean};
  m_trajectory.add(io::tumRow(pose));
  m_covariances.add(estimateRow(m_scan, update.time, *update.estimate));
  if (!m_evaluator) return;
  if (const auto error = m_evaluator->add(pose)) addError(*error, update);
}

void RunFiles::addHealth(const LocalizationUpdate& update) {
  const Health& health = update.health;
  char line[300];
  std::snprintf(line, sizeof line, "%zu,%.9f,%s,%s,%.4f,%.3f,%.4f,%.1f,%zu,%.4f,%.5f,%.5f,%zu,%d\n",
                m_scan, update.time, name(health.state), name(health.reason), health.matchedShare,
                health.seenShare, health.innovation, health.effectiveParticles,
                update.step.particles, health.modeShare, health.spread,
                health.spreadHeading / degree, update.poles, int(update.relocalized));
  m_health.add(line);
}

void RunFiles::addError(const PoseError& error, const LocalizationUpdate& update) {
  if (!m_errors) {
    m_errors.emplace(m_errorsFile);
    m_errors->add(
        "scan,timestamp,position_m,lateral_m,longitudinal_m,heading_deg,poles,effective_share\n");
  }
  char line[200];
  std::snprintf(line, sizeof line, "%zu,%.9f,%.6f,%.6f,%.6f,%.6f,%zu,%.6f\n", m_scan, error.time,
                error.position, error.lateral, error.longitudinal, error.heading / degree,
                update.poles, update.step.effectiveShare);
  m_errors->add(line);
  if (update.health.state != HealthState::ok) return;
  ++m_spreadCheck.ok;
  m_spreadCheck.beyond +=
      error.position > std::max(kLeastError, kMostSpreads * update.health.spread);
}

}  // namespace polemcl::apps
