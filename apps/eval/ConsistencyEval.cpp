#include "eval/ConsistencyEval.h"

#include <cmath>

#include "cli/JsonFile.h"
#include "cli/RunRecords.h"
#include "core/common/Angles.h"
#include "core/common/PoseInterpolation.h"
#include "core/evaluation/TrajectoryEvaluation.h"
#include "io/data/Trajectory.h"
#include "io/file/ErrorPlace.h"

namespace polemcl::apps {
namespace {

namespace fs = std::filesystem;

class RunReader {
 public:
  RunReader(const EvalConsistencyOptions& options, ConsistencyResult& result)
      : m_options(options), m_result(result) {}

  std::vector<ConsistencySample> samples(std::size_t run) {
    const fs::path& cov = m_options.cov[run];
    const auto truth = io::planar(
        io::readTum(m_options.truth.size() == 1 ? m_options.truth[0] : m_options.truth[run]));
    const bool judged = !m_options.health.empty();
    std::optional<HealthRecords> health;
    if (judged) health.emplace(m_options.health[run]);
    std::vector<ConsistencySample> samples;
    std::optional<Pose2D> last;
    double begin = 0, metres = 0;
    bool isFirst = true;
    for (const EstimateRecord& row : readEstimates(cov)) {
      const auto pose = poseAt(truth, row.time, longestTruthGap);
      if (!pose) {
        ++m_result.unmatched;
        isFirst = true;
        continue;
      }
      if (!last) begin = row.time;
      if (last) metres += std::hypot(pose->x - last->x, pose->y - last->y);
      last = pose;
      if (row.time - begin < m_options.skipSeconds || metres < m_options.skipMetres) continue;
      if (judged && !health->isOk(row.scan)) {
        ++m_result.notOk;
        isFirst = true;
        continue;
      }
      samples.push_back({withTruthSigma(row.estimate), *pose, row.time, isFirst});
      isFirst = false;
    }
    if (samples.empty())
      throw Error(cov.string() + ": no pose is left to judge after the first " +
                  std::to_string(m_options.skipSeconds) + " s and " +
                  std::to_string(m_options.skipMetres) + " m" +
                  (judged ? ", of those that are ok" : "") + " and covered by the truth");
    return samples;
  }

 private:
  PoseWithCovariance withTruthSigma(PoseWithCovariance estimate) const {
    const double metres = m_options.truthSigma, yaw = m_options.truthSigmaYaw;
    estimate.covariance.diagonal() += Eigen::Vector3d(metres, metres, yaw).cwiseAbs2();
    return estimate;
  }

  const EvalConsistencyOptions& m_options;
  ConsistencyResult& m_result;
};

void requireFitting(const EvalConsistencyOptions& options) {
  const std::size_t runs = options.cov.size();
  if (runs == 0) throw Error("no covariances to judge: give --cov");
  if (options.truth.size() != 1 && options.truth.size() != runs)
    throw Error(std::to_string(options.truth.size()) + " truths for " + std::to_string(runs) +
                " runs: give one for all, or one for each");
  if (!options.health.empty() && options.health.size() != runs)
    throw Error(std::to_string(options.health.size()) + " health files for " +
                std::to_string(runs) + " runs: give one for each, or none");
  if (!(options.skipSeconds >= 0) || !(options.skipMetres >= 0))
    throw Error("what is skipped must be 0 s and 0 m or more");
  if (!(options.truthSigma >= 0) || !(options.truthSigmaYaw >= 0))
    throw Error("the standard deviations of the truth must be 0 or more");
}

nlohmann::ordered_json consistencyJson(const ConsistencyScore& score) {
  return {{"nees_mean", score.neesMean},
          {"nees_median", score.neesMedian},
          {"nees_position_mean", score.neesPositionMean},
          {"nees_heading_mean", score.neesHeadingMean},
          {"coverage_95", score.coverage95},
          {"longest_beyond_5_sigma_s", score.longestBeyond5},
          {"poses", score.samples}};
}

nlohmann::ordered_json consistencyJson(const EvalConsistencyOptions& options,
                                       const ConsistencyResult& result) {
  nlohmann::ordered_json out = consistencyJson(result.all);
  out["not_ok"] = result.notOk;
  out["unmatched"] = result.unmatched;
  out["truth_sigma_m"] = options.truthSigma;
  out["truth_sigma_deg"] = options.truthSigmaYaw / degree;
  out["skip_s"] = options.skipSeconds;
  out["skip_m"] = options.skipMetres;
  out["runs"] = nlohmann::ordered_json::array();
  for (std::size_t i = 0; i < result.runs.size(); ++i) {
    nlohmann::ordered_json run;
    run["file"] = options.cov[i].string();
    run.update(consistencyJson(result.runs[i]));
    out["runs"].push_back(run);
  }
  return out;
}

}  // namespace

ConsistencyResult evalConsistency(const EvalConsistencyOptions& options) {
  requireFitting(options);
  ConsistencyResult result;
  RunReader reader(options, result);
  std::vector<ConsistencySample> all;
  for (std::size_t run = 0; run < options.cov.size(); ++run) {
    const auto samples = reader.samples(run);
    result.runs.push_back(
        io::located(options.cov[run].string() + ": ", [&] { return scoreConsistency(samples); }));
    all.insert(all.end(), samples.begin(), samples.end());
  }
  result.all = scoreConsistency(all);
  if (options.json) writeJson(*options.json, consistencyJson(options, result));
  return result;
}

}  // namespace polemcl::apps
