#pragma once
/// \file CPoleMap.h
/// \brief A map of poles, as a metric map of MRPT.

#include <mrpt/config/CLoadableOptions.h>
#include <mrpt/maps/CMetricMap.h>

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "core/common/PoleIndex.h"
#include "core/common/Types.h"
#include "core/localization/PoleLikelihood.h"

namespace polemcl {

class CObservationPoles;

/// \brief Poles in the map frame, with an index that is built whenever the poles change. A const
/// map may be shared between threads; copies are independent.
///
/// As `poleMap` in INI files of MRPT's tools: `poleMap_count = 1`, with sections
/// `<prefix>_poleMap_00_creationOpts` (`map_file`: a `.polemap` to load, relative to the working
/// directory), `…_insertOpts`, `…_likelihoodOpts`.
class CPoleMap : public mrpt::maps::CMetricMap {
  DEFINE_SERIALIZABLE(CPoleMap, polemcl)

 public:
  CPoleMap();

  const std::vector<MapPole>& poles() const { return m_poles; }  ///< map frame
  /// \brief Replaces all poles and builds the index, its grid prepared for
  /// `likelihoodOptions.gate`: set the options first, or set the poles again. (With a wider gate
  /// later nanoflann's tree answers in place of the grid: slower, the same numbers.) \throws Error
  /// on a position or covariance that is not finite, or a covariance that is not
  ///         positive semidefinite.
  void setPoles(std::vector<MapPole> poles);
  /// \brief Index i is poles()[i].
  const PoleIndex& index() const { return *m_index; }

  /// \brief Facts that travel with the map (`.polemap` keeps them): name -> value.
  std::map<std::string, std::string> info;

  /// \throws Error when the file cannot be read or is damaged. Replaces poles and info.
  void loadFromPoleMapFile(const std::string& path);
  /// \throws Error when the file cannot be written.
  void saveToPoleMapFile(const std::string& path) const;

  /// \brief How detections become poles when observations are inserted one by one (MRPT's tools).
  /// The map builder of `core/` is the better way when all scans are at hand.
  struct TInsertionOptions : public mrpt::config::CLoadableOptions {
    double mergeDistance =
        0.5;  ///< a detection this near to a pole is that pole, m (`merge_distance`)
    double minConfidence = 0;  ///< detections below are not inserted (`min_confidence`)
    /// \throws Error on unknown keys, wrong types and values out of range.
    void loadFromConfigFile(const mrpt::config::CConfigFileBase& source,
                            const std::string& section) override;
    void saveToConfigFile(mrpt::config::CConfigFileBase& target,
                          const std::string& section) const override;
    void dumpToTextStream(std::ostream& out) const override;
    void validate() const;  ///< \throws Error
  } insertionOptions;

  /// \brief The core's likelihood options with MRPT's ways of loading and showing them.
  struct TLikelihoodOptions : public mrpt::config::CLoadableOptions, public LikelihoodOptions {
    TLikelihoodOptions() = default;
    TLikelihoodOptions& operator=(const LikelihoodOptions& options);
    /// \throws Error on unknown keys, wrong types and values out of range.
    void loadFromConfigFile(const mrpt::config::CConfigFileBase& source,
                            const std::string& section) override;
    void saveToConfigFile(mrpt::config::CConfigFileBase& target,
                          const std::string& section) const override;
    void dumpToTextStream(std::ostream& out) const override;
  } likelihoodOptions;

  /// \name Likelihood of many poses at once
  /// One definition, the core's (core/PoleLikelihood.h) with `likelihoodOptions`: MRPT asks for one
  /// pose by computeObservationLikelihood(), the filter of this library for all its particles by
  /// these. The same planar pose gets the same number, bit for bit.
  /// @{
  /// \brief log p(observation | pose) up to a constant, finite. All 0 for observations that are not
  /// CObservationPoles (they say nothing), and when `genericMapParams.enableObservationLikelihood`
  /// is false, as with MRPT's own.
  /// \param robotPoses Map frame.
  /// \param out Element i belongs to robotPoses[i].
  /// \throws Error as logLikelihood() of the core.
  void logLikelihoods(const mrpt::obs::CObservation& observation,
                      const std::vector<Pose2D>& robotPoses, std::vector<double>& out) const;
  /// \brief The same with several sigmas at once, which share the search for the nearest pole:
  /// out[k][i] belongs to robotPoses[i] with widenings[k] times `likelihoodOptions.sigma`.
  /// \throws Error also on more than `maxWidenings`.
  void widenedLogLikelihoods(const mrpt::obs::CObservation& observation,
                             const std::vector<Pose2D>& robotPoses,
                             const std::vector<double>& widenings,
                             std::vector<std::vector<double>>& out) const;
  /// @}

  bool isEmpty() const override { return m_poles.empty(); }
  std::string asString() const override;
  /// \brief Writes `<prefix>.polemap`, `<prefix>.csv` and `<prefix>.3Dscene` (an OverviewScene).
  void saveMetricMapRepresentationToFile(const std::string& filNamePrefix) const override;
  /// \brief A cylinder from bottom to top for each pole, map frame, ground at z = 0, coloured by
  /// count; nothing when `genericMapParams.enableSaveAs3DObject` is false. OpenGL draws none of
  /// them at UTM coordinates.
  void getVisualizationInto(mrpt::opengl::CSetOfObjects& outObj) const override;

  MAP_DEFINITION_START(CPoleMap)
  std::string mapFile;  ///< `.polemap` to load at creation; empty: none
  polemcl::CPoleMap::TInsertionOptions insertionOpts;
  polemcl::CPoleMap::TLikelihoodOptions likelihoodOpts;
  MAP_DEFINITION_END(CPoleMap)

 protected:
  void internal_clear() override;
  /// \brief Merges CObservationPoles; other observations are not inserted (false).
  bool internal_insertObservation(
      const mrpt::obs::CObservation& obs,
      const std::optional<const mrpt::poses::CPose3D>& robotPose = std::nullopt) override;
  /// \brief What logLikelihoods() gives for the planar part (x, y, yaw) of this one pose.
  double internal_computeObservationLikelihood(
      const mrpt::obs::CObservation& obs, const mrpt::poses::CPose3D& takenFrom) const override;
  bool internal_canComputeObservationLikelihood(const mrpt::obs::CObservation& obs) const override;

 private:
  void evaluate(const CObservationPoles& scan, const std::vector<Pose2D>& robotPoses,
                const std::vector<double>& widenings, std::vector<std::vector<double>>& out) const;

  std::vector<MapPole> m_poles;
  std::shared_ptr<const PoleIndex> m_index;  ///< immutable, so copies may share it
};

}  // namespace polemcl
