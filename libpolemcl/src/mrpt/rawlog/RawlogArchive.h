#pragma once
/// \file RawlogArchive.h
/// \brief Reads the objects of a rawlog. Collections are read element by element.

#include <mrpt/serialization/CArchive.h>

#include <cstdint>
#include <string>
#include <vector>

#include "mrpt/rawlog/GzReadStream.h"

namespace polemcl {

/// \brief MRPT's own reading of a CSensoryFrame or a CActionCollection takes memory for the count
/// in the file before it reads an element, and crashes if an element is null or of a foreign class.
/// Here memory grows with the elements that the file holds, and each is checked. A movement whose
/// distribution is null or something else would crash MRPT as well: it is refused before.
class RawlogArchive : public mrpt::serialization::CArchiveStreamBase<GzReadStream> {
 public:
  using CArchiveStreamBase::CArchiveStreamBase;

  /// \brief The next object of the file, never null.
  /// \throws std::exception when it is damaged or its class is unknown. The archive cannot be used
  ///         after it.
  mrpt::serialization::CSerializable::Ptr readEntry();

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
  mrpt::serialization::CSerializable::Ptr readObject(const Header& header);
  void requireDistribution(std::int8_t version);
  mrpt::serialization::CSerializable::Ptr readFrame(const Header& header);
  mrpt::serialization::CSerializable::Ptr readActions(const Header& header);
  template <class Element>
  typename Element::Ptr readElement(std::uint32_t index, const char* wanted);

  bool m_keeps = false;               ///< what is read now is read again
  std::vector<std::uint8_t> m_again;  ///< to be read again, before the rest of the file
};

}  // namespace polemcl
