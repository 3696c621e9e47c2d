#pragma once
/// \file RawlogReader.h
/// \brief Reads rawlogs entry by entry and reports damage. (MRPT's reader treats damage as the end
/// of the file.)

#include <mrpt/obs/CActionCollection.h>
#include <mrpt/obs/CObservation.h>
#include <mrpt/obs/CSensoryFrame.h>

#include <memory>
#include <string>

#include <polemcl/core/common/Types.h>

namespace polemcl {

/// \brief One entry: an action, a frame, an action with its following frame, or an observation.
/// Exactly one of {action and/or frame, observation} is set.
struct RawlogEntry {
  mrpt::obs::CActionCollection::Ptr action;
  mrpt::obs::CSensoryFrame::Ptr frame;
  mrpt::obs::CObservation::Ptr observation;
  std::uint64_t offset = 0;  ///< byte offset of its first object in the (uncompressed) data
};

/// \brief Streams a plain or gzip rawlog with action and frame pairs or single observations.
/// Comments and other objects are skipped.
class RawlogReader {
 public:
  /// \param allowTruncated true: a file that ends inside an object is read up to that object.
  /// \throws Error when the file cannot be opened.
  explicit RawlogReader(const std::string& path, bool allowTruncated = false);
  ~RawlogReader();
  RawlogReader(RawlogReader&&) noexcept;
  RawlogReader& operator=(RawlogReader&&) noexcept;

  /// \return false at the end of the file.
  /// \throws Error on a class that is not registered (with its name), on an unreadable object, and
  ///         on a file that is empty or ends inside an object (with the byte; unless allowed). A
  ///         plain file cut between two objects cannot be distinguished from a complete one.
  bool next(RawlogEntry& entry);
  /// \brief True when the file is truncated and this was allowed.
  bool truncated() const;
  /// \brief Fraction of the file read so far, 0 to 1, for progress.
  double progress() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> m_impl;
};

}  // namespace polemcl
