#include "io/dataset/ScanFiles.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstring>

#include <polemcl/core/common/Types.h>
#include "io/file/Bytes.h"
#include "io/file/TextFile.h"

namespace polemcl::io {

namespace fs = std::filesystem;

namespace {

/// Sorts names by the numbers in them: 9 is before 10. What is alike stays in the order of bytes.
void sortByNumbers(std::vector<fs::path>& files) {
  const auto numberOf = [](const fs::path& file) { return parseNumber(file.stem().string()); };
  std::sort(files.begin(), files.end(), [](const fs::path& a, const fs::path& b) {
    return a.filename().native() < b.filename().native();
  });
  const bool isNumbered = std::all_of(files.begin(), files.end(), numberOf);
  std::stable_sort(files.begin(), files.end(), [&](const fs::path& a, const fs::path& b) {
    if (isNumbered) return *numberOf(a) < *numberOf(b);
    return strverscmp(a.stem().c_str(), b.stem().c_str()) < 0;
  });
}

constexpr std::size_t kBytesOfFive = 20;  ///< five float32

/// Whether every fifth number of a file is whole, as the number of a ring is, and others are not.
bool hasRings(const fs::path& scan) {
  const std::string bytes = readBytes(scan);
  const auto isWhole = [&](std::size_t at) {
    const auto value = loadLittleEndian<float>(bytes.data() + at);
    return value >= 0 && value < 256 && value == std::floor(value);
  };
  bool others = false;
  for (std::size_t point = 0; point < bytes.size(); point += kBytesOfFive) {
    if (!isWhole(point + 16)) return false;
    others = others || !isWhole(point);
  }
  return others;
}

/// Scans as those of nuScenes can have sizes that fit four numbers a point.
void refuseFiveNumbers(const std::vector<fs::path>& scans) {
  std::error_code ignored;
  const fs::path* some = nullptr;
  for (const fs::path& scan : scans) {
    const auto size = fs::file_size(scan, ignored);
    if (size % kBytesOfFive != 0) return;
    if (size > 0) some = &scan;
  }
  if (some && hasRings(*some))
    throw Error(some->string() +
                ": five numbers a point, the last one a ring, as in nuScenes; keep the first "
                "four, float32 x y z intensity");
}

}  // namespace

fs::path folderNamed(const fs::path& folder) {
  std::error_code ignored;
  const fs::path full = fs::absolute(folder);
  const fs::path normal = (full / "").lexically_normal().parent_path();
  // They differ where .. follows a symbolic link.
  const bool isOther = fs::exists(full, ignored) && !fs::equivalent(full, normal, ignored);
  return isOther ? fs::canonical(full) : normal;
}

std::vector<fs::path> listFiles(const fs::path& folder, const std::string& ending) {
  std::error_code error, ignored;
  std::vector<fs::path> files;
  for (auto entry = fs::directory_iterator(folderNamed(folder), error);
       !error && entry != fs::directory_iterator(); entry.increment(error)) {
    const fs::path name = entry->path().filename();
    const bool wanted = name.extension() == ending && name.native().front() != '.';
    // A broken link is listed too, so that reading it fails with an error.
    if (wanted && !entry->is_directory(ignored)) files.push_back(entry->path());
  }
  if (error) throw Error("cannot read the folder " + folder.string() + ": " + error.message());
  if (files.empty()) throw Error(folder.string() + ": no *" + ending + " file in it");
  sortByNumbers(files);
  return files;
}

bool isThere(const fs::path& file) {
  std::error_code ignored;
  return fs::symlink_status(file, ignored).type() != fs::file_type::not_found;
}

fs::path existing(const fs::path& file) {
  if (isThere(file)) return file;
  const fs::path packed = file.string() + ".gz";
  return file.extension() == ".csv" && isThere(packed) ? packed : fs::path();
}

std::optional<std::uint64_t> fileNumber(const fs::path& file) {
  const std::string stem = file.stem().string();
  std::uint64_t number = 0;
  if (stem.size() > 19) return std::nullopt;
  const auto result = std::from_chars(stem.data(), stem.data() + stem.size(), number);
  if (result.ec != std::errc() || result.ptr != stem.data() + stem.size()) return std::nullopt;
  return number;
}

std::vector<std::uint64_t> fileNumbers(const std::vector<fs::path>& files) {
  std::vector<std::uint64_t> numbers;
  for (const fs::path& file : files) {
    const auto number = fileNumber(file);
    if (!number) {
      throw Error(file.string() + ": the name is not a frame number; names like 000012" +
                  file.extension().string() + " are expected here");
    }
    if (!numbers.empty() && *number == numbers.back()) {
      throw Error(file.string() + ": frame " + std::to_string(*number) + " is there twice");
    }
    numbers.push_back(*number);
  }
  return numbers;
}

std::string ranges(const std::vector<std::uint64_t>& numbers, std::size_t most) {
  std::string text;
  std::size_t count = 0;
  for (std::size_t i = 0; i < numbers.size(); ++count) {
    if (count > 0) text += ", ";
    if (count == most) return text + "…";
    std::size_t last = i;
    while (last + 1 < numbers.size() && numbers[last + 1] == numbers[last] + 1) ++last;
    text += std::to_string(numbers[i]);
    if (last > i) text += "-" + std::to_string(numbers[last]);
    i = last + 1;
  }
  return text;
}

void checkScanSizes(const std::vector<fs::path>& scans, std::vector<std::string>& notes,
                    const PointLayout& point) {
  if (point.bytes == PointLayout().bytes) refuseFiveNumbers(scans);
  std::vector<fs::path> empty;
  for (const fs::path& scan : scans) {
    std::error_code error;
    const auto size = fs::file_size(scan, error);
    if (error) throw Error("cannot read " + scan.string() + ": " + error.message());
    if (size % point.bytes != 0) {
      throw Error(scan.string() + ": cut short: " + std::to_string(size) +
                  " bytes are not a multiple of " + std::to_string(point.bytes) + " (" +
                  point.fields + " a point)");
    }
    if (size == 0) empty.push_back(scan);
  }
  if (empty.size() == scans.size()) {
    throw Error(scans.front().parent_path().string() + ": no usable scan: all " +
                std::to_string(scans.size()) + " are empty");
  }
  if (!empty.empty()) {
    notes.push_back(std::to_string(empty.size()) + " of " + std::to_string(scans.size()) +
                    " scans are empty, the first is " + empty.front().filename().string());
  }
}

void requireIncreasing(const fs::path& file, const std::vector<NumberRow>& rows) {
  for (std::size_t i = 1; i < rows.size(); ++i) {
    const double before = rows[i - 1].values[0], time = rows[i].values[0];
    if (!(time > before)) {
      throw Error(at(file, rows[i].line) + "time " + significant(time, 17) + " is not after " +
                  significant(before, 17) + ", the one before");
    }
  }
}

}  // namespace polemcl::io
