#pragma once
/// \file GzReadStream.h
/// \brief Stream of MRPT over a plain or gzip file that distinguishes a clean end from a damaged
/// one.

#include <mrpt/io/CStream.h>

#include <atomic>
#include <chrono>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

struct gzFile_s;

namespace polemcl {

/// \brief Reads complete blocks or throws. (MRPT's own stream returns less than requested at the
/// end of a file, and treats a damaged gzip file as ended.) It rejects the count of a point map
/// that the rest of the file cannot hold, before MRPT allocates memory for it.
class GzReadStream : public mrpt::io::CStream {
 public:
  /// \param follow For files that still grow: how long the end is waited at for more, s. The counts
  ///        of points are not checked then.
  /// \throws Error when the file cannot be opened.
  explicit GzReadStream(const std::string& path, double follow = 0);
  ~GzReadStream() override;
  GzReadStream(const GzReadStream&) = delete;
  GzReadStream& operator=(const GzReadStream&) = delete;

  /// \brief True when no byte is left and the file ended regularly.
  /// \throws Error when it cannot be read. Damaged gzip data set cutShort() and give false.
  bool atCleanEnd();
  /// \brief The end is not waited at any more. From any thread.
  void stop() { m_isStopped = true; }
  /// \brief True after a read beyond the end, a count of points that the rest cannot hold, or
  /// damaged gzip data.
  bool cutShort() const { return m_cutShort; }
  /// \brief Fraction of the file read so far, 0 to 1; 0 while the file may grow.
  double progress() const;

  std::size_t Read(void* buffer, std::size_t count) override;
  std::size_t Write(const void* buffer, std::size_t count) override;
  std::uint64_t Seek(std::int64_t offset, TSeekOrigin origin) override;
  std::uint64_t getTotalBytesCount() const override { return m_fileSize; }
  /// \brief Number of bytes read, uncompressed.
  std::uint64_t getPosition() const override { return m_position; }
  std::string getStreamDescription() const override { return m_path; }

 private:
  bool refill();
  int readPiece(int& code);
  std::uint64_t mostLeft() const;
  std::optional<std::uint32_t> pointsIn(const void* piece, std::size_t size);

  /// What MRPT reads next of the header of a point map.
  enum class HeaderPart { length, name, version, count };
  std::string m_path;
  std::chrono::duration<double> m_follow;
  gzFile_s* m_file = nullptr;
  std::vector<unsigned char> m_buffer = std::vector<unsigned char>(1 << 18);
  std::size_t m_begin = 0, m_end = 0;  ///< part of the buffer that is not consumed yet
  HeaderPart m_next = HeaderPart::length;
  std::size_t m_nameLength = 0;
  std::uint64_t m_position = 0, m_fileSize = 0;
  bool m_cutShort = false, m_endsEarly = false;
  std::atomic<bool> m_isStopped{false};
};

}  // namespace polemcl
