#include "mrpt/rawlog/RawlogReader.h"

#include <mrpt/obs/CObservationComment.h>
#include <mrpt/serialization/CArchive.h>

#include <optional>

#include "mrpt/common/MrptReason.h"
#include "mrpt/map/RegisterClasses.h"
#include "mrpt/rawlog/GzReadStream.h"

namespace polemcl {

using mrpt::serialization::CSerializable;

struct RawlogReader::Impl {
  Impl(const std::string& path, bool allowed) : name(path), stream(path), allowTruncated(allowed) {}

  struct Object {
    CSerializable::Ptr object;
    std::uint64_t offset = 0;
  };

  std::string name;
  GzReadStream stream;
  bool allowTruncated;
  bool truncated = false, ended = false;
  std::optional<Object> pending;  ///< object after an action, read ahead
  std::uint64_t objects = 0;      ///< number of objects read so far

  std::optional<Object> readObject();
  std::optional<Object> nextObject();
  void endsHere(std::uint64_t offset);
  [[noreturn]] void explain(std::uint64_t offset, const std::string& what);
};

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
void RawlogReader::Impl::endsHere(std::uint64_t offset) {
  ended = true;
  if (!allowTruncated)
    throw Error(name + ": truncated: the file ends inside an object that starts at byte " +
                std::to_string(offset) + " (object " + std::to_string(objects) +
                "); copy the file again, or allow truncated files to use the entries before");
  truncated = true;
}

void RawlogReader::Impl::explain(std::uint64_t offset, const std::string& what) {
  const std::string at = " at byte " + std::to_string(offset);
  const std::string unknown = unregisteredClass(what);
  if (printable(unknown))
    throw Error(name + ": class '" + unknown + "'" + at +
                " is unknown: load the library that defines it");
  if (objects == 0) throw Error(name + ": is not a rawlog: " + mrptReason(what));
  throw Error(name + ": object " + std::to_string(objects) + at +
              " is damaged: " + mrptReason(what));
}

/// Reads one object of the file; nullopt at its end.
std::optional<RawlogReader::Impl::Object> RawlogReader::Impl::readObject() {
  if (ended) return std::nullopt;
  const std::uint64_t offset = stream.getPosition();
  if (stream.atCleanEnd()) {
    ended = true;
    if (objects == 0) {
      if (!allowTruncated) throw Error(name + ": is empty: there is no object in it");
      truncated = true;
    }
    return std::nullopt;
  }
  std::string what;
  try {
    auto archive = mrpt::serialization::archiveFrom(stream);
    Object object{archive.ReadObject(), offset};
    if (!object.object) throw std::runtime_error("an object of no class");
    ++objects;
    return object;
  } catch (const std::exception& error) {
    what = error.what();
    if (what.rfind(name + ": ", 0) == 0) throw;  // about the file itself, not its content
  }
  // An unknown class may also be the first to reach the end of the data.
  if (!stream.cutShort() || !unregisteredClass(what).empty()) explain(offset, what);
  endsHere(offset);
  return std::nullopt;
}

std::optional<RawlogReader::Impl::Object> RawlogReader::Impl::nextObject() {
  if (!pending) return readObject();
  std::optional<Object> object;
  object.swap(pending);
  return object;
}

RawlogReader::RawlogReader(const std::string& path, bool allowTruncated) {
  registerClasses();
  m_impl = std::make_unique<Impl>(path, allowTruncated);
}
RawlogReader::~RawlogReader() = default;
RawlogReader::RawlogReader(RawlogReader&&) noexcept = default;
RawlogReader& RawlogReader::operator=(RawlogReader&&) noexcept = default;

bool RawlogReader::next(RawlogEntry& entry) {
  using namespace mrpt::obs;
  entry = RawlogEntry();
  while (auto read = m_impl->nextObject()) {
    entry.offset = read->offset;
    if (std::dynamic_pointer_cast<CObservationComment>(read->object)) continue;
    entry.observation = std::dynamic_pointer_cast<CObservation>(read->object);
    entry.frame = std::dynamic_pointer_cast<CSensoryFrame>(read->object);
    entry.action = std::dynamic_pointer_cast<CActionCollection>(read->object);
    if (entry.observation || entry.frame) return true;
    if (!entry.action) continue;
    auto following = m_impl->readObject();
    if (!following) return true;  // rawlogs often end with an action
    entry.frame = std::dynamic_pointer_cast<CSensoryFrame>(following->object);
    if (!entry.frame) m_impl->pending = std::move(following);
    return true;
  }
  return false;
}

bool RawlogReader::truncated() const {
  return m_impl->truncated;
}

double RawlogReader::progress() const {
  return m_impl->stream.progress();
}

}  // namespace polemcl
