#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <optional>

#include <polemcl/io/rosbag/PackedCloud.h>
#include "core/common/Angles.h"
#include "core/common/Statistics.h"
#include "core/sensor/PointOrder.h"
#include "io/file/TextFile.h"

namespace polemcl::io {
namespace {

constexpr std::size_t kEnoughScans = 5, kMostScans = 20;
constexpr std::size_t kSampledPoints = 4000;  ///< of one scan
constexpr double kTails = 0.001;              ///< share of points with times that are not trusted
constexpr double kOnLine =
    10 * degree;                      ///< beams of one moment differ in azimuth by less than this
constexpr double kLeastOnLine = 0.9;  ///< share of the points
constexpr double kMostSpread = 15 * degree;  ///< of the azimuth at the stamp, from scan to scan
constexpr double kRoundedStamp =
    0.005;                          ///< turns; a stamp so near to begin or end of the turn is there
constexpr double kMostTurns = 1.2;  ///< in one scan
constexpr double kShortestTurn = 0.02, kLongestTurn = 1;  ///< s

/// Points of a scan.
struct TimedPoints {
  std::vector<double> times, azimuths;  ///< s since the stamp; rad
};

TimedPoints sampled(const TimedCloud& scan) {
  TimedPoints result;
  const std::size_t step = 1 + scan.offsets.size() / kSampledPoints;
  for (std::size_t i = 0; i < scan.offsets.size(); i += step) {
    result.times.push_back(scan.offsets[i]);
    result.azimuths.push_back(std::atan2(scan.cloud.y[i], scan.cloud.x[i]));
  }
  return result;
}

/// Whether there are points in three quarters of all directions.
bool isFullTurn(const Cloud& cloud) {
  std::array<bool, 36> seen{};
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    const double turns = std::atan2(cloud.y[i], cloud.x[i]) / (2 * M_PI) + 0.5;
    seen[std::min<std::size_t>(35, static_cast<std::size_t>(36 * turns))] = true;
  }
  return std::count(seen.begin(), seen.end(), true) >= 27;
}

/// Mean of the points on a circle that turns with them: its length is 1 if all follow the rate.
std::complex<double> meanDirection(const TimedPoints& samples, double rate) {
  std::complex<double> sum;
  for (std::size_t i = 0; i < samples.times.size(); ++i)
    sum += std::polar(1.0, samples.azimuths[i] - rate * samples.times[i]);
  return sum / static_cast<double>(samples.times.size());
}

/// The rate that the points follow best, among those of a turn that takes about `span` s.
double coarseRate(const TimedPoints& samples, double span) {
  double best = 0, bestLength = -1;
  for (int percent = 70; percent <= 124; percent += 2) {
    for (const int sign : {-1, 1}) {
      const double rate = sign * 2 * M_PI * percent / (100 * span);
      const double length = std::abs(meanDirection(samples, rate));
      if (length <= bestLength) continue;
      best = rate;
      bestLength = length;
    }
  }
  return best;
}

/// Differences of the azimuths from the line, rad.
std::vector<double> residuals(const TimedPoints& samples, double rate, double atZero) {
  std::vector<double> result;
  for (std::size_t i = 0; i < samples.times.size(); ++i)
    result.push_back(wrapAngle(samples.azimuths[i] - atZero - rate * samples.times[i]));
  return result;
}

/// Improves the line by least squares over the points near it.
void refine(const TimedPoints& samples, double& rate, double& atZero) {
  const std::vector<double> errors = residuals(samples, rate, atZero);
  double n = 0, sumT = 0, sumE = 0, sumTt = 0, sumTe = 0;  // times T, errors E
  for (std::size_t i = 0; i < errors.size(); ++i) {
    if (std::abs(errors[i]) > 3 * kOnLine) continue;
    const double time = samples.times[i];
    n += 1;
    sumT += time;
    sumE += errors[i];
    sumTt += time * time;
    sumTe += time * errors[i];
  }
  const double determinant = n * sumTt - sumT * sumT;
  if (!(determinant > 0)) return;
  rate += (n * sumTe - sumT * sumE) / determinant;
  atZero += (sumE * sumTt - sumT * sumTe) / determinant;
}

double medianOf(const std::vector<double>& values) {
  return *quantile(values, 0.5);
}

/// One scan: azimuth = atStamp + rate · time.
struct Fit {
  double rate = 0;     ///< rad/s, above 0: counter-clockwise
  double atStamp = 0;  ///< azimuth at the time stamp, rad
  double middle = 0;   ///< from the stamp to the middle of the scan, s
  double turns = 0;    ///< in the scan

  /// The moment of the stamp, as a share of the scan if it has more than a turn, else of the turn.
  double stamp() const { return 0.5 - middle * std::abs(rate) / (2 * M_PI * sweep()); }
  /// Turns that this share is of.
  double sweep() const { return hasMoreThanATurn() ? turns : 1; }
  bool hasMoreThanATurn() const { return 2 * M_PI * turns > kMoreThanATurn; }
};

/// The azimuth of each point is fitted as a line over its time, in both directions; the better one
/// is the direction of the turn. Its slope gives the duration. The first and the last time of a
/// scan give the moment of the stamp within the turn; the azimuth then is the cut.
std::optional<Fit> fitOf(const TimedCloud& scan) {
  TimedPoints samples = sampled(scan);
  const double begin = *quantile(scan.offsets, kTails), end = *quantile(scan.offsets, 1 - kTails);
  const double middle = (begin + end) / 2;  // sums of large times would lose digits
  for (double& time : samples.times) time -= middle;
  double rate = coarseRate(samples, end - begin);
  double atMiddle = std::arg(meanDirection(samples, rate));
  for (int i = 0; i < 3; ++i) refine(samples, rate, atMiddle);
  const auto errors = residuals(samples, rate, atMiddle);
  const auto near = std::count_if(errors.begin(), errors.end(),
                                  [](double error) { return std::abs(error) < kOnLine; });
  const double turns = (end - begin) * std::abs(rate) / (2 * M_PI);
  if (static_cast<double>(near) < kLeastOnLine * static_cast<double>(errors.size()) ||
      turns < 0.7 || turns > kMostTurns)
    return std::nullopt;
  return Fit{rate, atMiddle - rate * middle, middle, turns};
}

bool beginElsewhere(const Fit& a, const Fit& b) {
  return std::abs(wrapAngle(a.atStamp - b.atStamp)) > kMostSpread;
}

}  // namespace

struct TimingEstimate::Impl {
  void add(const TimedCloud& scan);
  bool complete() const;
  std::string problem() const;
  ScanTiming timing() const;

  std::vector<Fit> fits;    ///< of the first scans
  std::size_t scans = 0;    ///< of which these are
  std::size_t untimed = 0;  ///< points without times, or all with the same one
  std::size_t partial = 0;  ///< not a full turn
  bool cutMoves = false;    ///< some scan begins elsewhere than the first one, or ends elsewhere
  bool inOrder = true;      ///< the points of all fits are in the order of measuring
};

void TimingEstimate::Impl::add(const TimedCloud& scan) {
  const bool isLater = complete();
  if (!isLater) ++scans;
  const auto [first, last] = std::minmax_element(scan.offsets.begin(), scan.offsets.end());
  if (scan.offsets.empty() || *first == *last) {
    if (!isLater) ++untimed;
  } else if (!isFullTurn(scan.cloud)) {
    if (!isLater) ++partial;
  } else if (const auto found = fitOf(scan)) {
    if (!isLater) fits.push_back(*found);
    cutMoves = cutMoves || found->hasMoreThanATurn() ||
               (!fits.empty() && beginElsewhere(*found, fits.front()));
    const auto order = pointOrder(scan.cloud.view());
    const Turn turn = found->rate > 0 ? Turn::counterclockwise : Turn::clockwise;
    inOrder = inOrder && order && order->turn == turn;
  }
}

bool TimingEstimate::Impl::complete() const {
  return scans - untimed - partial >= kEnoughScans || scans >= kMostScans;
}

std::string TimingEstimate::Impl::problem() const {
  if (untimed == scans) return "the points have no times of their own, or one for all";
  if (untimed + partial == scans) return "no scan is a full turn";
  if (fits.size() < scans - untimed - partial)
    return "the times of the points do not follow their azimuths";
  const Fit& reference = fits.front();
  for (const Fit& fit : fits) {
    const double seconds = 2 * M_PI / std::abs(fit.rate);
    if (seconds < kShortestTurn || seconds > kLongestTurn)
      return "the times of the points tell turns of " + significant(seconds, 3) +
             " s; uint32 in ns, float32 and float64 in s are expected";
    if (fit.rate * reference.rate < 0 || std::abs(fit.rate / reference.rate - 1) > 0.05)
      return "the scans turn in different ways";
    if (fit.stamp() < -0.5 || fit.stamp() > 1.5)
      return "the times of the points are far from the stamps of the scans";
  }
  if (cutMoves && !inOrder)
    return "the scans begin at different azimuths or have more than a turn, and their points are "
           "not in the order of measuring";
  return {};
}

ScanTiming TimingEstimate::Impl::timing() const {
  if (!problem().empty()) return {};
  std::vector<double> rates, stamps, sweeps, azimuths;
  for (const Fit& fit : fits) {
    rates.push_back(fit.rate);
    stamps.push_back(fit.stamp());
    sweeps.push_back(fit.sweep());
    azimuths.push_back(wrapAngle(fit.atStamp - fits.front().atStamp));
  }
  const double rate = medianOf(rates);
  ScanTiming timing;
  timing.turn = rate > 0 ? Turn::counterclockwise : Turn::clockwise;
  timing.seconds = 2 * M_PI / std::abs(rate);
  const double stamp = medianOf(stamps);
  const double nearest = std::round(stamp) + 0.0;  // not -0
  timing.stamp = std::clamp(std::abs(stamp - nearest) < kRoundedStamp ? nearest : stamp, 0.0, 1.0);
  // A stamp outside the turn is one of another clock.
  if (std::abs(timing.stamp - stamp) > kRoundedStamp)
    timing.clock = (timing.stamp - stamp) * medianOf(sweeps) * timing.seconds;
  const double atStamp = fits.front().atStamp + medianOf(azimuths);
  timing.cut = wrapAngle(atStamp + rate * (timing.clock - timing.stamp * timing.seconds));
  timing.movingCut = cutMoves;
  return timing;
}

TimingEstimate::TimingEstimate() : m_impl(std::make_unique<Impl>()) {}
TimingEstimate::TimingEstimate(TimingEstimate&&) noexcept = default;
TimingEstimate& TimingEstimate::operator=(TimingEstimate&&) noexcept = default;
TimingEstimate::~TimingEstimate() = default;

void TimingEstimate::add(const TimedCloud& scan) {
  m_impl->add(scan);
}

bool TimingEstimate::complete() const {
  return m_impl->complete();
}

ScanTiming TimingEstimate::timing() const {
  return m_impl->timing();
}

std::string TimingEstimate::note() const {
  const std::string reason = m_impl->problem();
  if (!reason.empty()) return "when points were measured is not known: " + reason;
  const ScanTiming found = timing();
  return "times of the points: turns of " + significant(found.seconds, 4) + " s, " +
         name(found.turn) +
         (found.movingCut ? ", each from its first point on"
                          : ", cut at " + significant(found.cut / degree, 4) + " deg") +
         ", stamped at " + significant(found.stamp, 3) + " of the turn";
}

}  // namespace polemcl::io
