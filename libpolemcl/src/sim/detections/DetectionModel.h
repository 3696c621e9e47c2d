#pragma once
/// \file DetectionModel.h
/// \brief What an extractor reports of the poles around it, as statistics: it stands in for casting
/// rays and extracting poles on long drives. share/doc/simulation.md describes it.

#include <array>
#include <string>
#include <vector>

#include "sim/detections/PersistentNoise.h"
#include "sim/world/WorldObject.h"

namespace polemcl::sim {

/// \brief What a detection is of.
enum class DetectionClass { lampPost, sign, trafficLight, tree, clutter, passing, count_ };
/// Lasting false detections: something looks like a pole and is found from many places.
inline constexpr int kDetectionClasses = static_cast<int>(DetectionClass::count_);
const char* name(DetectionClass detectionClass);
/// \brief Of a true pole.
DetectionClass classOf(Kind kind);

/// \brief What a detection says, or is off by.
enum class Reported {
  sigmaAlong,   ///< reported standard deviation along the ray, m
  sigmaAcross,  ///< and across, m
  errorAlong,   ///< error along the ray, + beyond, as a multiple of errorScale()
  errorAcross,  ///< and across, + left, likewise
  confidence,
  radius,  ///< reported minus true, m; of what is no pole the reported one
  bottom,  ///< m above ground
  top,     ///< m above ground
  points,
  count_
};
inline constexpr int kReported = static_cast<int>(Reported::count_);
const char* name(Reported reported);

/// Probabilities of the quantiles that stand for a distribution.
inline constexpr std::array<double, 11> kQuantileLevels{0.002, 0.01, 0.05, 0.15, 0.3,  0.5,
                                                        0.7,   0.85, 0.95, 0.99, 0.998};
/// \brief Values at kQuantileLevels, ascending.
using Quantiles = std::array<double, kQuantileLevels.size()>;
/// \brief The value at a standard normal number z: linear in z between the levels, constant beyond.
double valueAt(const Quantiles& quantiles, double z);
/// \brief The z of a value, the middle one where several have that value.
double scoreOf(const Quantiles& quantiles, double value);

/// \brief One class. Functions of range are given at the ranges of the model and linear between.
struct ClassModel {
  /// Probability that one is detected, at DetectionModel::detectedRange; empty for `passing`.
  std::vector<double> detected;
  /// What is reported, at DetectionModel::reportedRange.
  std::array<std::vector<Quantiles>, kReported> reported;
};

/// \brief What seasons and building sites change. Scores are added to the threshold of visibility,
/// by class of poles: lamp post, sign, traffic light, tree. All 0: nothing changes.
struct SeasonModel {
  std::array<double, 4> snow{};  ///< score of poles in a snow bank, for each 0.5 m it is high
  std::array<double, 4> bare{};  ///< score when no leaves are out
  double fence = 0;              ///< score behind a fence of mesh
  double siteClutter = 0;        ///< lasting false objects per metre of building site
};

struct DetectionModel {
  std::string sensor;        ///< `[sensor] model` it was fitted for
  double height = 1;         ///< of the sensor above ground, m
  double maxRange = 40;      ///< nothing is detected beyond, m
  std::uint32_t points = 0;  ///< valid points of a scan, median
  std::string fittedOn;      ///< for people
  double behindHouses = 0;   ///< probability that a pole hidden by a house is detected all the same
  std::vector<double> detectedRange, reportedRange;  ///< ascending, m
  /// How far errors grow with the sigma reported: 1, as they should; 0, not at all.
  double errorExponent = 1;
  std::array<ClassModel, kDetectionClasses> classes;
  NoiseSpectrum poleVisibility, clutterVisibility;
  std::array<NoiseSpectrum, kReported> noise;
  double clutterAlways = 0, clutterToday = 0;  ///< lasting false objects per metre of road
  Quantiles clutterLateral{};  ///< of these, distance from the middle of the road, m
  double passing = 0;          ///< passing false detections per scan
  Quantiles passingRange{};    ///< of these, m
  SeasonModel season;

  const ClassModel& of(DetectionClass c) const { return classes[static_cast<int>(c)]; }
  const NoiseSpectrum& noiseOf(Reported r) const { return noise[static_cast<int>(r)]; }
  /// \brief Threshold on a standard normal number below which one of the class is detected.
  double detectionScore(DetectionClass c, double range) const;
  /// \brief What is reported at a range, for a standard normal number.
  double value(DetectionClass c, Reported r, double range, double z) const;

  /// \brief What errors are multiples of, m: the reported sigma to the power of errorExponent,
  /// times the usual sigma at that range to the power of what is left of 1. \param sigma Which:
  /// sigmaAlong or sigmaAcross. \param reported Its value, m.
  double errorScale(DetectionClass c, Reported sigma, double range, double reported) const;

  /// \throws Error naming the key as it is in the file and what is allowed.
  void validate() const;
};

}  // namespace polemcl::sim
