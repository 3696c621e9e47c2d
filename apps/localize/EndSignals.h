#pragma once
/// \file EndSignals.h
/// \brief Ctrl-C and SIGTERM as the wish to end a drive. Private to the library.

#include <csignal>

namespace polemcl::apps {

/// \brief While it lives, the first SIGINT or SIGTERM only sets a flag; a second one, of either,
/// ends the program at once. Only one at a time.
class EndSignals {
 public:
  EndSignals();
  ~EndSignals();
  EndSignals(const EndSignals&) = delete;
  EndSignals& operator=(const EndSignals&) = delete;

  /// \brief Whether one has come. From any thread.
  static bool came();

 private:
  struct sigaction m_interrupt, m_terminate;
};

}  // namespace polemcl::apps
