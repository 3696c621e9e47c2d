#include "mrpt/rawlog/RawlogArchive.h"

#include <mrpt/core/Clock.h>
#include <mrpt/obs/CActionCollection.h>
#include <mrpt/obs/CSensoryFrame.h>

#include <stdexcept>

namespace polemcl {

using mrpt::obs::CActionCollection;
using mrpt::obs::CSensoryFrame;
using mrpt::serialization::CSerializable;

CSerializable::Ptr RawlogArchive::readEntry() {
  Header header;
  internal_ReadObjectHeader(header.name, header.old, header.version);
  if (header.name == "nullptr") throw std::runtime_error("an object of no class");
  const auto* known = mrpt::rtti::findRegisteredClass(header.name);
  if (!known) throw std::runtime_error("the class '" + header.name + "' which is not registered");
  CSerializable::Ptr object;
  if (known == CLASS_ID(CSensoryFrame)) {
    object = readFrame(header);
  } else if (known == CLASS_ID(CActionCollection)) {
    object = readActions(header);
  } else {
    object = std::dynamic_pointer_cast<CSerializable>(known->ptrCreateObject());
    if (!object) throw std::runtime_error("a class without content, '" + header.name + "'");
    internal_ReadObject(object.get(), header.name, header.old, header.version);
    return object;
  }
  internal_ReadObject(nullptr, header.name, header.old, header.version);  // its end
  return object;
}

template <class Element>
typename Element::Ptr RawlogArchive::readElement(std::uint32_t index, const char* wanted) {
  const auto object = ReadObject();
  auto element = std::dynamic_pointer_cast<Element>(object);
  if (!element)
    throw std::runtime_error(
        "element " + std::to_string(index) + " of its collection is " +
        (object ? std::string("a ") + object->GetRuntimeClass()->className : "null") + ", not " +
        wanted);
  return element;
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
