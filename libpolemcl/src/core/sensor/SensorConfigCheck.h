#pragma once
/// \file SensorConfigCheck.h
/// \brief Does a cloud come from the sensor that the configuration describes?

#include <string>

#include <polemcl/core/common/Types.h>
#include <polemcl/core/sensor/SensorOptions.h>
#include "core/sensor/SensorModel.h"

namespace polemcl {

/// \brief How the returns of one scan lie on the beams of a model. All shares in [0, 1].
struct BeamAgreement {
  std::size_t points = 0;  ///< between the sensor's ranges
  double outOfView = 0;    ///< share of the returns beyond the outermost beams
  double emptyRows = 0;    ///< share of beams without returns among those between used ones
  double mixedRows = 0;    ///< share of rows whose returns spread over their cell
  double mixedCells = 0;   ///< the same of 32nds of rows: not smeared by motion correction
  double meanOffset = 0;   ///< mean distance of a row's returns from its beam, in half gaps

  /// \brief Nothing here needs a closer look. `mixedRows` has no say: it reaches 0.66 in clouds
  /// that were corrected for motion.
  bool good() const;
};
BeamAgreement measureAgreement(const PointsView& points, const SensorModel& model, double minRange,
                               double maxRange);

/// \brief Compares scans with the configuration: milliseconds for a scan that agrees; one that
/// looks odd is inspected (identifySensor()), which takes half a second and decides.
class SensorConfigCheck {
 public:
  /// \param beams false: only whether the cloud is upright (method = range_image knows no beams).
  SensorConfigCheck(const SensorOptions& options, bool beams);

  /// \brief What in the cloud contradicts the configuration, in one line that says what to do;
  /// empty when nothing does, or there are too few points to tell. \param points In the lidar
  /// frame, as for PoleExtractor.
  std::string contradiction(const PointsView& points) const;
  /// \brief Fewest valid points of a scan to tell anything from.
  static constexpr std::size_t kFewestPoints = 2000;

 private:
  std::string inspect(const PointsView& points, const BeamAgreement& agreement) const;

  SensorOptions m_options;
  SensorModel m_model;
  bool m_beams;
};

}  // namespace polemcl
