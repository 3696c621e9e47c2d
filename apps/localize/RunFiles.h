#pragma once
/// \file RunFiles.h
/// \brief The files of one run of `pole-localize`, written scan by scan. Private to the library.

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/evaluation/TrajectoryEvaluation.h"
#include "localize/RunFolder.h"
#include "mrpt/filter/LocalizationPipeline.h"

namespace polemcl::apps {

/// \brief The file is open only while a piece is written, so that any number of files can be in
/// progress. It has its final name from the start: use it in folders that become visible when
/// complete.
class GrowingFile {
 public:
  static constexpr std::size_t kPiece = 4096;  ///< bytes collected before a write

  /// \brief Creates an empty file. \throws Error when that fails.
  explicit GrowingFile(std::filesystem::path file);
  /// \brief Appends text. \throws Error when a write failed.
  void add(std::string_view text);
  /// \brief Writes the collected text. Text after the last flush() is lost. \throws Error as add().
  void flush();

 private:
  std::filesystem::path m_file;
  std::string m_collected;
};

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
  GrowingFile m_trajectory, m_covariances, m_health;
  std::optional<GrowingFile> m_errors;  ///< from the first error on
  std::optional<TrajectoryEvaluator> m_evaluator;
  SpreadCheck m_spreadCheck;
  std::size_t m_scan = 0;  ///< taken so far
};

}  // namespace polemcl::apps
