#pragma once
/// \file CPoleMap.h
/// \brief A map of poles as a metric map of MRPT, and the registration of our classes in MRPT.

#include <mrpt/config/CLoadableOptions.h>
#include <mrpt/maps/CMetricMap.h>

#include <map>
#include <memory>
#include <string>
#include <vector>

#include <polemcl/core/common/Types.h>
#include <polemcl/core/localization/PoleLikelihood.h>
#include <polemcl/export.h>
#include <polemcl/mrpt/common/Compatibility.h>

namespace polemcl {

class CObservationPoles;
class IncrementalMerge;
class PoleIndex;  // private to the library

/// \brief Poles in the map frame, with an index of them. A const map may be shared between threads;
/// copies are independent.
///
/// Name in INI files of MRPT's tools: `poleMap`. Set `poleMap_count = 1` and add the sections
/// `<prefix>_poleMap_00_creationOpts` (`map_file`: a `.polemap` to load, relative to the working
/// directory), `…_insertOpts`, `…_likelihoodOpts`.
class POLEMCL_EXPORT CPoleMap : public mrpt::maps::CMetricMap {
  DEFINE_SERIALIZABLE(CPoleMap, polemcl)

 public:
  CPoleMap();

  const std::vector<MapPole>& poles() const { return m_poles; }  ///< map frame
  /// \brief Replaces all poles and builds the index. Its grid is prepared for
  /// `likelihoodOptions.gate`: set the options first, or set the poles again. (If the gate is
  /// widened later, nanoflann's tree replaces the grid: slower, with the same numbers.)
  /// \throws Error on a position or covariance that is not finite, or a covariance that is not
  ///         positive semidefinite.
  void setPoles(std::vector<MapPole> poles);
  /// \brief Index i is poles()[i]. After an insertion, the first call builds it anew.
  const PoleIndex& index() const;

  /// \brief Facts about the map (name -> value), stored in the `.polemap` too.
  std::map<std::string, std::string> info;

  /// \brief Replaces poles and info. \throws Error when the file cannot be read or is damaged.
  void loadFromPoleMapFile(const std::string& path);
  /// \throws Error when the file cannot be written.
  void saveToPoleMapFile(const std::string& path) const;

  /// \brief Rules for inserting observations one by one (MRPT's tools). If all scans are available,
  /// use the map builder of `core/mapping/` instead.
  struct TInsertionOptions : public mrpt::config::CLoadableOptions {
    double mergeDistance =
        0.5;  ///< a detection this near to a pole is that pole, m (`merge_distance`)
    double minConfidence = 0;  ///< detections below are not inserted (`min_confidence`)
    /// \brief Unknown keys get a warning. \throws Error on wrong types and values out of range.
    void loadFromConfigFile(const mrpt::config::CConfigFileBase& source,
                            const std::string& section) override;
    void saveToConfigFile(mrpt::config::CConfigFileBase& target,
                          const std::string& section) const override;
    void dumpToTextStream(std::ostream& out) const override;
    void validate() const;  ///< \throws Error
  } insertionOptions;

  /// \brief The core's likelihood options with MRPT's functions for loading and showing them.
  struct TLikelihoodOptions : public mrpt::config::CLoadableOptions, public LikelihoodOptions {
    TLikelihoodOptions() = default;
    TLikelihoodOptions& operator=(const LikelihoodOptions& options);
    /// \brief Unknown keys get a warning. \throws Error on wrong types and values out of range.
    void loadFromConfigFile(const mrpt::config::CConfigFileBase& source,
                            const std::string& section) override;
    void saveToConfigFile(mrpt::config::CConfigFileBase& target,
                          const std::string& section) const override;
    void dumpToTextStream(std::ostream& out) const override;
  } likelihoodOptions;

  /// \name Likelihood of many poses at once
  /// One definition, that of the core (core/localization/PoleLikelihood.h) with
  /// `likelihoodOptions`. MRPT calls computeObservationLikelihood() for one pose; these functions
  /// are for all particles at once. The same planar pose gets
  /// the same number, bit for bit.
  /// @{
  /// \brief log p(observation | pose) up to a constant, finite. All 0 for observations other than
  /// CObservationPoles, because they carry no information for this map. Also all 0 when
  /// `genericMapParams.enableObservationLikelihood` is false, as in MRPT's own maps.
  /// \param robotPoses Map frame.
  /// \param out Element i belongs to robotPoses[i].
  /// \throws Error as logLikelihood() of the core.
  void logLikelihoods(const mrpt::obs::CObservation& observation,
                      const std::vector<Pose2D>& robotPoses, std::vector<double>& out) const;
  /// \brief As logLikelihoods(), with other options, and for several sigmas that share the search
  /// for the nearest pole. out[k][i] belongs to robotPoses[i] with widenings[k] times
  /// `options.sigma`. \throws Error also for more than `maxWidenings`.
  void widenedLogLikelihoods(const mrpt::obs::CObservation& observation,
                             const LikelihoodOptions& options,
                             const std::vector<Pose2D>& robotPoses,
                             const std::vector<double>& widenings,
                             std::vector<std::vector<double>>& out) const;
  /// @}

  /// \name Matching with another pole map, as MRPT's ICP asks for it
  /// Each pole of the other map is paired with the nearest pole of this map (with all of them,
  /// unless `params.onlyKeepTheClosest`). Poles are points of the plane: heights do not count.
  /// \throws Error when the other map is not a CPoleMap, or parameters exclude each other.
  /// @{
  void determineMatching2D(const mrpt::maps::CMetricMap* otherMap,
                           const mrpt::poses::CPose2D& otherMapPose,
                           mrpt::tfest::TMatchingPairList& correspondences,
                           const mrpt::maps::TMatchingParams& params,
                           mrpt::maps::TMatchingExtraResults& extraResults) const override;
  void determineMatching3D(const mrpt::maps::CMetricMap* otherMap,
                           const mrpt::poses::CPose3D& otherMapPose,
                           mrpt::tfest::TMatchingPairList& correspondences,
                           const mrpt::maps::TMatchingParams& params,
                           mrpt::maps::TMatchingExtraResults& extraResults) const override;
  /// \return Share of the other map's poles with a pole of this map nearer than `maxDistForCorr`.
  float compute3DMatchingRatio(const mrpt::maps::CMetricMap* otherMap,
                               const mrpt::poses::CPose3D& otherMapPose,
                               const mrpt::maps::TMatchingRatioParams& params) const override;
  /// @}
  /// \return Squared distance to the nearest pole, m²; infinite without poles.
  float squareDistanceToClosestCorrespondence(float x0, float y0) const override;

  bool isEmpty() const override { return m_poles.empty(); }
  std::string asString() const override;
  /// \brief Writes `<prefix>.polemap`, `<prefix>.csv` and `<prefix>.3Dscene` (getVisualization() in
  /// the map frame, m).
  void saveMetricMapRepresentationToFile(const std::string& filNamePrefix) const override;
  /// \brief A cylinder from bottom to top for each pole, map frame, ground at z = 0, coloured by
  /// count. Nothing when `genericMapParams.enableSaveAs3DObject` is false. At UTM coordinates
  /// OpenGL cannot draw them.
  void getVisualizationInto(viz::CSetOfObjects& outObj) const override;

  MAP_DEFINITION_START(CPoleMap)
  std::string mapFile;  ///< `.polemap` to load at creation; empty: no file
  polemcl::CPoleMap::TInsertionOptions insertionOpts;
  polemcl::CPoleMap::TLikelihoodOptions likelihoodOpts;
  MAP_DEFINITION_END(CPoleMap)

 protected:
  void internal_clear() override;
  /// \brief Merges CObservationPoles; returns false for other observations.
  bool internal_insertObservation(
      const mrpt::obs::CObservation& obs,
      const std::optional<const mrpt::poses::CPose3D>& robotPose = std::nullopt) override;
  /// \brief Same value as logLikelihoods() for the planar part (x, y, yaw) of this pose.
  double internal_computeObservationLikelihood(
      const mrpt::obs::CObservation& obs, const mrpt::poses::CPose3D& takenFrom) const override;
  bool internal_canComputeObservationLikelihood(const mrpt::obs::CObservation& obs) const override;

 private:
  void evaluate(const CObservationPoles& scan, const LikelihoodOptions& options,
                const std::vector<Pose2D>& robotPoses, const std::vector<double>& widenings,
                std::vector<std::vector<double>>& out) const;

  /// An index that is never changed, so copies share it; none: it is built when it is asked for.
  class LazyIndex {
   public:
    LazyIndex() = default;
    explicit LazyIndex(std::shared_ptr<const PoleIndex> index) : m_index(std::move(index)) {}
    LazyIndex(const LazyIndex& other) : m_index(std::atomic_load(&other.m_index)) {}
    LazyIndex& operator=(LazyIndex other) {
      std::atomic_store(&m_index, std::move(other.m_index));
      return *this;
    }
    const PoleIndex& of(const std::vector<MapPole>& poles, double gate) const;

   private:
    mutable std::shared_ptr<const PoleIndex> m_index;
  };

  std::vector<MapPole> m_poles;
  LazyIndex m_index;
  std::shared_ptr<IncrementalMerge> m_merge;  ///< of m_poles; null: nothing was inserted yet
};

/// \brief Registers CObservationPoles and CPoleMap, so that MRPT finds them by their names in
/// rawlogs and INI files. Nothing needs to call it: loading the library does it. Further calls have
/// no effect.
POLEMCL_EXPORT void registerClasses();

/// \brief Keeps the library in a program that includes this header and names no class of it. A
/// linker that drops unused libraries (`--as-needed`) would not load it.
inline const bool classesAreRegistered = (registerClasses(), true);

}  // namespace polemcl
