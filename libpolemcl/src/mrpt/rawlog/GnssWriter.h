#pragma once
/// \file GnssWriter.h
/// \brief Writes positions from satellites between the scans of a rawlog.

#include <mrpt/obs/CObservationGPS.h>

#include <vector>

#include "mrpt/rawlog/RawlogWriter.h"

namespace polemcl {

/// \brief Writes each observation as a single one before the first scan that is later.
class GnssWriter {
 public:
  /// \param rawlog Where the scans are written as well; must outlive this.
  /// \param observations In the order of their times.
  GnssWriter(RawlogWriter& rawlog, std::vector<mrpt::obs::CObservationGPS::Ptr> observations);

  /// \brief To be called before the action of each scan.
  void writeBefore(mrpt::system::TTimeStamp scan);
  /// \brief To be called after the last scan: writes what is left.
  void writeRest();

 private:
  RawlogWriter& m_rawlog;
  std::vector<mrpt::obs::CObservationGPS::Ptr> m_observations;
  std::size_t m_next = 0;
};

}  // namespace polemcl
