#include "mrpt/rawlog/RawlogReader.h"

#include <mrpt/obs/CObservationComment.h>

#include <limits>
#include <new>

#include <polemcl/mrpt/map/CPoleMap.h>
#include "io/file/FileKind.h"
#include "io/file/ReadLimits.h"
#include "mrpt/common/MrptReason.h"
#include "mrpt/rawlog/AllocationLimit.h"
#include "mrpt/rawlog/RawlogArchive.h"

namespace polemcl {

namespace {

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
  const AllocationLimit limit(mostAtATime());
  std::string what;
  try {
    Object object{RawlogArchive(m_stream).readEntry(), offset};
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
