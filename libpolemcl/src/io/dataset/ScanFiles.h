#pragma once
/// \file ScanFiles.h
/// \brief Shared by the readers of dataset folders: sorted files, their numbers, checks.

#include <cstdint>

#include "io/dataset/ScanFolder.h"
#include "io/file/TextFile.h"

namespace polemcl::io {

/// \brief Absolute paths of the files in a folder with this extension, sorted by the numbers in
/// their names: 2.bin is before 10.bin. Hidden files are left out. \throws Error when the folder
/// does not exist or has no such file.
std::vector<std::filesystem::path> listFiles(const std::filesystem::path& folder,
                                             const std::string& ending);

/// \brief The absolute path of a folder, without `.`, `..` and a slash at its end, so that its name
/// and the folder that holds it can be told.
std::filesystem::path folderNamed(const std::filesystem::path& folder);

/// \brief Whether an optional file exists. A broken link and an inaccessible file count as
/// existing: reading them then fails with an error instead of skipping the file.
bool isThere(const std::filesystem::path& file);
/// \brief The file; where only NAME.csv.gz is there for NAME.csv, that one. \return Empty if there
/// is none.
std::filesystem::path existing(const std::filesystem::path& file);

/// \brief 12 for ".../000012.bin"; nullopt if the name is not a number (or has more than 19
/// digits).
std::optional<std::uint64_t> fileNumber(const std::filesystem::path& file);
/// \brief Numbers of all files. \throws Error with the first file whose name is not a number or
/// repeats the previous number.
std::vector<std::uint64_t> fileNumbers(const std::vector<std::filesystem::path>& files);

/// \brief Sorted numbers as text, "177-180, 200"; at most `most` ranges, then "…".
std::string ranges(const std::vector<std::uint64_t>& numbers, std::size_t most = 8);

/// \brief Storage of one point in a file of points only.
struct PointLayout {
  std::size_t bytes = 16;
  const char* fields = "float32 x y z intensity";  ///< for messages
};

/// \brief Checks the sizes of scans (KITTI `.bin` by default) and adds a note about empty ones.
/// \throws Error when a scan is truncated, or has five numbers a point where four are expected, or
///         all are empty.
void checkScanSizes(const std::vector<std::filesystem::path>& scans,
                    std::vector<std::string>& notes, const PointLayout& point = PointLayout{});

/// \throws Error "FILE:LINE: …" when the first number of a row is not above that of the previous
///         row.
void requireIncreasing(const std::filesystem::path& file, const std::vector<NumberRow>& rows);

}  // namespace polemcl::io
