#include "mrpt/rawlog/GnssWriter.h"

#include <utility>

namespace polemcl {

GnssWriter::GnssWriter(RawlogWriter& rawlog,
                       std::vector<mrpt::obs::CObservationGPS::Ptr> observations)
    : m_rawlog(rawlog), m_observations(std::move(observations)) {}

void GnssWriter::writeBefore(mrpt::system::TTimeStamp scan) {
  while (m_next < m_observations.size() && m_observations[m_next]->timestamp < scan)
    m_rawlog.write(*m_observations[m_next++]);
}

void GnssWriter::writeRest() {
  while (m_next < m_observations.size()) m_rawlog.write(*m_observations[m_next++]);
}

}  // namespace polemcl
