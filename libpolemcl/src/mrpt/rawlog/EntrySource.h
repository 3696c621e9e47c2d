#pragma once
/// \file EntrySource.h
/// \brief Where the entries of a drive come from: a rawlog, or sensors.

#include <mrpt/obs/CActionCollection.h>
#include <mrpt/obs/CObservation.h>
#include <mrpt/obs/CSensoryFrame.h>

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>

namespace polemcl {

/// \brief One entry: an action, a frame, an action with its following frame, or an observation.
/// Exactly one of {action and/or frame, observation} is set.
struct RawlogEntry {
  mrpt::obs::CActionCollection::Ptr action;
  mrpt::obs::CSensoryFrame::Ptr frame;
  mrpt::obs::CObservation::Ptr observation;
  std::uint64_t offset = 0;  ///< byte offset of its first object in the (uncompressed) data
  /// When a sensor gave the observation; none for a rawlog.
  std::optional<std::chrono::steady_clock::time_point> arrival;
};

class EntrySource {
 public:
  virtual ~EntrySource() = default;
  /// \brief The next entry; waits for it. \return false at the end. \throws Error when it cannot
  /// be had.
  virtual bool next(RawlogEntry& entry) = 0;
  /// \brief Ends a wait of next(), also of later ones: nobody uses the entries. From any thread.
  virtual void stop() {}
  /// \brief Entries come at the moment they are measured. The odometry of a scan comes before the
  /// scan, or it is missing: nobody needs to wait for later entries.
  virtual bool isLive() const { return false; }
  /// \brief Text of the comments so far.
  virtual const std::string& comment() const = 0;
  /// \brief Scans of sensors that were dropped so far, because those before took too long.
  virtual std::size_t dropped() const { return 0; }
  /// \brief True when the entries are not complete and this was allowed.
  virtual bool truncated() const { return false; }
  /// \brief Fraction read so far, 0 to 1, for progress; 0: unknown.
  virtual double progress() const { return 0; }
};

}  // namespace polemcl
