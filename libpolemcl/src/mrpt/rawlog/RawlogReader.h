#pragma once
/// \file RawlogReader.h
/// \brief Reads rawlogs entry by entry and reports damage. (MRPT's reader treats damage as the end
/// of the file.)

#include <optional>
#include <string>

#include <polemcl/core/common/Types.h>
#include "mrpt/rawlog/EntrySource.h"
#include "mrpt/rawlog/GzReadStream.h"

namespace polemcl {

/// \brief Streams a plain or gzip rawlog with action and frame pairs or single observations.
/// Other objects are skipped.
class RawlogReader : public EntrySource {
 public:
  /// \param allowTruncated true: a file that ends inside an object is read up to that object.
  /// \param follow How long the end of a file that still grows is waited at for more, s.
  /// \throws Error when the file cannot be opened.
  explicit RawlogReader(const std::string& path, bool allowTruncated = false, double follow = 0);

  /// \return false at the end of the file.
  /// \throws Error on a class that is not registered (with its name), on an unreadable object, and
  ///         on a file that is empty or ends inside an object (with the byte; unless allowed). A
  ///         plain file cut between two objects cannot be distinguished from a complete one.
  bool next(RawlogEntry& entry) override;
  void stop() override { m_stream.stop(); }
  /// \brief Text of the comments read so far; those of RawlogWriter and of RawlogViewer come first.
  /// Comments with which it would be longer than 1 MB are left out.
  const std::string& comment() const override { return m_comment; }
  /// \brief True when the file is truncated and this was allowed.
  bool truncated() const override { return m_truncated; }
  /// \brief Fraction of the file read so far, 0 to 1, for progress.
  double progress() const override { return m_stream.progress(); }

 private:
  struct Object {
    mrpt::serialization::CSerializable::Ptr object;
    std::uint64_t offset = 0;
  };
  std::size_t mostAtATime() const;
  std::optional<Object> readObject();
  std::optional<Object> nextObject();
  void endsHere(std::uint64_t offset);
  [[noreturn]] void explain(std::uint64_t offset, const std::string& what);

  std::string m_name;
  GzReadStream m_stream;
  bool m_allowTruncated, m_growing, m_truncated = false, m_ended = false;
  std::optional<Object> m_pending;  ///< object after an action, read ahead
  std::string m_comment;
  std::uint64_t m_objects = 0;  ///< number of objects read so far
};

}  // namespace polemcl
