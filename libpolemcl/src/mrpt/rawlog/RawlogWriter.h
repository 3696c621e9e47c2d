#pragma once
/// \file RawlogWriter.h
/// \brief Writes rawlogs, uncompressed. They have a temporary name until they are complete.

#include <mrpt/obs/CActionCollection.h>
#include <mrpt/obs/CObservation.h>
#include <mrpt/obs/CSensoryFrame.h>

#include <string>

#include "io/file/AtomicFile.h"

namespace polemcl {

/// \brief Writer of one rawlog. If it is destroyed before commit(), no file remains.
class RawlogWriter {
 public:
  /// \throws Error when the folder cannot be written.
  explicit RawlogWriter(const std::string& path);

  /// \brief Writes the comment of the rawlog, as MRPT's own; to be called first.
  /// \param time Of the first scan, s: MRPT's tools cut rawlogs by the times of all objects.
  void writeComment(const std::string& text, double time);
  /// \brief Writes an action and a sensory frame with the observation.
  /// \throws Error when an action's movement would be lost: CActionRobotMovement2D with
  ///         `emOdometry` stores the odometry reading, not `poseChange`.
  void write(const mrpt::obs::CActionCollection& action,
             const mrpt::obs::CObservation::Ptr& observation);
  /// \brief Writes a single observation.
  void write(const mrpt::obs::CObservation& observation) { writeObject(observation); }
  /// \brief Gives the file its name. \throws Error when a write failed (disk full).
  void commit() { m_file.commit(); }

 private:
  void writeObject(const mrpt::serialization::CSerializable& object);

  io::AtomicFile m_file;
};

}  // namespace polemcl
