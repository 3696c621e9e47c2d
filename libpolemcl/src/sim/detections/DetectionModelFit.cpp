#include "sim/detections/DetectionModelFit.h"

#include <algorithm>
#include <cmath>
#include <unordered_map>

#include "core/evaluation/DetectionEvaluation.h"
#include "sim/common/NormalDistribution.h"
#include "sim/detections/DetectionTracks.h"
#include "sim/detections/NoiseFit.h"

namespace polemcl::sim {
namespace {

constexpr std::array<double, 12> kDetectedRange{2, 4.5, 7, 10, 13, 16, 20, 24, 28, 32, 36, 39.5};
constexpr std::array<double, 5> kReportedRange{3, 8, 14, 22, 33};
constexpr std::array<std::size_t, 8> kLags{0, 1, 2, 4, 8, 16, 32, 64};  // scans
constexpr std::size_t kFewSamples = 40;  // fewer samples are not enough for a distribution
constexpr std::size_t kFewPairs = 100;

template <std::size_t n>
std::size_t nearest(const std::array<double, n>& nodes, double x) {
  std::size_t best = 0;
  for (std::size_t i = 1; i < n; ++i)
    if (std::abs(nodes[i] - x) < std::abs(nodes[best] - x)) best = i;
  return best;
}

bool isPole(DetectionClass c) {
  return c != DetectionClass::clutter && c != DetectionClass::passing;
}

class Fit {
 public:
  Fit(const std::vector<ObservedStreet>& streets, double maxRange) {
    m_model.maxRange = maxRange;
    m_model.detectedRange.assign(kDetectedRange.begin(), kDetectedRange.end());
    m_model.reportedRange.assign(kReportedRange.begin(), kReportedRange.end());
    while (m_model.detectedRange.back() > maxRange) m_model.detectedRange.pop_back();
    m_spacing = streets.front().first.drive->options().spacing;
    for (const ObservedStreet& street : streets) m_streets.push_back(trackStreet(street, maxRange));
  }

  DetectionModel run(const std::vector<ObservedStreet>& streets) {
    fitDetected();
    fitReported();  // gives the usual sigmas
    fitErrorExponent();
    scaleErrors();
    fitReported();
    fitNoise();
    fitFalse(streets);
    return m_model;
  }

 private:
  /// Slope of log(error) over log(sigma), both relative to the usual sigma at the range (Harvey
  /// 1976).
  void fitErrorExponent() {
    double count = 0, x = 0, y = 0, xx = 0, xy = 0;
    forTracks([&](const Track& track) {
      if (!isPole(track.kind)) return;
      for (const Chance& chance : track.chances)
        for (int i = 0; i < 2 && chance.detection; ++i) {
          const double usual = m_model.value(track.kind, static_cast<Reported>(i), chance.range, 0);
          const double error = std::abs(chance.reported[i] * chance.reported[i + 2]);
          if (error < 1e-6) continue;
          const double a = std::log(chance.reported[i] / usual), b = std::log(error / usual);
          count += 1;
          x += a;
          y += b;
          xx += a * a;
          xy += a * b;
        }
    });
    const double spread = count * xx - x * x;
    if (spread > 0) m_model.errorExponent = std::clamp((count * xy - x * y) / spread, 0.0, 1.0);
  }

  /// Converts errors from multiples of the reported sigma to multiples of errorScale().
  void scaleErrors() {
    const auto scale = [&](DetectionClass kind, Chance& chance) {
      for (int i = 0; i < 2 && chance.detection; ++i)
        chance.reported[i + 2] *=
            chance.reported[i] /
            m_model.errorScale(kind, static_cast<Reported>(i), chance.range, chance.reported[i]);
    };
    for (TrackedStreet& street : m_streets)
      for (TrackedDrive* drive : {&street.first, &street.second}) {
        for (Track& track : drive->tracks)
          for (Chance& chance : track.chances) scale(track.kind, chance);
        for (Chance& chance : drive->passing) scale(DetectionClass::passing, chance);
      }
  }

  template <class Work>
  void forTracks(const Work& work) const {
    for (const TrackedStreet& street : m_streets)
      for (const TrackedDrive* drive : {&street.first, &street.second})
        for (const Track& track : drive->tracks) work(track);
  }

  /// Counts detections per range, then finds thresholds (linear between the ranges) that reproduce
  /// the counts.
  void fitDetected() {
    const std::size_t nodes = m_model.detectedRange.size();
    std::size_t hidden = 0, hiddenFound = 0;
    struct Bin {
      double chances = 0, found = 0;
    };
    std::array<std::vector<Bin>, kDetectionClasses> bins;
    std::vector<Bin> all(nodes);
    for (auto& row : bins) row.resize(nodes);
    forTracks([&](const Track& track) {
      for (const Chance& chance : track.chances) {
        if (chance.hidden) {
          ++hidden;
          hiddenFound += chance.detection != nullptr;
          continue;
        }
        const std::size_t i = std::min(nearest(kDetectedRange, chance.range), nodes - 1);
        for (Bin* bin : {&bins[static_cast<int>(track.kind)][i], &all[i]}) {
          if (bin == &all[i] && !isPole(track.kind)) continue;
          ++bin->chances;
          bin->found += chance.detection != nullptr;
        }
      }
    });
    m_model.behindHouses =
        hidden > 0 ? static_cast<double>(hiddenFound) / static_cast<double>(hidden) : 0;
    for (int c = 0; c < static_cast<int>(DetectionClass::passing); ++c)
      for (std::size_t i = 0; i < nodes; ++i) {
        const Bin& own = bins[c][i];
        const Bin& bin =
            own.chances < kFewSamples && isPole(static_cast<DetectionClass>(c)) ? all[i] : own;
        m_model.classes[c].detected.push_back((bin.found + 0.5) / (bin.chances + 1));
      }
    adjustDetected();
  }

  /// Linear thresholds between the ranges give other counts than steps. They are adjusted until the
  /// counts agree.
  void adjustDetected() {
    const std::size_t nodes = m_model.detectedRange.size();
    for (int sweep = 0; sweep < 20; ++sweep) {
      std::array<std::vector<double>, kDetectionClasses> chances, found, expected;
      for (auto* rows : {&chances, &found, &expected})
        for (auto& row : *rows) row.assign(nodes, 0);
      forTracks([&](const Track& track) {
        const int c = static_cast<int>(track.kind);
        for (const Chance& chance : track.chances) {
          if (chance.hidden) continue;
          const std::size_t i = std::min(nearest(kDetectedRange, chance.range), nodes - 1);
          chances[c][i] += 1;
          found[c][i] += chance.detection != nullptr;
          expected[c][i] += normalCdf(m_model.detectionScore(track.kind, chance.range));
        }
      });
      for (int c = 0; c < static_cast<int>(DetectionClass::passing); ++c)
        for (std::size_t i = 0; i < nodes; ++i) {
          if (chances[c][i] < kFewSamples) continue;
          const auto score = [&](double count) {
            return normalQuantile((count + 0.5) / (chances[c][i] + 1));
          };
          double& p = m_model.classes[c].detected[i];
          p = normalCdf(normalQuantile(p) + 0.7 * (score(found[c][i]) - score(expected[c][i])));
        }
    }
  }

  void fitReported() {
    using Samples = std::array<std::vector<double>, kReported>;
    std::array<std::array<Samples, kReportedRange.size()>, kDetectionClasses> samples;
    std::array<Samples, kReportedRange.size()> poles;
    const auto add = [&](Samples& to, const Chance& chance) {
      for (int r = 0; r < kReported; ++r) to[r].push_back(chance.reported[r]);
    };
    forTracks([&](const Track& track) {
      for (const Chance& chance : track.chances) {
        if (!chance.detection) continue;
        const std::size_t i = nearest(kReportedRange, chance.range);
        add(samples[static_cast<int>(track.kind)][i], chance);
        if (isPole(track.kind)) add(poles[i], chance);
      }
    });
    for (const TrackedStreet& street : m_streets)
      for (const TrackedDrive* drive : {&street.first, &street.second})
        for (const Chance& chance : drive->passing)
          add(samples[static_cast<int>(DetectionClass::passing)]
                     [nearest(kReportedRange, chance.range)],
              chance);
    for (int c = 0; c < kDetectionClasses; ++c) {
      m_model.classes[c].reported = {};
      Samples pooled;  // over all ranges, for rare classes
      for (const Samples& row : samples[c])
        for (int r = 0; r < kReported; ++r)
          pooled[r].insert(pooled[r].end(), row[r].begin(), row[r].end());
      for (std::size_t i = 0; i < kReportedRange.size(); ++i) {
        const Samples* use = &samples[c][i];
        if ((*use)[0].size() < kFewSamples)
          use = isPole(static_cast<DetectionClass>(c)) || pooled[0].size() < kFewSamples ? &poles[i]
                                                                                         : &pooled;
        for (int r = 0; r < kReported; ++r)
          m_model.classes[c].reported[r].push_back(quantilesOf((*use)[r]));
      }
    }
  }

  static Quantiles quantilesOf(const std::vector<double>& values) {
    if (values.size() < 5)
      throw Error("hardly any pole is found on these streets; nothing can be fitted");
    Quantiles quantiles;
    for (std::size_t i = 0; i < quantiles.size(); ++i)
      quantiles[i] = *quantile(values, kQuantileLevels[i]);
    return quantiles;
  }

  /// Visits pairs of chances of one object: on one day, or on both days.
  template <class Work>
  void forPairs(std::size_t lag, bool sameDay, const Work& work) const {
    for (std::size_t n = 0; n < m_streets.size(); ++n) {
      const TrackedStreet& street = m_streets[n];
      std::unordered_map<std::uint64_t, const Track*> second;
      for (const Track& track : street.second.tracks) second[track.id] = &track;
      for (const TrackedDrive* drive : {&street.first, &street.second})
        for (const Track& a : drive->tracks) {
          const auto found = second.find(a.id);
          const Track* b = &a;
          if (!sameDay) {
            if (drive == &street.second || found == second.end()) continue;
            b = found->second;
          }
          pairChances(a, *b, lag, work);
        }
    }
  }

  template <class Work>
  static void pairChances(const Track& a, const Track& b, std::size_t lag, const Work& work) {
    std::size_t k = 0;
    for (const Chance& chance : a.chances) {
      while (k < b.chances.size() && b.chances[k].scan < chance.scan + lag) ++k;
      if (k == b.chances.size()) return;
      if (b.chances[k].scan == chance.scan + lag && !chance.hidden && !b.chances[k].hidden)
        work(a, chance, b.chances[k]);
    }
  }

  /// \param add Puts a pair of chances of one track into Pairs, or leaves it out.
  template <class Pairs, class Add>
  NoiseSpectrum spectrumOf(const Add& add) const {
    std::vector<LagCorrelation> counted;
    for (const bool sameDay : {true, false})
      for (const std::size_t lag : kLags) {
        if (sameDay && lag == 0) continue;
        Pairs pairs;
        forPairs(lag, sameDay, [&](const Track& track, const Chance& a, const Chance& b) {
          add(pairs, track, a, b);
        });
        if (pairs.count() >= kFewPairs)
          counted.push_back({static_cast<double>(lag) * m_spacing, sameDay, pairs.correlation()});
      }
    return fitSpectrum(counted);
  }

  NoiseSpectrum visibility(bool poles) const {
    return spectrumOf<PairedHits>(
        [&](PairedHits& hits, const Track& track, const Chance& a, const Chance& b) {
          if (isPole(track.kind) == poles)
            hits.add(m_model.detectionScore(track.kind, a.range),
                     m_model.detectionScore(track.kind, b.range), a.detection && b.detection);
        });
  }

  NoiseSpectrum reportedNoise(Reported r) const {
    const auto z = [&](const Track& track, const Chance& chance) {
      // Uses the nearer of the two tables that valueAt() mixes.
      const auto& table = m_model.of(track.kind).reported[static_cast<int>(r)];
      return scoreOf(table[nearest(kReportedRange, chance.range)],
                     chance.reported[static_cast<int>(r)]);
    };
    return spectrumOf<PairedNumbers>(
        [&](PairedNumbers& pairs, const Track& track, const Chance& a, const Chance& b) {
          if (isPole(track.kind) && a.detection && b.detection) pairs.add(z(track, a), z(track, b));
        });
  }

  void fitNoise() {
    m_model.poleVisibility = visibility(true);
    m_model.clutterVisibility = visibility(false);
    for (int r = 0; r < kReported; ++r) m_model.noise[r] = reportedNoise(static_cast<Reported>(r));
  }

  void fitFalse(const std::vector<ObservedStreet>& streets) {
    double length = 0, always = 0, lasting = 0, passing = 0, scans = 0;
    std::vector<double> lateral, ranges;
    for (std::size_t n = 0; n < streets.size(); ++n) {
      const TrackedStreet& tracked = m_streets[n];
      const Street& street = streets[n].first.drive->world().street();
      length += street.length();
      always += static_cast<double>(tracked.clutterOnBoth);
      for (const TrackedDrive* drive : {&tracked.first, &tracked.second}) {
        scans += static_cast<double>(drive->scans);
        passing += static_cast<double>(drive->passing.size());
        for (const Chance& chance : drive->passing)
          ranges.push_back(std::min(chance.range, m_model.maxRange));
        for (const Track& track : drive->tracks) {
          if (track.kind != DetectionClass::clutter) continue;
          lasting += 0.5;
          lateral.push_back(std::sqrt(squaredDistance(street, track.place)));
        }
      }
    }
    m_model.clutterAlways = always / length;
    m_model.clutterToday = std::max(0.0, lasting - always) / length;
    m_model.passing = passing / scans;
    m_model.clutterLateral = lateral.size() < 5 ? Quantiles{} : quantilesOf(lateral);
    m_model.passingRange = ranges.size() < 5 ? Quantiles{} : quantilesOf(ranges);
  }

  static double squaredDistance(const Street& street, const Eigen::Vector2d& place) {
    double best = 1e18;
    for (const Eigen::Vector2d& point : street.points())
      best = std::min(best, (place - point).squaredNorm());
    return best;
  }

  DetectionModel m_model;
  std::vector<TrackedStreet> m_streets;
  double m_spacing;  ///< of the scans, m; the same on all streets
};

void requireTwoDays(const ObservedStreet& street) {
  const SimulationOptions &a = street.first.drive->options(), &b = street.second.drive->options();
  if (a.world.seed != b.world.seed || a.world.track != b.world.track ||
      a.world.length != b.world.length)
    throw Error(
        "the two drives of a pair are on two streets; each pair must be one street on two "
        "days");
  if (a.world.day == b.world.day)
    throw Error(
        "the two drives of a pair are on one day; each pair must be one street on two days");
}

void requireSameSensing(const SimulatedDrive& drive, const SimulatedDrive& first) {
  const auto differ = [](const std::string& what) {
    throw Error("the drives differ in " + what + "; a model is made for a single one");
  };
  if (drive.options().spacing != first.options().spacing) differ("spacing_m");
  if (drive.options().height != first.options().height) differ("[sensor] height_m");
  if (drive.lidar().name != first.lidar().name) differ("[sensor] model");
}

}  // namespace

DetectionModel fitDetectionModel(const std::vector<ObservedStreet>& streets, double maxRange,
                                 const std::string& fittedOn) {
  if (streets.empty()) throw Error("no street to fit a model to");
  if (maxRange < kDetectedRange.front())
    throw Error("max_range_m is below the nearest range of a model, 2 m");
  std::vector<double> points;
  for (const ObservedStreet& street : streets) {
    requireTwoDays(street);
    for (const ObservedDrive* drive : {&street.first, &street.second}) {
      requireSameSensing(*drive->drive, *streets.front().first.drive);
      points.insert(points.end(), drive->points.begin(), drive->points.end());
    }
  }
  DetectionModel model = Fit(streets, maxRange).run(streets);
  const SimulationOptions& options = streets.front().first.drive->options();
  model.sensor = streets.front().first.drive->lidar().name;
  model.height = options.height;
  model.points = static_cast<std::uint32_t>(quantile(points, 0.5).value_or(0));
  model.fittedOn = fittedOn;
  model.validate();
  return model;
}

}  // namespace polemcl::sim
