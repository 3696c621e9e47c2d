#pragma once
/// \file GrowingFile.h
/// \brief A file that is written piece by piece over a long time.

#include <filesystem>
#include <string>
#include <string_view>

namespace polemcl::io {

/// \brief The file is open only while a piece goes out, so that any number can be under way. It has
/// its name from the start: to be used in folders that become visible when they are complete.
class GrowingFile {
 public:
  static constexpr std::size_t piece = 4096;  ///< bytes collected before they go out

  /// \brief Creates the file, empty. \throws Error when that fails.
  explicit GrowingFile(std::filesystem::path file);
  /// \brief Adds to the end. \throws Error when a write failed.
  void add(std::string_view text);
  /// \brief Writes what is collected. Text that no flush() follows is lost. \throws Error as add().
  void flush();

 private:
  std::filesystem::path m_file;
  std::string m_collected;
};

}  // namespace polemcl::io
