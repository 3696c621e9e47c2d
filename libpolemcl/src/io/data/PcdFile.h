#pragma once
/// \file PcdFile.h
/// \brief Point clouds from PCD files, the format of the Point Cloud Library (0.5 to 0.7).

#include <filesystem>

#include "io/data/Cloud.h"

namespace polemcl::io {

/// \brief Reads `DATA ascii`, `binary` and `binary_compressed` (LZF, as PCL writes it: field after
/// field). The fields x, y and z are needed, `intensity` is
/// taken if there is one (else 0), others are passed over. All types and sizes of the format are
/// read. The view point of the header is not applied: points stay in the frame they are in.
/// Invalid points are dropped and counted as by readKittiBin().
/// \throws Error naming the file (and line): cannot be read, no PCD header, no x, y or z, fewer
///         points than the header says, not a number, compressed points that are damaged.
Cloud readPcd(const std::filesystem::path& file);

}  // namespace polemcl::io
