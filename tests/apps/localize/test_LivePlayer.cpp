#include <gtest/gtest.h>

#include <atomic>
#include <condition_variable>
#include <functional>
#include <future>
#include <mutex>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "localize/LivePlayer.h"
#include "support/LiveMoments.h"
#include "support/Scenes.h"

namespace polemcl::test_live_player {
namespace {
using apps::LivePlayer;
using report::KeyPress;
using Source = report::Playback::Source;

/// What the player does with its window, and the keys of a user.
class FakeUser {
 public:
  void press(const std::vector<KeyPress>& keys) {
    const std::lock_guard lock(m_mutex);
    m_keys.insert(m_keys.end(), keys.begin(), keys.end());
  }
  void type(char character) { press({{KeyPress::Key::character, character}}); }
  void close() { m_open = false; }
  /// Waits until the window has this title.
  void awaitTitle(const std::string& title) {
    std::unique_lock lock(m_mutex);
    m_changed.wait(lock, [&] { return m_title == title; });
  }
  /// The legend of the last picture.
  std::string legend() {
    const std::lock_guard lock(m_mutex);
    return m_legend;
  }

  class Window : public report::LiveWindow {
   public:
    Window(FakeUser& user, viz::Scene::Ptr scene) : m_user(user), m_scene(std::move(scene)) {}
    bool isOpen() const override { return m_user.m_open; }
    void update(const std::function<void()>& change, const viz::CCamera&) override {
      change();
      if (m_user.fails) throw Error("the screen is full");
      const std::lock_guard lock(m_user.m_mutex);
      m_user.m_legend = report::legendOf(m_scene);
    }
    void setTitle(const std::string& title) override {
      const std::lock_guard lock(m_user.m_mutex);
      m_user.m_title = title;
      m_user.m_changed.notify_all();
    }
    std::vector<KeyPress> takeKeys() override {
      const std::lock_guard lock(m_user.m_mutex);
      return std::exchange(m_user.m_keys, {});
    }

   private:
    FakeUser& m_user;
    viz::Scene::Ptr m_scene;
  };

  std::atomic<bool> fails{false};

 private:
  std::mutex m_mutex;
  std::condition_variable m_changed;
  std::vector<KeyPress> m_keys;
  std::string m_title, m_legend;
  std::atomic<bool> m_open{true};
};

/// A run of ten scans, 0.1 s apart, at full speed.
class LivePlayerTest : public testing::Test {
 protected:
  static constexpr std::size_t scans = 10;

  void open(Source source = Source::rawlog) {
    report::ViewOptions options;
    options.rate = "max";
    player.emplace(options, report::smallMap(), "drive", source, SequenceOptions(),
                   [&](const std::string&, unsigned, unsigned, const viz::Scene::Ptr& scene) {
                     return std::make_unique<FakeUser::Window>(user, scene);
                   });
  }
  void give(std::size_t scan) {
    report::LiveMoment moment = report::knownMoment();
    moment.scan = scan;
    moment.elapsed = 0.1 * static_cast<double>(scan);
    if (scan == 6) moment.health.state = HealthState::lost;
    player->add(moment, {{}, scans});
    ++given;
  }
  /// The rest of the run, in a thread of its own.
  std::future<void> giveFrom(std::size_t first) {
    return std::async(std::launch::async, [this, first] {
      for (std::size_t scan = first; scan < scans; ++scan) give(scan);
      player->end();
    });
  }
  void awaitWords(const std::string& words) { user.awaitTitle("pole-localize: drive: " + words); }

  FakeUser user;
  std::atomic<std::size_t> given{0};
  std::optional<LivePlayer> player;
};

TEST_F(LivePlayerTest, WithoutKeysTheRunGoesThrough) {
  open();
  EXPECT_TRUE(player->isOpen());
  EXPECT_TRUE(player->follows());
  giveFrom(0).get();
  player->wait(false);
  user.awaitTitle("pole-localize: drive");
}

TEST_F(LivePlayerTest, APausedRunWaitsAndGoesOnScanByScan) {
  open();
  give(0);
  user.type(' ');
  awaitWords("scan 0 of about 9, 0.0 s, paused");
  EXPECT_FALSE(player->follows());
  auto run = giveFrom(1);
  for (std::size_t step = 1; step <= 3; ++step) {
    user.press({{KeyPress::Key::right}});
    awaitWords("scan " + std::to_string(step) + " of about 9, 0." + std::to_string(step) +
               " s, paused");
    EXPECT_LE(given, step + 1);
  }
  EXPECT_NE(user.legend().find("time 0.3 s, scan 3\n"), std::string::npos) << user.legend();
  user.press({{KeyPress::Key::home}});
  awaitWords("scan 0 of about 9, 0.0 s, paused");
  EXPECT_LE(given, 4u);
  user.type(' ');
  run.get();
  player->wait(false);
}

TEST_F(LivePlayerTest, SeeksTroubleThatIsStillToCome) {
  open();
  give(0);
  user.type(' ');
  awaitWords("scan 0 of about 9, 0.0 s, paused");
  user.type('n');
  auto run = giveFrom(1);
  awaitWords("scan 6 of about 9, 0.6 s, paused");
  EXPECT_LE(given, 7u);
  EXPECT_NE(user.legend().find("lost"), std::string::npos);
  user.type('n');  // there is no more: the last scan, and the window stays
  awaitWords("scan 9 of 9, 0.9 s, paused");
  run.get();
  user.type('b');
  awaitWords("scan 6 of 9, 0.6 s, paused");
  user.type(' ');
  player->wait(false);
}

TEST_F(LivePlayerTest, ARunOfSensorsIsNotHeld) {
  open(Source::sensors);
  give(0);
  user.type(' ');
  awaitWords("scan 0 of about 9, 0.0 s, paused");
  giveFrom(1).get();  // nobody lets it go on
  EXPECT_EQ(given, scans);
  awaitWords("scan 0 of 9, 0.0 s, paused");
}

TEST_F(LivePlayerTest, AClosedWindowLetsTheRunGo) {
  open();
  give(0);
  user.type(' ');
  awaitWords("scan 0 of about 9, 0.0 s, paused");
  auto run = giveFrom(1);
  user.close();
  run.get();
  EXPECT_FALSE(player->isOpen());
  player->wait(true);
}

TEST_F(LivePlayerTest, WhatCannotBeDrawnEndsTheRun) {
  open();
  user.fails = true;
  give(0);
  EXPECT_THROW(player->wait(true), Error);
  EXPECT_THROW(give(1), Error);
}

}  // namespace
}  // namespace polemcl::test_live_player
