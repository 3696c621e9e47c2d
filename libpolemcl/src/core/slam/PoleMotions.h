#pragma once
/// \file PoleMotions.h
/// \brief Motions that no odometry tells, or that it tells wrongly, by the poles that scans both
/// saw. Private to the library.

#include <vector>

#include <polemcl/core/common/Types.h>

namespace polemcl {

/// \brief What fillMotions() did.
struct FilledMotions {
  std::size_t motions = 0;       ///< in all
  std::size_t byPoles = 0;       ///< missing motions by the poles
  std::size_t coasted = 0;       ///< missing ones that go on as before, where too few poles told
  double firstCoasted = 0;       ///< time of the scan that the first of these leads to, s
  double longestCoast = 0;       ///< time over which such motions follow one another, at most, s
  std::size_t contradicted = 0;  ///< motions of the odometry that were told anew
  double firstContradicted = 0;  ///< time of the scan that the first of these leads to, s
  bool all = false;              ///< no motion is that of an odometry
  bool refuted = false;          ///< too much of the odometry was contradicted: none of it is used
};

/// \brief Fills in each motion that is missing after the first scan.
///
/// The motion before goes on (constant velocity), and is corrected by the poles that the scan has
/// in common with the one before, or with one up to a second back. At the begin, and where poles
/// contradict it, all motions up to 40 m/s are searched. Over a gap fewer poles are in common: five
/// suffice for a change of speed that a vehicle makes. The covariance is that of a coarse
/// odometry, 5 cm + 5 % and 0.6°, more where nothing corrects it: the poles themselves are used
/// again by mapDrives().
///
/// Motions of the odometry that the poles clearly contradict, from scan to scan or over up to a
/// second, are told by the poles: a wheel slipped, or the odometry started anew. Errors up to
/// 0.3 m + 10 % and 0.05 rad + 10 % in that time stay (a third, until both agree again over a
/// second), and so do motions that fewer than four common poles contradict. Between such motions,
/// those of which the poles say nothing are told anew if they are not the motion before. Where more
/// than 30 % of its motions are told anew, the odometry is not used at all, if the poles can tell
/// the whole way.
/// \throws Error naming the scan where too few poles told the motion over 2 s, and if the poles of
/// a drive without odometry do not tell a quarter of its motions.
FilledMotions fillMotions(std::vector<PoleScan>& scans);

}  // namespace polemcl
