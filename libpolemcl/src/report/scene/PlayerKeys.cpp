#include "report/scene/PlayerKeys.h"

#include <charconv>

namespace polemcl::report {
namespace {

constexpr double kShort = 10, kLong = 60;  // s
constexpr std::size_t kMostTyped = 9;

}  // namespace

std::vector<std::string> keyHelp() {
  return {"space: pause, play on",
          "left, right: a scan back, ahead",
          "up, down: 10 s ahead, back",
          "page up, page down: 60 s ahead, back",
          "home, end: the first, the newest scan",
          "digits, then enter: that time in s",
          "n, b: next, previous begin of degraded or lost",
          "p: points of the newest scan, if it has any",
          "h: this help",
          "mouse: turn (left), zoom (wheel)"};
}

void PlayerKeys::take(const KeyPress& press, Playback& playback) {
  using Key = KeyPress::Key;
  switch (press.key) {
    case Key::character:
      return takeCharacter(press.character, playback);
    case Key::left:
      return playback.step(-1);
    case Key::right:
      return playback.step(1);
    case Key::up:
      return playback.skip(kShort);
    case Key::down:
      return playback.skip(-kShort);
    case Key::pageUp:
      return playback.skip(kLong);
    case Key::pageDown:
      return playback.skip(-kLong);
    case Key::home:
      return playback.toFirst();
    case Key::end:
      return playback.toNewest();
    case Key::enter:
      return goToTyped(playback);
    case Key::escape:
      m_typed.clear(), m_help = false;
      return;
    case Key::backspace:
      if (!m_typed.empty()) m_typed.pop_back();
  }
}

void PlayerKeys::takeCharacter(char character, Playback& playback) {
  if ((character >= '0' && character <= '9') || character == '.') {
    if (m_typed.size() < kMostTyped) m_typed += character;
    return;
  }
  switch (character) {
    case ' ':
      return playback.togglePause();
    case 'n':
      return playback.toNextTrouble();
    case 'b':
      return playback.toPreviousTrouble();
    case 'p':
      m_points = !m_points;
      return;
    case 'h':
      m_help = !m_help;
      return;
    default:
      return;
  }
}

void PlayerKeys::goToTyped(Playback& playback) {
  double seconds = 0;
  const char* const end = m_typed.data() + m_typed.size();
  if (std::from_chars(m_typed.data(), end, seconds).ptr == end && !m_typed.empty())
    playback.goTo(seconds);
  m_typed.clear();
}

}  // namespace polemcl::report
