#pragma once
/// \file PulseReturn.h
/// \brief Response of a receiver to a pulse whose parts hit different objects, in rain and
/// spray.

#include <cstdint>
#include <optional>
#include <vector>

#include "sim/common/Random.h"
#include "sim/common/RealismOptions.h"
#include "sim/lidar/LidarModel.h"
#include "sim/lidar/SolidView.h"

namespace polemcl::sim {

/// \brief Hit of one sub-ray.
struct SubHit {
  float range, cosine;
  std::int32_t solid;  ///< index of the solid, or a constant below
  static constexpr std::int32_t kNothing = -1, kRoad = -2, kPavement = -3, kGrass = -4;
};

struct PulseReturn {
  double range;
  float intensity;  ///< in [0, 1]
  std::uint32_t label;
};

/// \brief Merges sub-rays into the returns of one LiDAR.
class PulseReturnModel {
 public:
  PulseReturnModel(const LidarModel& lidar, const std::vector<SolidView>& solids,
                   const RealismOptions& realism)
      : m_lidar(lidar), m_solids(solids), m_realism(realism) {}
  /// \brief The strongest return; nullopt if it is not detected.
  /// \param azimuth Direction of the pulse, rad.
  std::optional<PulseReturn> make(const SubHit* hits, const Beam& beam, double azimuth,
                                  std::uint64_t seed) const;

 private:
  std::optional<PulseReturn> strongest(const SubHit* hits, const Beam& beam,
                                       std::uint64_t seed) const;
  double deviation(const Beam& beam, double ratio) const;
  const Material& material(const SubHit& hit) const;
  const LidarModel& m_lidar;
  const std::vector<SolidView>& m_solids;
  const RealismOptions& m_realism;
};

/// \brief Range of the drop that a pulse meets first, m; nothing if it meets none.
/// \param azimuth, elevation Direction of the pulse, sensor frame, rad; the vehicle drives along x.
std::optional<double> dropRange(const RealismOptions& realism, double azimuth, double elevation,
                                Random& random);

/// \brief Factor of the signal from a surface at a range, m: wet surfaces are darker, and drops
/// take energy on both ways.
double rainFactor(const RealismOptions& realism, double range);

}  // namespace polemcl::sim
