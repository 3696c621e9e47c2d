#pragma once
/// \file EntryStream.h
/// \brief Streams poles from any source of entries.

#include <memory>

#include "mrpt/rawlog/EntrySource.h"
#include "mrpt/rawlog/PoleSequence.h"

namespace polemcl {

/// \brief As streamPoles() of a rawlog. Scans of sensors have the time of their arrival; one
/// without odometry at its time is left out, and the motion goes on to the next.
/// \param name The source, for messages.
/// \param options `pace`, `allowTruncated` and `follow` have no effect on sensors.
/// \return For sensors also why the drive ended, after its first scan: `failure`.
/// \throws Error as streamPoles(); when no odometry came with many scans of sensors.
SequenceCounts streamPoles(std::shared_ptr<EntrySource> entries, const std::string& name,
                           const SequenceOptions& options,
                           const std::function<void(const ReadScan&)>& consume);

}  // namespace polemcl
