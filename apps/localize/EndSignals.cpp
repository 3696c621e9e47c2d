#include "localize/EndSignals.h"

#include <atomic>

namespace polemcl::apps {
namespace {

std::atomic<bool> s_came{false};
static_assert(std::atomic<bool>::is_always_lock_free, "set by a signal handler");

void note(int) {
  s_came = true;
  std::signal(SIGINT, SIG_DFL);
  std::signal(SIGTERM, SIG_DFL);
}

}  // namespace

EndSignals::EndSignals() {
  s_came = false;
  struct sigaction action {};
  action.sa_handler = note;
  action.sa_flags = SA_RESTART;
  sigaction(SIGINT, &action, &m_interrupt);
  sigaction(SIGTERM, &action, &m_terminate);
}

EndSignals::~EndSignals() {
  sigaction(SIGINT, &m_interrupt, nullptr);
  sigaction(SIGTERM, &m_terminate, nullptr);
}

bool EndSignals::came() {
  return s_came;
}

}  // namespace polemcl::apps
