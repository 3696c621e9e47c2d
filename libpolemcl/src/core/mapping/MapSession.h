#pragma once
/// \file MapSession.h
/// \brief One session against the poles of a kept map: who was found, who was missed. Private to
/// the library; see MapUpdater.h.

#include <vector>

#include <polemcl/core/mapping/MapUpdater.h>

#include "core/mapping/LandmarkFusion.h"

namespace polemcl {

/// \brief What a session says of one pole.
struct SessionPole {
  std::vector<std::uint32_t> sightings;  ///< indices into Session::sightings(), of all ranges
  ExistenceEvidence evidence;            ///< within range only
};

class Session {
 public:
  /// \throws Error as updateMap().
  Session(const std::vector<SessionScan>& scans, const PoleMapOptions& mapping,
          const MapUpdateOptions& upkeep);

  /// \brief Deals the sightings out to poles, and looks for those that were not found. May be
  /// called again with more poles.
  void observe(const std::vector<LandmarkRecord>& poles);

  const std::vector<LandmarkObservation>& sightings() const { return m_sightings; }
  const std::vector<SessionPole>& poles() const { return m_poles; }
  /// \brief Sightings that no pole took.
  std::vector<LandmarkObservation> loose() const;
  double firstTime() const { return m_firstTime; }
  double lastTime() const { return m_lastTime; }
  double time(std::uint32_t view) const { return m_scans[view].time; }

 private:
  void deal(std::size_t view, const class KdTree2D& tree);
  void expect(std::size_t view, const KdTree2D& tree, const std::vector<LandmarkRecord>& poles);

  const std::vector<SessionScan>& m_scans;
  const PoleMapOptions& m_mapping;
  const MapUpdateOptions& m_upkeep;
  std::vector<double> m_along;                   ///< way travelled to each scan, m
  std::vector<LandmarkObservation> m_sightings;  ///< scan by scan
  std::vector<std::size_t> m_firstOfView;  ///< index of its first sighting; one more than scans
  std::vector<std::uint32_t> m_owner;      ///< pole of each sighting, or none
  std::vector<SessionPole> m_poles;
  double m_firstTime = 0, m_lastTime = 0;
};

}  // namespace polemcl
