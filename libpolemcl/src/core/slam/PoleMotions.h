#pragma once
/// \file PoleMotions.h
/// \brief Motions that no odometry tells, by the poles that scans both saw. Private to the library.

#include <vector>

#include <polemcl/core/common/Types.h>

namespace polemcl {

/// \brief What fillMotions() did.
struct FilledMotions {
  std::size_t byPoles = 0;  ///< motions by the poles
  std::size_t coasted = 0;  ///< motions that go on as before, where too few poles told
  bool all = false;         ///< no motion was known
};

/// \brief Fills in each motion that is missing after the first scan.
///
/// The motion before goes on (constant velocity), and is corrected by the poles that the scan has
/// in common with the one before, or with one up to a second back. At the begin, and where poles
/// contradict it, all motions up to 40 m/s are searched. The covariance is that of a coarse
/// odometry, 5 cm + 5 % and 0.6°, more where nothing corrects it: the poles themselves are used
/// again by mapDrives().
/// \throws Error naming the scan where too few poles told the motion over 2 s.
FilledMotions fillMotions(std::vector<PoleScan>& scans);

}  // namespace polemcl
