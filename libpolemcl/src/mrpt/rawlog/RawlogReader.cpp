#include "mrpt/rawlog/RawlogReader.h"

#include <mrpt/core/Clock.h>
#include <mrpt/obs/CActionCollection.h>
#include <mrpt/obs/CActionRobotMovement2D.h>
#include <mrpt/obs/CObservationComment.h>
#include <mrpt/obs/CSensoryFrame.h>
#include <mrpt/poses/CPosePDF.h>
#include <mrpt/serialization/CArchive.h>

#include <algorithm>
#include <cstdint>
#include <limits>
#include <new>
#include <stdexcept>
#include <vector>

#include <polemcl/mrpt/map/CPoleMap.h>
#include "io/file/FileKind.h"
#include "io/file/ReadLimits.h"
#include "mrpt/common/AllocationLimit.h"
#include "mrpt/common/MrptReason.h"

namespace polemcl {

using mrpt::obs::CActionCollection;
using mrpt::obs::CActionRobotMovement2D;
using mrpt::obs::CSensoryFrame;
using mrpt::serialization::CSerializable;

namespace {

constexpr std::size_t kMostComment = 1 << 20;   ///< bytes of the comments that are kept
constexpr std::uint64_t kRepeated = 256 << 20;  ///< bytes that may repeat: a parked vehicle
constexpr std::uint32_t kMostElements = 4096;   ///< of a frame or a collection of actions

/// Reads the objects of a rawlog. MRPT's own reading of a CSensoryFrame or a CActionCollection
/// takes memory for the count in the file before it reads an element, and crashes if an element is
/// null or of a foreign class. Here memory grows with the elements that the file holds, and each is
/// checked. A movement whose distribution is null or something else would crash MRPT as well: it is
/// refused before.
class RawlogArchive : public mrpt::serialization::CArchiveStreamBase<GzReadStream> {
 public:
  /// \param most Bytes of one object.
  RawlogArchive(GzReadStream& stream, std::uint64_t most)
      : CArchiveStreamBase(stream), m_most(most) {}

  /// The next object of the file, never null.
  /// \throws std::exception when it is damaged or its class is unknown. The archive cannot be used
  ///         after it.
  CSerializable::Ptr readEntry();

 protected:
  std::size_t read(void* data, std::size_t size) override;

 private:
  struct Header {
    std::string name;
    bool old = false;  ///< written before MRPT 0.5.5
    std::int8_t version = 0;
    const mrpt::rtti::TRuntimeClassId* known = nullptr;  ///< none: the object is null
  };
  Header readHeader();
  CSerializable::Ptr readObject(const Header& header);
  void requireDistribution(std::int8_t version);
  CSerializable::Ptr readFrame(const Header& header);
  CSerializable::Ptr readActions(const Header& header);
  template <class Element>
  typename Element::Ptr readElement(std::uint32_t index, const char* wanted);

  std::uint64_t m_most, m_taken = 0;  ///< bytes of the file
  bool m_keeps = false;               ///< what is read now is read again
  std::vector<std::uint8_t> m_again;  ///< to be read again, before the rest of the file
};

std::size_t RawlogArchive::read(void* data, std::size_t size) {
  const std::size_t again = m_keeps ? 0 : std::min(size, m_again.size());
  std::copy_n(m_again.begin(), again, static_cast<std::uint8_t*>(data));
  m_again.erase(m_again.begin(), m_again.begin() + static_cast<std::ptrdiff_t>(again));
  std::uint8_t* rest = static_cast<std::uint8_t*>(data) + again;
  const std::size_t count = again < size ? CArchiveStreamBase::read(rest, size - again) : 0;
  m_taken += count;
  if (m_taken > m_most)
    throw std::runtime_error("it holds more than " + std::to_string(m_most >> 20) +
                             " MB; no object of a file of this size does");
  if (m_keeps) m_again.insert(m_again.end(), rest, rest + count);
  return again + count;
}

RawlogArchive::Header RawlogArchive::readHeader() {
  Header header;
  internal_ReadObjectHeader(header.name, header.old, header.version);
  if (header.name == "nullptr") return header;
  header.known = mrpt::rtti::findRegisteredClass(header.name);
  if (!header.known)
    throw std::runtime_error("the class '" + header.name + "' which is not registered");
  return header;
}

CSerializable::Ptr RawlogArchive::readObject(const Header& header) {
  CSerializable::Ptr object;
  if (header.known->ptrCreateObject)  // the class is not abstract
    object = std::dynamic_pointer_cast<CSerializable>(header.known->createObject());
  if (!object) throw std::runtime_error("a class without content, '" + header.name + "'");
  if (header.known == CLASS_ID(CActionRobotMovement2D)) requireDistribution(header.version);
  internal_ReadObject(object.get(), header.name, header.old, header.version);
  return object;
}

/// Looks ahead at a CActionRobotMovement2D. MRPT takes its distribution without asking whether it
/// is one.
void RawlogArchive::requireDistribution(std::int8_t version) {
  m_keeps = true;
  const bool isFirst = version < 2;  // in the file; else after the method, if there is one
  const bool hasOne = isFirst || ReadAs<std::int32_t>() != CActionRobotMovement2D::emOdometry;
  const auto* known = hasOne ? readHeader().known : nullptr;
  m_keeps = false;
  if (hasOne && !(known && known->derivedFrom(CLASS_ID(mrpt::poses::CPosePDF)) &&
                  known->ptrCreateObject))  // abstract classes have none
    throw std::runtime_error("a movement without a distribution of poses");
}

CSerializable::Ptr RawlogArchive::readEntry() {
  const Header header = readHeader();
  if (!header.known) throw std::runtime_error("an object of no class");
  CSerializable::Ptr object;
  if (header.known == CLASS_ID(CSensoryFrame))
    object = readFrame(header);
  else if (header.known == CLASS_ID(CActionCollection))
    object = readActions(header);
  else
    return readObject(header);
  internal_ReadObject(nullptr, header.name, header.old, header.version);  // its end
  return object;
}

template <class Element>
typename Element::Ptr RawlogArchive::readElement(std::uint32_t index, const char* wanted) {
  if (index == kMostElements)
    throw std::runtime_error("a collection of more than " + std::to_string(kMostElements) +
                             " elements");
  const Header header = readHeader();
  if (!header.known || !header.known->derivedFrom(CLASS_ID(Element)))
    throw std::runtime_error("element " + std::to_string(index) + " of its collection is " +
                             (header.known ? "a " + header.name : "null") + ", not " + wanted);
  return std::dynamic_pointer_cast<Element>(readObject(header));
}

CSerializable::Ptr RawlogArchive::readFrame(const Header& header) {
  if (header.version < 0 || header.version > 2)
    throw std::runtime_error("a sensory frame of the unknown version " +
                             std::to_string(header.version));
  auto frame = CSensoryFrame::Create();
  mrpt::Clock::time_point time;
  if (header.version < 2) ReadAs<std::uint32_t>();  // a number that nobody uses
  if (header.version == 0) *this >> time;           // instead of those of the observations
  const auto count = ReadAs<std::uint32_t>();
  for (std::uint32_t i = 0; i < count; ++i) {
    const auto observation = readElement<mrpt::obs::CObservation>(i, "an observation");
    if (header.version == 0) observation->timestamp = time;
    frame->insert(observation);
  }
  return frame;
}

CSerializable::Ptr RawlogArchive::readActions(const Header& header) {
  if (header.version != 0)
    throw std::runtime_error("a collection of actions of the unknown version " +
                             std::to_string(header.version));
  auto actions = CActionCollection::Create();
  const auto count = ReadAs<std::uint32_t>();
  for (std::uint32_t i = 0; i < count; ++i)
    actions->insertPtr(readElement<mrpt::obs::CAction>(i, "an action"));
  return actions;
}

/// The class in "... class 'NAME' which is not registered ..."; empty for other messages.
std::string unregisteredClass(const std::string& message) {
  const auto end = message.find("' which is not registered");
  if (end == std::string::npos) return {};
  const auto begin = message.rfind('\'', end - 1);
  return begin == std::string::npos ? "" : message.substr(begin + 1, end - begin - 1);
}

bool printable(const std::string& text) {
  for (const char c : text)
    if (c < 0x21 || c > 0x7e) return false;
  return !text.empty();
}

}  // namespace

/// Handles data that end inside the object at `offset`: an Error, unless this is allowed.
void RawlogReader::endsHere(std::uint64_t offset) {
  m_ended = true;
  if (!m_allowTruncated)
    throw Error(m_name + ": truncated: the file ends inside an object that starts at byte " +
                std::to_string(offset) + " (object " + std::to_string(m_objects) +
                "); copy the file again, or allow truncated files to use the entries before");
  m_truncated = true;
}

void RawlogReader::explain(std::uint64_t offset, const std::string& what) {
  const std::string at = " at byte " + std::to_string(offset);
  const std::string unknown = unregisteredClass(what);
  if (printable(unknown))
    throw Error(m_name + ": class '" + unknown + "'" + at +
                " is unknown: load the library that defines it");
  if (const std::string kind = io::otherKind(m_name, ".rawlog"); m_objects == 0 && !kind.empty())
    throw Error(m_name + ": " + kind + "not a rawlog of scans or poles");
  if (m_objects == 0) throw Error(m_name + ": is not a rawlog: " + mrptReason(what));
  throw Error(m_name + ": object " + std::to_string(m_objects) + at +
              " is damaged: " + mrptReason(what));
}

/// A part of an object that is larger than this is one that the file does not hold.
std::size_t RawlogReader::mostAtATime() const {
  return m_growing ? std::numeric_limits<std::size_t>::max()
                   : io::mostInflated(m_stream.getTotalBytesCount());
}

/// Reads one object of the file; nullopt at its end.
std::optional<RawlogReader::Object> RawlogReader::readObject() {
  if (m_ended) return std::nullopt;
  const std::uint64_t offset = m_stream.getPosition();
  if (m_stream.atCleanEnd()) {
    m_ended = true;
    if (m_objects == 0) {
      if (!m_allowTruncated) throw Error(m_name + ": is empty: there is no object in it");
      m_truncated = true;
    }
    return std::nullopt;
  }
  const std::uint64_t most = kRepeated + mostAtATime();
  if (!m_growing && offset > most)
    throw Error(m_name + ": holds more than " + std::to_string(most >> 20) +
                " MB, uncompressed; no rawlog of its size does");
  const AllocationLimit limit(mostAtATime());
  std::string what;
  try {
    Object object{RawlogArchive(m_stream, mostAtATime()).readEntry(), offset};
    ++m_objects;
    return object;
  } catch (const std::bad_alloc& error) {
    if (!limit.reached()) throw;  // the machine's fault, not the file's
    what = error.what();
  } catch (const std::exception& error) {
    what = error.what();
    if (what.rfind(m_name + ": ", 0) == 0) throw;  // about the file itself, not its content
  }
  // An unknown class may also be the first to reach the end of the data.
  const bool endsBefore = m_stream.cutShort() || limit.reached();
  if (!endsBefore || !unregisteredClass(what).empty()) explain(offset, what);
  endsHere(offset);
  return std::nullopt;
}

std::optional<RawlogReader::Object> RawlogReader::nextObject() {
  if (!m_pending) return readObject();
  std::optional<Object> object;
  object.swap(m_pending);
  return object;
}

RawlogReader::RawlogReader(const std::string& path, bool allowTruncated, double follow)
    : m_name(path),
      m_stream(path, follow),
      m_allowTruncated(allowTruncated),
      m_growing(follow > 0) {
  registerClasses();
}

bool RawlogReader::next(RawlogEntry& entry) {
  using namespace mrpt::obs;
  entry = RawlogEntry();
  while (auto read = nextObject()) {
    entry.offset = read->offset;
    if (const auto comment = std::dynamic_pointer_cast<CObservationComment>(read->object)) {
      if (m_comment.size() + comment->text.size() >= kMostComment) continue;
      if (!m_comment.empty()) m_comment += '\n';
      m_comment += comment->text;
      continue;
    }
    entry.observation = std::dynamic_pointer_cast<CObservation>(read->object);
    entry.frame = std::dynamic_pointer_cast<CSensoryFrame>(read->object);
    entry.action = std::dynamic_pointer_cast<CActionCollection>(read->object);
    if (entry.observation || entry.frame) return true;
    if (!entry.action) continue;
    auto following = readObject();
    if (!following) return true;  // rawlogs often end with an action
    entry.frame = std::dynamic_pointer_cast<CSensoryFrame>(following->object);
    if (!entry.frame) m_pending = std::move(following);
    return true;
  }
  return false;
}

}  // namespace polemcl
