#pragma once
/// \file FaultInjection.h
/// \brief Faults put into a recorded drive: what the localization sees, and what is true.

#include <random>
#include <vector>

#include "eval/Trial.h"

namespace polemcl::apps {

enum class Fault {
  none,      ///< the drive as it is
  kidnap,    ///< put down 20 to 500 m from where it was; the odometry knows nothing of it
  wrongMap,  ///< the map is another one from the start on
  blind,     ///< no pole is detected
  stuck,     ///< the odometry says that the vehicle stands
  slip,      ///< the odometry is 20 % too long or too short
  jump,      ///< the odometry jumps by 0.5 to 3 m; in half of the trials, back one scan later
  clock,     ///< the odometry is that of 0.1 to 0.5 s before or after
  moved,  ///< a LiDAR that sees what is behind the vehicle: moved by 0.1 to 0.5 m, 1 to 5 degrees
  halfGone,  ///< half of the poles of the map are gone
  snow,      ///< twice as many false poles as there are poles otherwise, others in each scan
  late       ///< each scan comes 0 to 1 s late, so some come after newer ones and are not used
};
const char* name(Fault fault);  ///< of the command line

struct FaultOptions {
  Fault fault = Fault::none;
  double lead = 20;                    ///< driven in health before the fault, s; wrongMap: none
  double duration = 30;                ///< of faults that last, s
  double tail = 150;                   ///< driven after the fault's end, or after the kidnapping, m
  double slip = 0.2;                   ///< error of the slipping odometry's scale
  double minJump = 20, maxJump = 500;  ///< straight distance of the kidnapping, m
  double minShift = 0.5, maxShift = 3;  ///< of the odometry that jumps, m
};

/// \brief Uniform in an interval; the same numbers on every machine.
double uniform(std::mt19937_64& random, double low, double high);

/// \brief The scans of a live drive that are used, as LiveQueue says: those that come after a newer
/// one are not. \param arrivals Of the scans in the order of their times, s. \return Their indices.
std::vector<std::size_t> usedScans(const std::vector<double>& arrivals);

/// \brief Draws a place for the fault and puts it in; `none` leaves the whole drive. The trial
/// starts at its true pose.
/// \throws Error when the drive is too short for it, or no place lies as far off as demanded.
Trial injectFault(const TrialDrive& drive, const FaultOptions& options, std::mt19937_64& random);

}  // namespace polemcl::apps
