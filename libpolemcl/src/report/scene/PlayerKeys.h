#pragma once
/// \file PlayerKeys.h
/// \brief The keys of the live view, and what each of them does.

#include <string>
#include <vector>

#include "report/scene/Playback.h"

namespace polemcl::report {

/// \brief A key that was pressed, from whatever window.
struct KeyPress {
  enum class Key {
    character,
    left,
    right,
    up,
    down,
    pageUp,
    pageDown,
    home,
    end,
    enter,
    escape,
    backspace
  };
  Key key = Key::character;
  char character = 0;  ///< of Key::character, in lower case
};

/// \brief What the keys have set, beside the position.
class PlayerKeys {
 public:
  /// \brief Does what the key stands for; other keys do nothing.
  void take(const KeyPress& press, Playback& playback);
  bool showsHelp() const { return m_help; }
  bool showsPoints() const { return m_points; }
  /// \brief The time to go to, as far as it has been typed.
  const std::string& typed() const { return m_typed; }

 private:
  void takeCharacter(char character, Playback& playback);
  void goToTyped(Playback& playback);

  bool m_help = false, m_points = false;
  std::string m_typed;
};

/// \brief A line for each key: `space: pause, play on`.
std::vector<std::string> keyHelp();

}  // namespace polemcl::report
