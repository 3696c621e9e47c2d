#include "mrpt/rawlog/RawlogArchive.h"

#include <mrpt/core/Clock.h>
#include <mrpt/obs/CActionCollection.h>
#include <mrpt/obs/CActionRobotMovement2D.h>
#include <mrpt/obs/CSensoryFrame.h>
#include <mrpt/poses/CPosePDF.h>

#include <algorithm>
#include <stdexcept>

namespace polemcl {

using mrpt::obs::CActionCollection;
using mrpt::obs::CActionRobotMovement2D;
using mrpt::obs::CSensoryFrame;
using mrpt::serialization::CSerializable;

std::size_t RawlogArchive::read(void* data, std::size_t size) {
  const std::size_t again = m_keeps ? 0 : std::min(size, m_again.size());
  std::copy_n(m_again.begin(), again, static_cast<std::uint8_t*>(data));
  m_again.erase(m_again.begin(), m_again.begin() + static_cast<std::ptrdiff_t>(again));
  std::uint8_t* rest = static_cast<std::uint8_t*>(data) + again;
  const std::size_t count = again < size ? CArchiveStreamBase::read(rest, size - again) : 0;
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
  const auto object = std::dynamic_pointer_cast<CSerializable>(header.known->createObject());
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
  if (hasOne && !(known && known->derivedFrom(CLASS_ID(mrpt::poses::CPosePDF))))
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

}  // namespace polemcl
