#pragma once
/// \file RawlogWriter.h
/// \brief Writes rawlogs, uncompressed, under a temporary name until they are complete.

#include <mrpt/obs/CActionCollection.h>
#include <mrpt/obs/CObservation.h>
#include <mrpt/obs/CSensoryFrame.h>

#include <memory>
#include <string>

namespace polemcl {

/// \brief Destroyed before commit(), it leaves nothing behind.
class RawlogWriter {
 public:
  /// \throws Error when the folder cannot be written.
  explicit RawlogWriter(const std::string& path);
  ~RawlogWriter();
  RawlogWriter(RawlogWriter&&) noexcept;
  RawlogWriter& operator=(RawlogWriter&&) noexcept;

  /// \brief An action and a sensory frame that holds the observation.
  /// \throws Error when an action's movement would not survive: CActionRobotMovement2D at
  ///         `emOdometry` stores the odometry reading, not `poseChange`.
  void write(const mrpt::obs::CActionCollection& action,
             const mrpt::obs::CObservation::Ptr& observation);
  /// \brief A bare observation.
  void write(const mrpt::obs::CObservation& observation);
  /// \brief Gives the file its name. \throws Error when not all could be written (disk full).
  void commit();

 private:
  struct Impl;
  std::unique_ptr<Impl> m_impl;
};

}  // namespace polemcl
