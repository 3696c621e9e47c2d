#pragma once
/// \file RunFiles.h
/// \brief The files of one run of `pole-localize`, written scan by scan. Private to the library.

#include <optional>
#include <string>
#include <vector>

#include "core/evaluation/TrajectoryEvaluation.h"
#include "io/file/GrowingFile.h"
#include "localize/RunFolder.h"
#include "mrpt/filter/LocalizationPipeline.h"

namespace polemcl::apps {

/// \brief Errors at scans that were `ok`, against the spread of the pose.
struct SpreadCheck {
  std::size_t ok = 0;      ///< scans that were `ok` and have a true pose
  std::size_t beyond = 0;  ///< of them: error above 0.5 m and 5 times the spread
  /// True when this is so at a tenth of them: such errors have no normal cause.
  bool contradicts() const { return beyond > 0 && 10 * beyond >= ok; }
};

/// \brief `run_NN.tum`, `run_NN_cov.csv`, `run_NN_health.csv` and, with truth, `run_NN_errors.csv`:
/// see LocalizeApp.h.
class RunFiles {
 public:
  /// \param truth Null, or must outlive this object.
  /// \throws Error when a file cannot be created.
  RunFiles(const RunFolder& folder, std::size_t run, const std::vector<StampedPose2D>* truth);

  /// \brief The next scan. \throws Error when it cannot be written, or a pose is not finite.
  void add(const LocalizationUpdate& update);
  /// \brief After the last scan: completes the files. \param isCovered The truth covers the drive.
  /// \return The errors; none without such a truth, or when no pose was ever known.
  /// \throws Error when a file cannot be written, or the truth covers less than half of the poses.
  std::optional<TrajectoryErrors> finish(bool isCovered);
  const SpreadCheck& spreadCheck() const { return m_spreadCheck; }

 private:
  void addPose(const LocalizationUpdate& update);
  void addHealth(const LocalizationUpdate& update);
  void addError(const PoseError& error, const LocalizationUpdate& update);

  std::filesystem::path m_errorsFile;
  io::GrowingFile m_trajectory, m_covariances, m_health;
  std::optional<io::GrowingFile> m_errors;  ///< from the first error on
  std::optional<TrajectoryEvaluator> m_evaluator;
  SpreadCheck m_spreadCheck;
  std::size_t m_scan = 0;  ///< taken so far
};

}  // namespace polemcl::apps
