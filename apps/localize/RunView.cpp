#include "localize/RunView.h"

#include <utility>

#include "core/common/PoseInterpolation.h"
#include "core/evaluation/TrajectoryEvaluation.h"

namespace polemcl::apps {

RunView::RunView(const report::ViewOptions& options, WatchedRun run, const RunFolder& folder)
    : m_options(options), m_truth(run.truth) {
  m_options.validate();
  if (m_options.scenes > 0 || !m_options.frames.empty())
    m_recorder = std::make_unique<SceneRecorder>(m_options, run.map, run.name,
                                                 folder.staged("run_00_scenes"));
  if (m_options.live)
    m_player = std::make_unique<LivePlayer>(m_options, run.map, run.name, run.source,
                                            std::move(run.reading));
}

RunView::~RunView() = default;

void RunView::show(const LocalizationPipeline& localization, const PoleScan& frame,
                   const LocalizationUpdate& update, const WatchedScan& scan) {
  if (!m_player && !m_recorder) return;
  if (m_scan == 0) m_start = frame.time;
  std::optional<Pose2D> truth;
  if (m_truth) truth = poseAt(*m_truth, frame.time, longestTruthGap);
  m_way.add(update);
  m_trueWay.add(truth, false);
  const bool recorded = m_recorder && m_recorder->wants(m_scan);
  if (recorded || isOpen()) {
    auto moment = report::momentOf(localization, frame, update, m_scan, m_start);
    moment.truth = truth;
    if (isOpen()) m_player->add(moment, scan);
    moment.way = m_way.points();
    moment.trueWay = m_trueWay.points();
    if (recorded) m_recorder->add(std::move(moment));
  }
  ++m_scan;
}

void RunView::finish() {
  if (m_player) m_player->end();
  if (m_recorder) m_recorder->finish();
}

void RunView::waitForWindow() {
  if (m_player) m_player->wait(m_options.hold);
}

}  // namespace polemcl::apps
