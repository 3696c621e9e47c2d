#pragma once
/// \file GrowingFile.h
/// \brief A file that is written in pieces over a long time.

#include <filesystem>
#include <string>
#include <string_view>

namespace polemcl::io {

/// \brief The file is open only while a piece is written, so that any number of files can be in
/// progress. It has its final name from the start: use it in folders that become visible when
/// complete.
class GrowingFile {
 public:
  static constexpr std::size_t kPiece = 4096;  ///< bytes collected before a write

  /// \brief Creates an empty file. \throws Error when that fails.
  explicit GrowingFile(std::filesystem::path file);
  /// \brief Appends text. \throws Error when a write failed.
  void add(std::string_view text);
  /// \brief Writes the collected text. Text after the last flush() is lost. \throws Error as add().
  void flush();

 private:
  std::filesystem::path m_file;
  std::string m_collected;
};

}  // namespace polemcl::io
