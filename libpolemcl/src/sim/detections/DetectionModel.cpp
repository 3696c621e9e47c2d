#include "sim/detections/DetectionModel.h"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "core/common/Statistics.h"

namespace polemcl::sim {
namespace {

const std::array<double, kQuantileLevels.size()>& levelScores() {
  static const auto scores = [] {
    std::array<double, kQuantileLevels.size()> z{};
    for (std::size_t i = 0; i < z.size(); ++i) z[i] = normalQuantile(kQuantileLevels[i]);
    return z;
  }();
  return scores;
}

/// Position between two neighbours of an ascending list.
struct Between {
  std::size_t low = 0, high = 0;
  double share = 0;  ///< weight of the higher neighbour
  Between(const std::vector<double>& at, double x) {
    const auto above = std::upper_bound(at.begin(), at.end(), x);
    high = static_cast<std::size_t>(above - at.begin());
    low = high == 0 ? 0 : high - 1;
    high = std::min(high, at.size() - 1);
    share = high == low ? 0 : (x - at[low]) / (at[high] - at[low]);
  }
  double mix(double atLow, double atHigh) const { return atLow + share * (atHigh - atLow); }
};

[[noreturn]] void refuse(const std::string& key, const std::string& what) {
  throw Error(key + ": " + what);
}

void requireIn(const std::string& key, double value, double low, double high) {
  if (value >= low && value <= high) return;
  std::ostringstream text;
  text << value << " is not allowed; " << low << " to " << high << " is";
  refuse(key, text.str());
}

void requireAscending(const std::string& key, const double* values, std::size_t count,
                      bool strictly) {
  for (std::size_t i = 0; i < count; ++i) {
    if (!std::isfinite(values[i])) refuse(key, "a value is not finite");
    if (i > 0 && (strictly ? values[i] <= values[i - 1] : values[i] < values[i - 1]))
      refuse(key, "the values must ascend");
  }
}

void requireSpectrum(const std::string& key, const NoiseSpectrum& spectrum) {
  double sum = 0;
  for (const auto* shares : {&spectrum.always, &spectrum.today})
    for (const double share : *shares) {
      requireIn(key, share, 0, 1);
      sum += share;
    }
  if (sum > 1 + 1e-6) refuse(key, "the shares sum up to more than 1");
}

/// Checks a reported value against its possible range.
void requireReported(const std::string& key, Reported reported, const Quantiles& quantiles) {
  requireAscending(key, quantiles.data(), quantiles.size(), false);
  const bool sigma = reported == Reported::sigmaAlong || reported == Reported::sigmaAcross;
  for (const double value : quantiles) {
    if (sigma) requireIn(key, value, 1e-4, 10);
    if (reported == Reported::confidence) requireIn(key, value, 0, 1);
    if (reported == Reported::points) requireIn(key, value, 0, 1e6);
  }
}

}  // namespace

const char* name(DetectionClass c) {
  static constexpr const char* kNames[] = {"lamp_post", "sign",    "traffic_light",
                                           "tree",      "clutter", "passing"};
  return kNames[static_cast<int>(c)];
}

DetectionClass classOf(Kind kind) {
  return kind == Kind::sign           ? DetectionClass::sign
         : kind == Kind::trafficLight ? DetectionClass::trafficLight
         : kind == Kind::tree         ? DetectionClass::tree
                                      : DetectionClass::lampPost;
}

const char* name(Reported r) {
  static constexpr const char* kNames[] = {"sigma_along_m", "sigma_across_m", "error_along",
                                           "error_across",  "confidence",     "radius_m",
                                           "bottom_m",      "top_m",          "points"};
  return kNames[static_cast<int>(r)];
}

double valueAt(const Quantiles& quantiles, double z) {
  const auto& scores = levelScores();
  if (z <= scores.front()) return quantiles.front();
  if (z >= scores.back()) return quantiles.back();
  std::size_t i = 1;
  while (scores[i] < z) ++i;
  const double share = (z - scores[i - 1]) / (scores[i] - scores[i - 1]);
  return quantiles[i - 1] + share * (quantiles[i] - quantiles[i - 1]);
}

double DetectionModel::detectionScore(DetectionClass c, double range) const {
  const auto& detected = of(c).detected;
  if (range > maxRange) return -9;
  const Between place(detectedRange, range);
  return place.mix(normalQuantile(detected[place.low]), normalQuantile(detected[place.high]));
}

double DetectionModel::value(DetectionClass c, Reported r, double range, double z) const {
  const auto& table = of(c).reported[static_cast<int>(r)];
  const Between place(reportedRange, range);
  return place.mix(valueAt(table[place.low], z), valueAt(table[place.high], z));
}

double DetectionModel::errorScale(DetectionClass c, Reported sigma, double range,
                                  double reported) const {
  const double usual = value(c, sigma, range, 0);
  return usual * std::pow(reported / usual, errorExponent);
}

void DetectionModel::validate() const {
  if (sensor.empty()) refuse("sensor", "the model of the LiDAR is missing");
  requireIn("height_m", height, 0.1, 10);
  requireIn("max_range_m", maxRange, 1, 500);
  requireIn("behind_houses", behindHouses, 0, 1);
  requireIn("error_exponent", errorExponent, 0, 1);
  requireIn("clutter_per_m.always", clutterAlways, 0, 10);
  requireIn("clutter_per_m.today", clutterToday, 0, 10);
  requireIn("passing_per_scan", passing, 0, 1000);
  for (const auto* scores : {&season.snow, &season.bare})
    for (const double score : *scores)
      requireIn(scores == &season.snow ? "season.snow" : "season.bare", score, -5, 5);
  requireIn("season.fence", season.fence, -5, 5);
  requireIn("season.site_clutter_per_m", season.siteClutter, 0, 10);
  for (const auto* ranges : {&detectedRange, &reportedRange}) {
    const char* key = ranges == &detectedRange ? "detected_range_m" : "reported_range_m";
    if (ranges->empty()) refuse(key, "at least one range is needed");
    requireAscending(key, ranges->data(), ranges->size(), true);
    requireIn(key, ranges->front(), 0, maxRange);
  }
  requireAscending("clutter_lateral_m", clutterLateral.data(), clutterLateral.size(), false);
  requireIn("clutter_lateral_m", clutterLateral.front(), 0, 100);
  requireIn("clutter_lateral_m", clutterLateral.back(), 0, 100);
  requireAscending("passing_range_m", passingRange.data(), passingRange.size(), false);
  requireIn("passing_range_m", passingRange.front(), 0, maxRange);
  requireIn("passing_range_m", passingRange.back(), 0, maxRange);
  requireSpectrum("persistence.poles", poleVisibility);
  requireSpectrum("persistence.clutter", clutterVisibility);
  for (int r = 0; r < kReported; ++r)
    requireSpectrum(std::string("persistence.") + name(static_cast<Reported>(r)), noise[r]);
  for (int c = 0; c < kDetectionClasses; ++c) {
    const std::string at = std::string("classes.") + name(static_cast<DetectionClass>(c)) + ".";
    const bool lasts = static_cast<DetectionClass>(c) != DetectionClass::passing;
    if (classes[c].detected.size() != (lasts ? detectedRange.size() : 0))
      refuse(at + "detected", lasts ? "one probability for each of detected_range_m is needed"
                                    : "passing detections have no probability");
    for (const double p : classes[c].detected) requireIn(at + "detected", p, 0, 1);
    for (int r = 0; r < kReported; ++r) {
      const auto reported = static_cast<Reported>(r);
      const std::string key = at + name(reported);
      if (classes[c].reported[r].size() != reportedRange.size())
        refuse(key, "one row for each of reported_range_m is needed");
      for (const Quantiles& row : classes[c].reported[r]) requireReported(key, reported, row);
    }
  }
}

}  // namespace polemcl::sim
