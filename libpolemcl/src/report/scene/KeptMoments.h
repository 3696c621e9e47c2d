#pragma once
/// \file KeptMoments.h
/// \brief What is kept of each scan of a run, so that it can be shown again.

#include <cstddef>
#include <deque>
#include <optional>
#include <vector>

#include "report/scene/LiveMoment.h"

namespace polemcl::report {

/// \brief The moments of a run: the newest whole, older ones without points and with few
/// particles.
///
/// A scan takes some 0.5 kB, 24 bytes a pole and 12 bytes a particle: 2 kB with 20 poles. Of a long
/// drive only the last `mostScans` are kept, some 200 MB.
class KeptMoments {
 public:
  static constexpr std::size_t mostScans = 100000;   ///< 2.8 h at 10 Hz
  static constexpr std::size_t mostParticles = 100;  ///< of a moment before the newest
  static constexpr std::size_t mostHypotheses = 10;  ///< of a moment before the newest

  /// \brief Moments must come in order, one for each scan. Their ways are made here.
  void add(LiveMoment moment);
  std::size_t oldest() const { return m_newest.scan + 1 - m_kept.size(); }
  /// \brief With ways. \param scan From oldest() to the newest.
  LiveMoment at(std::size_t scan) const;
  /// \brief Of the position, m, at each scan so far; negative where it is not known.
  const std::vector<float>& errors() const { return m_errors; }

 private:
  struct Pole {
    float x, y, radius, bottom, top;  ///< robot frame, m
    bool matched;
  };
  struct Particle {
    float x, y;  ///< from the estimate, axes of the map, m
    float weight;
  };
  struct Kept {
    double elapsed = 0;
    std::optional<PoseWithCovariance> estimate;
    std::optional<Pose2D> truth;
    Health health;
    StepReport step;
    bool relocalized = false, associated = false;
    std::vector<Pole> poles;
    std::vector<Particle> particles;
    std::vector<GlobalHypothesis> hypotheses;
  };
  static Kept kept(const LiveMoment& moment);
  static LiveMoment restored(const Kept& kept);

  LiveMoment m_newest;
  std::deque<Kept> m_kept;  ///< the last one is the newest
  std::vector<float> m_errors;
  Way m_way, m_trueWay;
};

}  // namespace polemcl::report
