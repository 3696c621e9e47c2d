#pragma once
/// \file FaultInjection.h
/// \brief Faults put into a recorded drive: what the localization sees, and what is true.

#include <cstdint>
#include <random>
#include <vector>

#include "localize/TrialDrive.h"

namespace polemcl::apps {

enum class Fault {
  none,      ///< the drive as it is
  kidnap,    ///< put down 20 to 500 m from where it was; the odometry knows nothing of it
  wrongMap,  ///< the map is another one from the start on
  blind,     ///< no pole is detected
  stuck,     ///< the odometry says that the vehicle stands
  slip       ///< the odometry is 20 % too long or too short
};
const char* name(Fault fault);  ///< of the command line

struct FaultOptions {
  Fault fault = Fault::none;
  double lead = 20;                    ///< driven in health before the fault, s; wrongMap: none
  double duration = 30;                ///< of blind, stuck, slip, s
  double tail = 150;                   ///< driven after the fault's end, or after the kidnapping, m
  double slip = 0.2;                   ///< error of the slipping odometry's scale
  double minJump = 20, maxJump = 500;  ///< straight distance of the kidnapping, m
};

/// \brief A piece of the drive with the fault in it. Element i of the lists is scan i.
struct FaultyDrive {
  std::vector<PoleScan> frames;
  std::vector<Pose2D> truth;
  std::vector<double> driven;  ///< along the true path since the first scan, jumps left out, m
  std::size_t begin = 0;       ///< first scan with the fault
  std::size_t end = 0;         ///< first scan after it; kidnap, wrongMap: `begin`
  std::size_t origin = 0;      ///< scan of the whole drive that is the first here
  double jump = 0;             ///< distance of the kidnapping, m
};

/// \brief Draws a place for the fault and puts it in; `none` leaves the whole drive.
/// \throws Error when the drive is too short for it, or no place lies as far off as demanded.
FaultyDrive injectFault(const TrialDrive& drive, const FaultOptions& options,
                        std::mt19937_64& random);

}  // namespace polemcl::apps
