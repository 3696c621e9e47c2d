#pragma once
/// \file DriveFixes.h
/// \brief Positions from satellites as a part of mapping. Private to the library.
///
/// The errors of a receiver last: beside the white noise it states, it is taken to be off by twice
/// as much, which changes over minutes. A receiver that jumps lets go (see JointAdjustment).

#include <optional>
#include <vector>

#include "core/mapping/JointAdjustment.h"

namespace polemcl {

/// \brief A position from satellites between two scans of a drive, on the plane of the map.
struct DriveFix {
  double time = 0;                                     ///< s
  std::size_t scan = 0;                                ///< before it
  double share = 0;                                    ///< of the time to the next scan, 0 to 1
  Eigen::Vector2d position = Eigen::Vector2d::Zero();  ///< of the antenna, m
  double sigma = 0;                                    ///< along each axis, by the receiver, m
  Eigen::Vector2d antenna_robot = Eigen::Vector2d::Zero();  ///< m
};

/// \brief What the fixes say of the poses.
/// \param fixes By scans. \param drives Of each scan.
FixFactors fixFactors(const std::vector<DriveFix>& fixes, const std::vector<std::size_t>& drives);

/// \brief How the fixes of a drive fit the path that was found.
struct FixFit {
  std::size_t given = 0;    ///< fixes
  std::size_t fitting = 0;  ///< within three sigmas; the others have lost most of their weight
  double distance = 0;      ///< of the fixes from the antenna on the path, median, m
  /// \brief More than 30 % do not fit. Between high houses some always do not.
  bool isDoubtful() const;
};

/// \brief How the fixes fit an adjusted state, drive by drive.
/// \param gnss They were a part of the adjustment. \param drives Of each scan.
std::vector<FixFit> fixFits(const FixFactors& gnss, const AdjustedState& state,
                            const std::vector<std::size_t>& drives);

/// \brief The fixes with wider sigmas, in drives where they are doubtful: by as much as they lie
/// farther off than the receiver says. \param fits Of each drive, from fixFits().
FixFactors widened(const FixFactors& gnss, const std::vector<FixFit>& fits,
                   const std::vector<std::size_t>& drives);

/// \brief The rigid motion that lays a drive onto its fixes, those left out that are far off; none
/// if they are too few or too near to each other to tell its heading.
/// \param fixes Of one drive. \param poses Of all scans.
std::optional<Pose2D> motionOntoFixes(const std::vector<DriveFix>& fixes,
                                      const std::vector<Pose2D>& poses);

}  // namespace polemcl
