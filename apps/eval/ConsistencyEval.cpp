/// \file ConsistencyEval.cpp
/// \brief `pole-eval consistency`: are the covariances of `pole-localize` right? Poses with
/// covariance against the truth, after convergence (core/evaluation/Consistency.h).

#include <algorithm>
#include <cmath>

#include "cli/RunRecords.h"
#include "core/common/Angles.h"
#include "core/common/PoseInterpolation.h"
#include "core/evaluation/Consistency.h"
#include "core/evaluation/TrajectoryEvaluation.h"
#include "eval/EvalApp.h"
#include "eval/Figures.h"
#include "io/data/Trajectory.h"
#include "io/file/ErrorPlace.h"

namespace polemcl::apps {
namespace {

namespace fs = std::filesystem;

struct ConsistencyOptions : EvalOptions {
  std::vector<fs::path> truth;   ///< TUM; one for all runs, or one for each
  std::vector<fs::path> cov;     ///< `run_NN_cov.csv`, see LocalizeApp.h
  std::vector<fs::path> health;  ///< `run_NN_health.csv` of each run, or empty: with them, only
                                 ///< scans that are `ok` count
  /// Standard deviations of the truth, m and degrees, added to the covariances.
  double truthSigma = 0, truthSigmaDeg = 0;
  double skipSeconds = 0;  ///< left out since the first pose, s
  double skipMetres = 20;  ///< and along the true path, m
};

/// Poses left out.
struct LeftOut {
  std::size_t notOk = 0;      ///< they are not `ok`
  std::size_t unmatched = 0;  ///< the truth does not reach them
};

class RunReader {
 public:
  RunReader(const ConsistencyOptions& options, LeftOut& leftOut)
      : m_options(options), m_leftOut(leftOut) {}

  std::vector<ConsistencySample> samples(std::size_t run) {
    const fs::path& cov = m_options.cov[run];
    const auto truth =
        io::readPlanarTum(m_options.truth.size() == 1 ? m_options.truth[0] : m_options.truth[run]);
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
        ++m_leftOut.unmatched;
        isFirst = true;
        continue;
      }
      if (!last) begin = row.time;
      if (last) metres += std::hypot(pose->x - last->x, pose->y - last->y);
      last = pose;
      if (row.time - begin < m_options.skipSeconds || metres < m_options.skipMetres) continue;
      if (judged && !health->isOk(row.scan)) {
        ++m_leftOut.notOk;
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
    const double metres = m_options.truthSigma, yaw = m_options.truthSigmaDeg * degree;
    estimate.covariance.diagonal() += Eigen::Vector3d(metres, metres, yaw).cwiseAbs2();
    return estimate;
  }

  const ConsistencyOptions& m_options;
  LeftOut& m_leftOut;
};

void requireFitting(const ConsistencyOptions& options) {
  const std::size_t runs = options.cov.size();
  if (runs == 0) throw Error("no covariances to judge: give --cov");
  if (options.truth.size() != 1 && options.truth.size() != runs)
    throw Error(std::to_string(options.truth.size()) + " truths for " + std::to_string(runs) +
                " runs: give one for all, or one for each");
  if (!options.health.empty() && options.health.size() != runs)
    throw Error(std::to_string(options.health.size()) + " health files for " +
                std::to_string(runs) + " runs: give one for each, or none");
}

Json consistencyJson(const ConsistencyScore& score) {
  return {{"nees_mean", score.neesMean},
          {"nees_median", score.neesMedian},
          {"nees_position_mean", score.neesPositionMean},
          {"nees_heading_mean", score.neesHeadingMean},
          {"coverage_95", score.coverage95},
          {"longest_beyond_5_sigma_s", score.longestBeyond5},
          {"worst_beyond_5_sigma_m", score.errorBeyond5},
          {"poses", score.samples}};
}

/// A row of the table.
std::string row(std::string name, const Json& score) {
  name.resize(std::max<std::size_t>(10, name.size()), ' ');
  return name + filled(
                    " {poses:8.0} {nees_mean:8.3} {nees_median:8.3} {nees_position_mean:9.3} "
                    "{nees_heading_mean:8.3} {coverage_95:9.4} "
                    "{longest_beyond_5_sigma_s:11.1}\n",
                    score);
}

Figures consistencyFigures(const ConsistencyOptions& options) {
  requireFitting(options);
  LeftOut leftOut;
  RunReader reader(options, leftOut);
  std::vector<ConsistencySample> all;
  Json runs = Json::array();
  std::string rows;
  for (const fs::path& cov : options.cov) {
    const std::size_t index = runs.size();
    const auto samples = reader.samples(index);
    const Json score = consistencyJson(
        io::located(cov.string() + ": ", [&] { return scoreConsistency(samples); }));
    rows += row(std::to_string(index), score);
    runs.push_back({{"file", cov.string()}});
    runs.back().update(score);
    all.insert(all.end(), samples.begin(), samples.end());
  }
  Json json = consistencyJson(scoreConsistency(all));
  rows += row("all", json);
  json.update(Json{{"not_ok", leftOut.notOk},
                   {"unmatched", leftOut.unmatched},
                   {"truth_sigma_m", options.truthSigma},
                   {"truth_sigma_deg", options.truthSigmaDeg},
                   {"skip_s", options.skipSeconds},
                   {"skip_m", options.skipMetres},
                   {"runs", runs}});
  if (leftOut.notOk > 0) rows += filled("{not_ok} poses that are not ok left out\n", json);
  if (leftOut.unmatched > 0)
    rows += filled("{unmatched} poses that the truth does not cover\n", json);
  return {json,
          "normalised squared errors; right are 3, 2.37 (median), 2 (x y), 1 (yaw), and 0.95 of "
          "the true positions within the 95 % ellipses; longest time in a row beyond 5 sigma of "
          "the position\n"
          "run           poses     mean   median  position  heading  coverage  5 sigma, s\n" +
              rows};
}

void declareConsistency(CLI::App& cli, ConsistencyOptions& options) {
  addFile(cli, "--truth", options.truth,
          "True robot poses, TUM: one file for all runs, or one per run")
      ->required();
  addFile(cli, "--cov", options.cov, "run_NN_cov.csv of pole-localize, one or several")->required();
  addFile(cli, "--health", options.health,
          "run_NN_health.csv of each run: count only poses that are ok");
  addNumber(cli, "--truth-sigma-m", options.truthSigma,
            "Standard deviation of the true positions along an axis, m", CLI::NonNegativeNumber);
  addNumber(cli, "--truth-sigma-deg", options.truthSigmaDeg, "The same of the true headings, deg",
            CLI::NonNegativeNumber);
  addNumber(cli, "--skip-seconds", options.skipSeconds,
            "Time after the first pose that is left out, s", CLI::NonNegativeNumber);
  addNumber(cli, "--skip-metres", options.skipMetres,
            "Path after the first pose that is left out, m", CLI::NonNegativeNumber);
}

}  // namespace

Subcommand consistencyCommand(CLI::App& program) {
  return evalCommand<ConsistencyOptions>(program, "consistency",
                                         "Compares the errors of poses with their covariances",
                                         declareConsistency, consistencyFigures);
}

}  // namespace polemcl::apps
