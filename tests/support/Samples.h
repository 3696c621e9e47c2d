#pragma once
// Invented, plausible poles and clouds for the tests; and archives in memory.

#include <mrpt/io/CMemoryStream.h>
#include <mrpt/serialization/CArchive.h>

#include <string>

#include <polemcl/mrpt/observation/CObservationPoles.h>
#include "support/Poles.h"
#include "support/TempFolder.h"

namespace polemcl::samples {

/// \brief A detection with different values in all fields, to detect mix-ups.
inline PoleDetection pole(double x, double y) {
  PoleDetection p = tests::varied(tests::detectionAt(x, y));
  p.points = 42;
  return p;
}

/// \brief Two poles seen by a sensor 1 m in front, 2 m to the left, with a quarter turn.
inline CObservationPoles observation() {
  CObservationPoles scan;
  scan.timestamp = mrpt::Clock::fromDouble(1326653000.25);
  scan.sensorLabel = "LIDAR";
  scan.sensorPose = mrpt::poses::CPose3D(1, 2, 1.5, M_PI / 2, 0.0, 0.0);
  scan.poles = {pole(5, 0), pole(-3, 4)};
  scan.poles[1].radius = 0.2;
  scan.poles[1].timeOffset = -0.02;
  scan.poles[1].turnRate = -62.5;
  scan.visibilityRange = {1, 2.5, 0, 4};
  scan.points = 1234;
  return scan;
}

inline std::string bytesOf(const mrpt::serialization::CSerializable& object) {
  mrpt::io::CMemoryStream memory;
  auto archive = mrpt::serialization::archiveFrom(memory);
  archive << object;
  return {static_cast<const char*>(memory.getRawBufferData()),
          static_cast<std::size_t>(memory.getTotalBytesCount())};
}

inline mrpt::serialization::CSerializable::Ptr objectFrom(const std::string& bytes) {
  mrpt::io::CMemoryStream memory(bytes.data(), bytes.size());
  auto archive = mrpt::serialization::archiveFrom(memory);
  return archive.ReadObject();
}

}  // namespace polemcl::samples
