#pragma once
/// \file MultiScanLabels.h
/// \brief What stands at a place, judged from the points of many scans: labels for real drives
/// without labels.

#include <Eigen/Core>
#include <cstdint>
#include <unordered_map>
#include <vector>

namespace polemcl {

enum class Standing { pole, other, unsure };

/// \brief Collects the points of a drive around places and judges each place.
///
/// A place is a *pole* when what stands there is slim and free all round over one metre or more, up
/// to at least 1.8 m above ground, straight and upright, with something below it down to 0.6 m, and
/// was seen in several scans and from several sides. It is *other* when it is wide at most heights
/// from 0.6 to 1.8 m and nowhere slim, when it ends below 1.5 m although the beams reach higher, or
/// when it was there in one or two of many scans. Anything else is unsure.
class MultiScanLabels {
 public:
  /// \param places Map frame, m.
  explicit MultiScanLabels(std::vector<Eigen::Vector2d> places);

  /// \brief One scan. \param points_map Map frame, z up, corrected for motion. \param sensor_map
  /// Optical centre. \param topSlope Tangent of the elevation of the highest beam.
  void add(const std::vector<Eigen::Vector3f>& points_map, const Eigen::Vector3d& sensor_map,
           double topSlope);

  /// \brief Verdict on each place, in their order.
  std::vector<Standing> judge() const;

 private:
  struct Place {
    std::unordered_map<std::uint32_t, std::uint16_t> voxels;  ///< by cell: sides it was seen from
    std::uint32_t scans = 0, lastScan = 0;  ///< scans with points at the middle, above the ground
    std::uint32_t passes = 0;               ///< scans taken within 20 m
    float low = 1e9f;                       ///< lowest point so far, m
    float reach = -1e9f;                    ///< greatest height that a beam had here, m
  };
  void addTo(Place& place, const Eigen::Vector2d& centre, const Eigen::Vector3f& point,
             std::uint16_t side);
  Standing judge(const Place& place) const;

  std::vector<Eigen::Vector2d> m_centres;
  std::vector<Place> m_places;
  std::unordered_map<std::int64_t, std::vector<std::uint32_t>> m_grid;  ///< places by cell of 2 m
  std::uint32_t m_scans = 0;
};

}  // namespace polemcl
