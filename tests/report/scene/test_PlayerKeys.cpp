#include <gtest/gtest.h>

#include "report/scene/PlayerKeys.h"

namespace polemcl::report::test_player_keys {
namespace {
using Key = KeyPress::Key;

/// A run of 300 scans, 1 s apart, paused at scan 100; scan 150 is lost.
class PlayerKeysTest : public testing::Test {
 protected:
  PlayerKeysTest() {
    for (int i = 0; i < 300; ++i) playback.add(i, i == 150 ? HealthState::lost : HealthState::ok);
    playback.step(100);
  }
  void press(Key key) { keys.take({key, 0}, playback); }
  void type(const std::string& text) {
    for (const char character : text) keys.take({Key::character, character}, playback);
  }

  Playback playback{Playback::Source::rawlog};
  PlayerKeys keys;
};

TEST_F(PlayerKeysTest, MoveThePosition) {
  const std::vector<std::pair<Key, std::size_t>> moves{
      {Key::right, 101},  {Key::left, 100},     {Key::up, 110},  {Key::down, 100},
      {Key::pageUp, 160}, {Key::pageDown, 100}, {Key::end, 299}, {Key::home, 0}};
  for (const auto& [key, position] : moves) {
    press(key);
    EXPECT_EQ(playback.position(), position) << static_cast<int>(key);
  }
  type("n");
  EXPECT_EQ(playback.position(), 150u);
  press(Key::end);
  type("b");
  EXPECT_EQ(playback.position(), 150u);
  type(" ");
  EXPECT_FALSE(playback.isPaused());
}

TEST_F(PlayerKeysTest, ATimeIsTyped) {
  type("12.5");
  EXPECT_EQ(keys.typed(), "12.5");
  EXPECT_EQ(playback.position(), 100u);
  press(Key::enter);
  EXPECT_EQ(playback.position(), 13u);
  EXPECT_EQ(keys.typed(), "");
  type("29");
  press(Key::backspace);
  press(Key::enter);
  EXPECT_EQ(playback.position(), 2u);
  type("7");
  press(Key::escape);
  EXPECT_EQ(keys.typed(), "");
  press(Key::enter);
  press(Key::backspace);
  EXPECT_EQ(playback.position(), 2u);
}

TEST_F(PlayerKeysTest, WhatIsNoTimeGoesNowhere) {
  for (const char* text : {"1.2.3", ".", "12.."}) {
    type(text);
    press(Key::enter);
    EXPECT_EQ(playback.position(), 100u) << text;
  }
  type("1234567890123");
  EXPECT_EQ(keys.typed(), "123456789");
}

TEST_F(PlayerKeysTest, SwitchHelpAndPoints) {
  EXPECT_FALSE(keys.showsHelp());
  EXPECT_FALSE(keys.showsPoints());
  type("hp");
  EXPECT_TRUE(keys.showsHelp());
  EXPECT_TRUE(keys.showsPoints());
  press(Key::escape);
  type("pxyz");
  EXPECT_FALSE(keys.showsHelp());
  EXPECT_FALSE(keys.showsPoints());
  EXPECT_EQ(playback.position(), 100u);
}

}  // namespace
}  // namespace polemcl::report::test_player_keys
