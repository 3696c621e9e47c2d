// Gives a rawlog of poles to the live queue of pole-localize, faster than it was driven.
// tests/long/run.sh loads it into the program (LD_PRELOAD).

#include <mrpt/hwdrivers/CGenericSensor.h>
#include <mrpt/io/CFileGZInputStream.h>
#include <mrpt/obs/CActionCollection.h>
#include <mrpt/obs/CActionRobotMovement2D.h>
#include <mrpt/obs/CObservationOdometry.h>
#include <mrpt/obs/CRawlog.h>
#include <mrpt/obs/CSensoryFrame.h>
#include <mrpt/serialization/CArchive.h>
#include <unistd.h>

#include <csignal>
#include <stdexcept>
#include <string>

namespace polemcl::tests {

/// \brief With each call (`process_rate` a second) the next scan of `rawlog`, and the odometry of
/// its time. Where the rawlog ends, the program gets SIGTERM.
class RawlogPlayer : public mrpt::hwdrivers::CGenericSensor {
  DEFINE_GENERIC_SENSOR(RawlogPlayer)
 public:
  void initialize() override {
    if (!m_in.open(m_file)) throw std::runtime_error(m_file + ": cannot be read");
  }

  void doProcess() override {
    m_state = ssWorking;
    mrpt::obs::CActionCollection::Ptr actions;
    mrpt::obs::CSensoryFrame::Ptr frame;
    mrpt::obs::CObservation::Ptr observation;
    auto archive = mrpt::serialization::archiveFrom(m_in);
    if (m_calls > 0) return end();
    if (!mrpt::obs::CRawlog::getActionObservationPairOrObservation(archive, actions, frame,
                                                                   observation, m_entry)) {
      ++m_calls;
      return;
    }
    if (!actions || !frame) return;
    const auto scan = frame->getObservationByIndex(0);
    if (const auto move = actions->getBestMovementEstimation())
      m_pose = m_pose + mrpt::poses::CPose2D(move->poseChange->getMeanVal());
    auto odometry = mrpt::obs::CObservationOdometry::Create();
    odometry->sensorLabel = "odometry";
    odometry->timestamp = scan->timestamp;
    odometry->odometry = m_pose;
    appendObservation(odometry);
    appendObservation(scan);
  }

 protected:
  void loadConfig_sensorSpecific(const mrpt::config::CConfigFileBase& config,
                                 const std::string& section) override {
    m_file = config.read_string(section, "rawlog", "");
  }

 private:
  /// Once, some calls after the last scan, so that it is not left behind in the queue.
  void end() {
    if (++m_calls == 100) kill(getpid(), SIGTERM);
  }

  std::string m_file;
  mrpt::io::CFileGZInputStream m_in;
  std::size_t m_entry = 0;
  mrpt::poses::CPose2D m_pose;  ///< in the frame of the odometry
  int m_calls = 0;              ///< since the end of the rawlog
};

}  // namespace polemcl::tests

IMPLEMENTS_GENERIC_SENSOR(RawlogPlayer, polemcl::tests)

namespace polemcl::tests {
namespace {
[[maybe_unused]] const bool kRegistered = (RawlogPlayer::doRegister(), true);
}
}  // namespace polemcl::tests
