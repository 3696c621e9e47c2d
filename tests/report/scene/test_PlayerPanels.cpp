#include <gtest/gtest.h>

#include "report/scene/LiveObjects.h"
#include "report/scene/LiveScene.h"
#include "report/scene/PlayerKeys.h"
#include "report/scene/PlayerPanels.h"
#include "support/ExpectHas.h"
#include "support/LiveMoments.h"
#include "support/Scenes.h"

namespace polemcl::report::test_player_panels {
namespace {
constexpr HealthState ok = HealthState::ok, degraded = HealthState::degraded,
                      lost = HealthState::lost;

/// All texts of a panel.
std::string textOf(const viz::Scene::Ptr& scene, const char* panel) {
  std::string all;
  for (const auto& [index, text] : scene->getViewport(panel)->getTextMessages().messages)
    all += text.text + "\n";
  return all;
}

/// Number of faces of the panel `player` that have this colour.
int facesOf(const viz::Scene::Ptr& scene, const scene::TColor& color) {
  const auto shapes = std::dynamic_pointer_cast<viz::CSetOfTriangles>(
      scene->getViewport("player")->getByName("shapes"));
  int count = 0;
  for (std::size_t i = 0; i < shapes->getTrianglesCount(); ++i) {
    viz::TTriangle face;
    shapes->getTriangle(i, face);
    count += face.vertices[0].xyzrgba.r == color.R && face.vertices[0].xyzrgba.g == color.G &&
             face.vertices[0].xyzrgba.b == color.B;
  }
  return count;
}

TEST(TimeLine, ReachesToTheEndOfTheRunAndHoldsTheWorstOfEachColumn) {
  Playback playback(Playback::Source::rawlog);
  std::vector<float> errors;
  for (int i = 0; i <= 1000; ++i) {  // 10 columns a second, each of ten scans
    playback.add(0.01 * i, i == 123 ? lost : i < 500 ? ok : degraded);
    errors.push_back(i == 123 ? 0.5f : i < 200 ? 0.1f : -1.0f);
  }
  playback.step(250);
  const TimeLine line = makeTimeLine(playback, errors, 5001);
  EXPECT_NEAR(line.length, 50, 1e-9);
  EXPECT_NEAR(line.shown, 0.05, 1e-9);
  ASSERT_EQ(line.columns.size(), 500u);
  EXPECT_EQ(line.columns[11].state, ok);
  EXPECT_EQ(line.columns[12].state, lost);
  EXPECT_NEAR(*line.columns[12].error, 0.5, 1e-6);
  EXPECT_NEAR(*line.columns[13].error, 0.1, 1e-6);
  EXPECT_FALSE(line.columns[20].error);
  EXPECT_EQ(line.columns[50].state, degraded);
  EXPECT_TRUE(line.columns[100].state);
  EXPECT_FALSE(line.columns[101].state);  // not made yet
  EXPECT_NEAR(line.limit, 0.22, 1e-6);    // 2.2 times the 95th percentile
}

TEST(TimeLine, FewScansFillTheirColumns) {
  Playback playback(Playback::Source::rawlog);
  for (int i = 0; i < 5; ++i) playback.add(i, i == 2 ? degraded : ok);
  const TimeLine line = makeTimeLine(playback, {-1, -1, -1, -1, -1}, 0);
  EXPECT_EQ(line.length, 4);
  EXPECT_EQ(line.limit, 0);
  std::size_t yellow = 0;
  for (const auto& column : line.columns) {
    ASSERT_TRUE(column.state);
    yellow += column.state == degraded;
  }
  EXPECT_EQ(yellow, 125u);  // one of four seconds
}

TEST(TimeLine, TheWordsTellScanTimeAndWhetherItStandsStill) {
  Playback playback(Playback::Source::rawlog);
  for (int i = 0; i < 5; ++i) playback.add(0.1 * i, ok);
  EXPECT_EQ(describe(playback, 240), "scan 0 of about 239, 0.0 s");
  playback.step(3);
  EXPECT_EQ(describe(playback, 0), "scan 3 of 4 so far, 0.3 s, paused");
  playback.goTo(50);
  EXPECT_EQ(describe(playback, 240), "scan 3 of about 239, 0.3 s, seeking: at 0.4 s");
  playback.end();
  EXPECT_EQ(describe(playback, 240), "scan 4 of 4, 0.4 s, paused");
}

TEST(PlayerPanels, ShowHealthErrorsAndTimes) {
  LiveScene live(smallMap(), "drive");
  live.show(knownMoment());
  Playback playback(Playback::Source::rawlog);
  for (int i = 0; i < 50; ++i) playback.add(i, i < 10 ? lost : i < 20 ? degraded : ok);
  showTimeLine(*live.scene(), makeTimeLine(playback, std::vector<float>(50, -1), 0), "the words");
  const std::string words = textOf(live.scene(), "player");
  for (const char* part : {"the words", "h: help", "0 s", "40 s"})
    EXPECT_NE(words.find(part), std::string::npos) << part << " is not in:\n" << words;
  EXPECT_EQ(words.find("error"), std::string::npos);
  for (const HealthState state : {ok, degraded, lost})
    EXPECT_EQ(facesOf(live.scene(), live::pathColorOf(state)), 2) << name(state);
  EXPECT_EQ(facesOf(live.scene(), scene::truthColor), 2 * 10);  // the marks of 0, 5, ... 45 s

  showTimeLine(*live.scene(), makeTimeLine(playback, std::vector<float>(50, 0.3f), 0), "");
  EXPECT_HAS(textOf(live.scene(), "player"), "error of the position; line: 0.3 m");
  EXPECT_EQ(facesOf(live.scene(), scene::truthColor), 2 * (10 + 500));  // and the curve
}

TEST(PlayerPanels, HelpComesAndGoes) {
  LiveScene live(smallMap(), "drive");
  live.show(knownMoment());
  showKeys(*live.scene(), keyHelp(), true);
  EXPECT_NE(textOf(live.scene(), "help").find("space: pause"), std::string::npos);
  EXPECT_NE(legendOf(live.scene()).find("drive"), std::string::npos);  // that one stays
  showKeys(*live.scene(), {}, true);
  EXPECT_EQ(textOf(live.scene(), "help"), "");
}

}  // namespace
}  // namespace polemcl::report::test_player_panels
