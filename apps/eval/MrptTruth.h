#pragma once
/// \file MrptTruth.h
/// \brief True poses as MRPT's pf-localization reads them.

#include <filesystem>

namespace polemcl::apps {

/// \brief Writes rows `time x y yaw` (s, m, m, rad). pf-localization takes the first column for
/// indices if the first two times are whole numbers: poses at the start with such times are left
/// out.
/// \param tum File of true poses, see io/data/Trajectory.h.
/// \throws Error as readTum(); when no two successive times are fractions; when `output` is the
///         input or cannot be written.
void writeMrptTruth(const std::filesystem::path& tum, const std::filesystem::path& output);

}  // namespace polemcl::apps
