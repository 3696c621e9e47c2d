#pragma once
/// \file NcltFiles.h
/// \brief Finds the files of one NCLT session.

#include <filesystem>

#include "io/dataset/NcltOdometry.h"

namespace polemcl::io {

/// \brief The files of a session; a path is empty if the file does not exist.
struct NcltFiles {
  std::filesystem::path sync, hits;  ///< folder of scans; file of packets
  std::filesystem::path truth, covariances;
  std::filesystem::path gps;
  NcltOdometryFiles odometry;
};

/// \brief Finds the files, see readNclt(). \throws Error: no scans, several candidates for one
/// file.
NcltFiles findNcltFiles(const std::filesystem::path& session);

}  // namespace polemcl::io
