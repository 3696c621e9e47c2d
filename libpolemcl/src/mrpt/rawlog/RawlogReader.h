#pragma once
/// \file RawlogReader.h
/// \brief Reads rawlogs entry by entry, and says so when one is damaged (MRPT's reader stops there
/// as if the file had ended).

#include <mrpt/obs/CActionCollection.h>
#include <mrpt/obs/CObservation.h>
#include <mrpt/obs/CSensoryFrame.h>

#include <memory>
#include <string>

#include "core/common/Types.h"

namespace polemcl {

/// \brief One entry: an action with the frame that follows it, or either alone, or an observation.
/// Exactly one of {action and/or frame, observation} is set.
struct RawlogEntry {
  mrpt::obs::CActionCollection::Ptr action;
  mrpt::obs::CSensoryFrame::Ptr frame;
  mrpt::obs::CObservation::Ptr observation;
  std::uint64_t offset = 0;  ///< of its first object in the (uncompressed) data, bytes
};

/// \brief Streams a rawlog, plain or gzip, action + frame pairs or bare observations. Comments and
/// objects that are neither are passed over.
class RawlogReader {
 public:
  /// \param allowTruncated true: a file that ends inside an object is read up to there.
  /// \throws Error when the file cannot be opened.
  explicit RawlogReader(const std::string& path, bool allowTruncated = false);
  ~RawlogReader();
  RawlogReader(RawlogReader&&) noexcept;
  RawlogReader& operator=(RawlogReader&&) noexcept;

  /// \return false at the end of the file.
  /// \throws Error on a class that is not registered (names it), on an object that cannot be read,
  ///         and, unless allowed, on a file that ends inside an object (names the byte) or is
  ///         empty. A plain file cut between two objects cannot be told from a whole one.
  bool next(RawlogEntry& entry);
  /// \brief True when the file ended too early and that was allowed.
  bool truncated() const;
  /// \brief Share of the file read so far, 0 to 1, for progress.
  double progress() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> m_impl;
};

}  // namespace polemcl
