#pragma once
/// \file ScanFiles.h
/// \brief What the readers of dataset folders share: files in order, their numbers, checks.

#include <cstdint>

#include "io/dataset/ScanFolder.h"
#include "io/file/TextFile.h"

namespace polemcl::io {

/// \brief Files of a folder with the ending, absolute, in the order of their names (bytes).
/// Hidden files are left out. \throws Error when there is no such folder, or no such file in it.
std::vector<std::filesystem::path> listFiles(const std::filesystem::path& folder,
                                             const std::string& ending);

/// \brief Whether an optional file is there. A link to nothing, or what cannot be looked at, is: so
/// reading it fails aloud instead of leaving it out.
bool isThere(const std::filesystem::path& file);

/// \brief 12 of ".../000012.bin"; none when the name is no number (or has more than 19 digits).
std::optional<std::uint64_t> fileNumber(const std::filesystem::path& file);
/// \brief Numbers of all files. \throws Error naming the first file that has none, or the same as
/// the one before.
std::vector<std::uint64_t> fileNumbers(const std::vector<std::filesystem::path>& files);
/// \throws Error when names are numbers that do not sort as numbers (10.bin before 2.bin).
void requirePaddedNames(const std::vector<std::filesystem::path>& files);

/// \brief "177-180, 200" of sorted numbers; at most `most` ranges, then "…".
std::string ranges(const std::vector<std::uint64_t>& numbers, std::size_t most = 8);

/// \brief How one point is stored in a file that holds nothing else.
struct PointLayout {
  std::size_t bytes = 16;
  const char* fields = "float32 x y z intensity";  ///< for messages
};

/// \brief Looks at the sizes of scans, KITTI `.bin` unless told otherwise; notes empty ones.
/// \throws Error when one is cut short, or all are empty.
void checkScanSizes(const std::vector<std::filesystem::path>& scans,
                    std::vector<std::string>& notes, const PointLayout& point = PointLayout{});

/// \throws Error "FILE:LINE: …" when a row's first number is not above that of the row before.
void requireIncreasing(const std::filesystem::path& file, const std::vector<NumberRow>& rows);

}  // namespace polemcl::io
