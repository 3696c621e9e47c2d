#pragma once
/// \file LocalizePlayer.h
/// \brief Plays a drive to the filters of `pole-localize`, scan by scan. Private to the library.

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "localize/FilterRuns.h"
#include "localize/LocalizeReport.h"
#include "localize/PoseStream.h"
#include "localize/RunBag.h"
#include "localize/RunFiles.h"
#include "localize/RunFolder.h"
#include "localize/RunView.h"

namespace polemcl::apps {

/// \brief What each scan goes through: the filters of all runs, the view, the files of results.
/// Nothing of a scan is kept.
class LocalizePlayer {
 public:
  /// \param facts Its start may be without a pose: the truth gives it then, at the first scan.
  /// \param truth Null without. \param stream Null without. \param bag Null without.
  /// All must outlive this object.
  LocalizePlayer(LocalizeFacts& facts, const LocalizationMap& map,
                 const std::vector<StampedPose2D>* truth, const RunFolder& folder, RunView& view,
                 PoseStream* stream = nullptr, RunBag* bag = nullptr);

  /// \brief The next scan of the drive.
  /// \throws Error when it has no odometry, when there is no start pose, and as FilterRuns,
  ///         RunFiles and RunView do.
  void take(const ReadScan& scan);

  /// \brief After the last scan; `facts.counts` are known now. Why the results say nothing: no
  /// scan, no valid point, no pole in any scan, a truth of less than half of the scans; or empty.
  std::string whyUseless() const;
  /// \brief Completes the files. There must have been a scan.
  LocalizeResult finish();

 private:
  void begin(const PoleScan& first);
  bool isCovered() const;

  LocalizeFacts& m_facts;
  const LocalizationMap& m_map;
  const std::vector<StampedPose2D>* m_truth;
  const RunFolder& m_folder;
  RunView& m_view;
  PoseStream* m_stream;
  RunBag* m_bag;
  std::unique_ptr<FilterRuns> m_runs;  ///< from the first scan on
  std::vector<RunFiles> m_files;
  std::size_t m_covered = 0;  ///< scans at whose time there is a true pose
  LocalizeTimings m_timings;
};

}  // namespace polemcl::apps
