#pragma once
/// \file MapSession.h
/// \brief One session compared with the poles of a map: found and missed poles. Private to the
/// library; see MapUpdater.h.

#include <string>
#include <vector>

#include "core/mapping/LandmarkFusion.h"
#include "core/mapping/MapUpdater.h"

namespace polemcl {

constexpr double kNearby = 5;  ///< m: what is that near to the path, a depth camera sees as well

/// \brief Result of a session for one pole.
struct SessionPole {
  std::vector<std::uint32_t> observations;  ///< indices into Session::observations(), of all ranges
  ExistenceLikelihood likelihood;           ///< within range only
  bool wasNear = false;  ///< a scan without visibility ranges passed it within `kNearby`
};

/// \brief "the scan at 12.300000 s", for messages: scans may have been left out before.
std::string nameOf(const SessionScan& scan);

/// \brief The scans of a session, compared with a map.
class Session {
 public:
  /// \throws Error as updateMap().
  Session(const std::vector<SessionScan>& scans, const PoleMapOptions& mapping,
          const MapUpdateOptions& options);

  /// \brief Assigns the observations to poles, and looks for those that were not found. May be
  /// called again with more poles.
  void observe(const std::vector<LandmarkRecord>& poles);

  const std::vector<LandmarkObservation>& observations() const { return m_observations; }
  const std::vector<SessionPole>& poles() const { return m_poles; }
  /// \brief Observations without a pole.
  std::vector<LandmarkObservation> loose() const;
  double firstTime() const { return m_firstTime; }
  double lastTime() const { return m_lastTime; }
  double time(std::uint32_t number) const { return m_scans[number].time; }

 private:
  void assign(std::size_t number, const class KdTree2D& tree);
  void expect(std::size_t number, const KdTree2D& tree, const std::vector<LandmarkRecord>& poles);

  const std::vector<SessionScan>& m_scans;
  const PoleMapOptions& m_mapping;
  const MapUpdateOptions& m_options;
  std::vector<double> m_along;                      ///< distance travelled to each scan, m
  std::vector<LandmarkObservation> m_observations;  ///< scan by scan
  std::vector<std::size_t> m_firstOfScan;  ///< index of its first observation; one more than scans
  std::vector<std::uint32_t> m_owner;      ///< pole of each observation, or none
  std::vector<SessionPole> m_poles;
  double m_firstTime = 0, m_lastTime = 0;
};

}  // namespace polemcl
