#include "mrpt/rawlog/RawlogWriter.h"

#include <mrpt/io/CStream.h>
#include <mrpt/obs/CActionRobotMovement2D.h>
#include <mrpt/obs/CObservationComment.h>
#include <mrpt/poses/CPosePDFGaussian.h>
#include <mrpt/serialization/CArchive.h>

#include <stdexcept>
#include <utility>

#include <polemcl/core/common/Types.h>

namespace polemcl {
namespace {

/// MRPT's stream interface to a stream of the standard library.
class OutputStream : public mrpt::io::CStream {
 public:
  explicit OutputStream(std::ostream& stream) : m_stream(stream) {}
  std::size_t Write(const void* buffer, std::size_t count) override {
    m_stream.write(static_cast<const char*>(buffer), static_cast<std::streamsize>(count));
    m_position += count;
    return count;  // the stream remembers failures (disk full); commit() reports them
  }
  std::size_t Read(void*, std::size_t) override {
    throw std::logic_error("a stream for writing only");
  }
  std::uint64_t Seek(std::int64_t, TSeekOrigin) override {
    throw std::logic_error("a stream without seeking");
  }
  std::uint64_t getTotalBytesCount() const override { return m_position; }
  std::uint64_t getPosition() const override { return m_position; }

 private:
  std::ostream& m_stream;
  std::uint64_t m_position = 0;
};

void requireSurvives(const mrpt::obs::CActionCollection& actions) {
  std::size_t index = 0;
  for (const auto& action : actions) {
    const auto move =
        std::dynamic_pointer_cast<mrpt::obs::CActionRobotMovement2D>(action.get_ptr());
    if (move && move->estimationMethod == mrpt::obs::CActionRobotMovement2D::emOdometry)
      throw Error("action " + std::to_string(index) +
                  ": emOdometry would lose its poseChange in a file; set estimationMethod = "
                  "emScan2DMatching");
    ++index;
  }
}

}  // namespace

mrpt::obs::CActionCollection makeActions(const std::optional<PoseWithCovariance>& motion,
                                         const mrpt::Clock::time_point& stamp) {
  mrpt::obs::CActionCollection collection;
  if (!motion) return collection;
  mrpt::obs::CActionRobotMovement2D movement;
  movement.timestamp = stamp;
  movement.estimationMethod = mrpt::obs::CActionRobotMovement2D::emScan2DMatching;
  const auto& mean = motion->mean;
  movement.poseChange =
      mrpt::poses::CPosePDFGaussian::Create(mrpt::poses::CPose2D(mean.x, mean.y, mean.yaw),
                                            mrpt::math::CMatrixDouble33(motion->covariance));
  collection.insert(movement);
  return collection;
}

PoseWithCovariance standstill() {
  return {Pose2D{}, io::floorCovariance()};
}

RawlogWriter::RawlogWriter(const std::string& path) : m_file(path) {}

void RawlogWriter::writeObject(const mrpt::serialization::CSerializable& object) {
  OutputStream stream(m_file.stream());
  mrpt::serialization::archiveFrom(stream) << object;
  if (!m_file.stream()) m_file.commit();  // throws now instead of writing for hours to a full disk
}

void RawlogWriter::writeComment(const std::string& text, double time) {
  mrpt::obs::CObservationComment comment;
  comment.text = text;
  comment.timestamp = mrpt::Clock::fromDouble(time);
  writeObject(comment);
}

void RawlogWriter::write(const mrpt::obs::CActionCollection& action,
                         const mrpt::obs::CObservation::Ptr& observation) {
  if (!observation) throw Error("a frame cannot be written without its observation");
  requireSurvives(action);
  writeObject(action);
  mrpt::obs::CSensoryFrame frame;
  frame.insert(observation);
  writeObject(frame);
}

GnssWriter::GnssWriter(RawlogWriter& rawlog,
                       std::vector<mrpt::obs::CObservationGPS::Ptr> observations)
    : m_rawlog(rawlog), m_observations(std::move(observations)) {}

void GnssWriter::writeBefore(mrpt::system::TTimeStamp scan) {
  while (m_next < m_observations.size() && m_observations[m_next]->timestamp < scan)
    m_rawlog.write(*m_observations[m_next++]);
}

void GnssWriter::writeRest() {
  while (m_next < m_observations.size()) m_rawlog.write(*m_observations[m_next++]);
}

}  // namespace polemcl
