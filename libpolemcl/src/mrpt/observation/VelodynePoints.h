#pragma once
/// \file VelodynePoints.h
/// \brief The points in the packets of a Velodyne.

#include <mrpt/obs/CObservationVelodyneScan.h>

#include <vector>

namespace polemcl {

struct VelodynePoints {
  std::vector<float> x, y, z;  ///< frame of the sensor, m
  std::vector<int> laser;      ///< as in the calibration
};

/// \brief All returns between the smallest and the largest range of the scan, in the order in which
/// they were measured.
///
/// MRPT's own generatePointCloud() reads the first 16 of the 32 returns of each block only (2.5.8
/// to 3.1): half the firings of a VLP-16, and of an HDL-32E no laser more than 1 degree above the
/// horizon. The others are the same points.
/// \throws Error when the calibration is not of 16, 32 or 64 lasers.
void readVelodynePackets(const mrpt::obs::CObservationVelodyneScan& scan, VelodynePoints& points);

}  // namespace polemcl
