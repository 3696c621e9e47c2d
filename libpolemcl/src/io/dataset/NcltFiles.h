#pragma once
/// \file NcltFiles.h
/// \brief Where the files of one session of NCLT lie.

#include <filesystem>

#include "io/dataset/NcltOdometry.h"

namespace polemcl::io {

/// \brief The files of a session; empty paths are not there.
struct NcltFiles {
  std::filesystem::path sync, hits;  ///< folder of scans; file of packets
  std::filesystem::path truth, covariances;
  NcltOdometryFiles odometry;
};

/// \brief Finds them, see readNclt(). \throws Error: no scans, several files that may be meant.
NcltFiles findNcltFiles(const std::filesystem::path& session);

}  // namespace polemcl::io
