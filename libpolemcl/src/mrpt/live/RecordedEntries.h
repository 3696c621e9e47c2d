#pragma once
/// \file RecordedEntries.h
/// \brief Keeps what is taken from sensors, for a rawlog that gives the same poses.

#include <memory>
#include <string>

#include "mrpt/rawlog/EntrySource.h"
#include "mrpt/rawlog/RawlogWriter.h"

namespace polemcl {

/// \brief The entries of another source, each written to a rawlog before it is handed out: in the
/// order and with the times that the localization sees. Scans that were dropped are not among them.
class RecordedEntries : public EntrySource {
 public:
  /// \param source Of observations. \throws Error when the rawlog cannot be written.
  RecordedEntries(std::shared_ptr<EntrySource> source, const std::string& rawlog)
      : m_source(std::move(source)), m_writer(rawlog) {}

  bool next(RawlogEntry& entry) override {
    if (!m_source->next(entry)) return false;
    if (entry.observation) m_writer.write(*entry.observation);
    return true;
  }
  void stop() override { m_source->stop(); }
  bool isLive() const override { return m_source->isLive(); }
  const std::string& comment() const override { return m_source->comment(); }
  std::size_t dropped() const override { return m_source->dropped(); }

  /// \brief Gives the rawlog its name. \throws Error when a write failed.
  void commit() { m_writer.commit(); }

 private:
  std::shared_ptr<EntrySource> m_source;
  RawlogWriter m_writer;
};

}  // namespace polemcl
