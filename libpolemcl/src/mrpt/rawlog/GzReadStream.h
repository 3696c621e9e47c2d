#pragma once
/// \file GzReadStream.h
/// \brief A stream of MRPT over a plain or gzip file that knows how it ended.

#include <mrpt/io/CStream.h>

#include <cstdint>
#include <memory>
#include <string>

namespace polemcl {

/// \brief Reads whole pieces or throws. MRPT's own stream hands out less than was asked for at the
/// end of a file, and calls a damaged gzip file ended. Refuses the count of a map of points that
/// the rest of the file cannot hold, before MRPT takes memory for it.
class GzReadStream : public mrpt::io::CStream {
 public:
  /// \throws Error when the file cannot be opened.
  explicit GzReadStream(const std::string& path);
  ~GzReadStream() override;

  /// \brief True when no byte is left, and the file ended as it should.
  /// \throws Error when it cannot be read; damaged gzip data sets cutShort() and is no clean end.
  bool atCleanEnd();
  /// \brief True after a read that found fewer bytes than asked for, a count of points that the
  /// rest cannot hold, or damaged gzip data.
  bool cutShort() const { return m_cutShort; }
  /// \brief Share of the file consumed, 0 to 1.
  double progress() const;

  std::size_t Read(void* buffer, std::size_t count) override;
  std::size_t Write(const void* buffer, std::size_t count) override;
  std::uint64_t Seek(std::int64_t offset, TSeekOrigin origin) override;
  std::uint64_t getTotalBytesCount() const override { return m_fileSize; }
  /// \brief Bytes read, uncompressed.
  std::uint64_t getPosition() const override { return m_position; }
  std::string getStreamDescription() const override { return m_path; }

 private:
  struct Impl;
  bool refill();
  std::uint64_t mostLeft() const;
  std::string m_path;
  std::unique_ptr<Impl> m_impl;
  std::uint64_t m_position = 0, m_fileSize = 0;
  bool m_cutShort = false;
};

}  // namespace polemcl
