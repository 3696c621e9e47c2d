#include "mrpt/rawlog/RawlogWriter.h"

#include <mrpt/io/CStream.h>
#include <mrpt/obs/CActionRobotMovement2D.h>
#include <mrpt/obs/CObservationComment.h>
#include <mrpt/serialization/CArchive.h>

#include <stdexcept>

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

}  // namespace polemcl
