#pragma once
/// \file DetectionModel.h
/// \brief Statistical model of an extractor's detections. It replaces ray casting and pole
/// extraction on long drives. share/doc/simulation.md describes it.

#include <array>
#include <filesystem>
#include <string>
#include <vector>

#include "sim/detections/PersistentNoise.h"
#include "sim/world/WorldObject.h"

namespace polemcl::sim {

/// \brief Class of the object behind a detection. `clutter` is a lasting false detection: an object
/// that looks like a pole and is found from many places. `passing` is a single false detection.
enum class DetectionClass { lampPost, sign, trafficLight, tree, clutter, passing, count_ };
/// Number of classes.
inline constexpr int kDetectionClasses = static_cast<int>(DetectionClass::count_);
const char* name(DetectionClass detectionClass);
/// \brief Class of a true pole.
DetectionClass classOf(Kind kind);

/// \brief Values of a detection and their errors.
enum class Reported {
  sigmaAlong,   ///< reported standard deviation along the ray, m
  sigmaAcross,  ///< reported standard deviation across the ray, m
  errorAlong,   ///< error along the ray, + beyond, divided by errorScale()
  errorAcross,  ///< error across the ray, + left, divided by errorScale()
  confidence,
  radius,  ///< reported minus true, m; without a true pole the reported one
  bottom,  ///< m above ground
  top,     ///< m above ground
  points,
  count_
};
inline constexpr int kReported = static_cast<int>(Reported::count_);
const char* name(Reported reported);

/// Probabilities of the quantiles that describe a distribution.
inline constexpr std::array<double, 11> kQuantileLevels{0.002, 0.01, 0.05, 0.15, 0.3,  0.5,
                                                        0.7,   0.85, 0.95, 0.99, 0.998};
/// \brief Values at kQuantileLevels, ascending.
using Quantiles = std::array<double, kQuantileLevels.size()>;
/// \brief The value at a standard normal number z: linear in z between the levels, constant
/// outside.
double valueAt(const Quantiles& quantiles, double z);

/// \brief Model of one class. Functions of range are given at the model's ranges, linear between
/// them.
struct ClassModel {
  /// Probability of detection at DetectionModel::detectedRange; empty for `passing`.
  std::vector<double> detected;
  /// Distributions of the reported values at DetectionModel::reportedRange.
  std::array<std::vector<Quantiles>, kReported> reported;
};

/// \brief Effects of seasons and building sites. Scores are added to the visibility threshold, by
/// class of pole: lamp post, sign, traffic light, tree. With all values 0, nothing changes.
struct SeasonModel {
  std::array<double, 4> snow{};  ///< score of poles in a snow bank, per 0.5 m of its height
  std::array<double, 4> bare{};  ///< score when the trees are bare
  double fence = 0;              ///< score behind a mesh fence
  double siteClutter = 0;        ///< lasting false objects per metre of building site
};

struct DetectionModel {
  std::string sensor;        ///< `[sensor] model` of the fit
  double height = 1;         ///< height of the sensor above ground, m
  double maxRange = 40;      ///< range of the farthest detections, m
  std::uint32_t points = 0;  ///< valid points of a scan, median
  std::string fittedOn;      ///< description of the training data, for humans
  double behindHouses = 0;   ///< probability of detecting a pole hidden by a house
  std::vector<double> detectedRange, reportedRange;  ///< ascending, m
  /// Exponent of errors over reported sigmas: 1 if errors are proportional to them, 0 if
  /// independent.
  double errorExponent = 1;
  std::array<ClassModel, kDetectionClasses> classes;
  NoiseSpectrum poleVisibility, clutterVisibility;
  std::array<NoiseSpectrum, kReported> noise;
  double clutterAlways = 0, clutterToday = 0;  ///< lasting false objects per metre of road
  Quantiles clutterLateral{};  ///< distance of these objects from the middle of the road, m
  double passing = 0;          ///< `passing` detections per scan
  Quantiles passingRange{};    ///< range of these detections, m
  SeasonModel season;

  const ClassModel& of(DetectionClass c) const { return classes[static_cast<int>(c)]; }
  const NoiseSpectrum& noiseOf(Reported r) const { return noise[static_cast<int>(r)]; }
  /// \brief Threshold on a standard normal number; below it, an object of the class is detected.
  double detectionScore(DetectionClass c, double range) const;
  /// \brief The value reported at a range, for a standard normal number.
  double value(DetectionClass c, Reported r, double range, double z) const;

  /// \brief Divisor of the normalized errors, m: reported^e · usual^(1 − e), where e is
  /// errorExponent and `usual` is the median reported sigma at this range.
  /// \param sigma sigmaAlong or sigmaAcross. \param reported Its value, m.
  double errorScale(DetectionClass c, Reported sigma, double range, double reported) const;

  /// \throws Error with the key of the file and the allowed values.
  void validate() const;
};

/// \brief Reads a model. \throws Error with file and key: not readable, not JSON, other format,
/// missing or unknown key, value of the wrong type or out of range.
DetectionModel readDetectionModel(const std::filesystem::path& file);

}  // namespace polemcl::sim
