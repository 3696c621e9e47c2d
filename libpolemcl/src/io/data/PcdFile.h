#pragma once
/// \file PcdFile.h
/// \brief Point clouds from PCD files, the format of the Point Cloud Library (0.5 to 0.7).

#include <filesystem>

#include <polemcl/io/data/Cloud.h>

namespace polemcl::io {

/// \brief Reads `DATA ascii`, `binary` and `binary_compressed` (LZF as PCL writes it, field by
/// field).
/// The fields x, y and z are required. `intensity` is optional (default 0); other fields are
/// ignored. All types and sizes of the format are supported. The VIEWPOINT of the header is not
/// applied: points stay in the frame of the file. Invalid points are dropped and counted as in
/// readKittiBin(). An empty file gives an empty cloud.
/// \throws Error with the file (and line): file not readable, no PCD header, x, y or z missing,
///         fewer points than the header says, a value that is not a number, damaged compressed
///         data.
Cloud readPcd(const std::filesystem::path& file);

}  // namespace polemcl::io
