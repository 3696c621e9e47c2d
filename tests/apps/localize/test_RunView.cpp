#include <mrpt/img/CImage.h>
#include <mrpt/opengl/COpenGLScene.h>

#include "localize/FilterRuns.h"
#include "localize/RunView.h"
#include "support/PoleStreet.h"
#include "support/Refusal.h"
#include "support/TempFolder.h"

namespace polemcl::test_run_view {
namespace {

using namespace polemcl::apps;
using namespace testing_apps;

constexpr int scans = 12;
using Names = std::vector<std::string>;
using Updates = std::vector<LocalizationUpdate>;

class RunViewTest : public testing::Test {
 protected:
  RunViewTest() {
    tests::StreetOptions wanted;
    wanted.scans = scans;
    street = tests::makeStreet(wanted);
    view.width = 320;
    view.height = 240;
    localization.filter.particles = 50;
  }
  /// Two runs, the first of them watched. \return What it found.
  Updates run() {
    RunFolder results(folder / "out");
    RunView watched(view, {street.map->poles(), "drive"}, results);
    const Updates done = play(watched);
    watched.finish();
    writeText(results.staged("summary.json"), "done");
    results.commit();
    return done;
  }
  Updates play(RunView& watched) {
    SettingsValues settings;
    settings.localization = localization;
    settings.start.pose = street.truth[0];
    settings.runs.runs = 2;
    FilterRuns runs({street.map}, settings);
    Updates done;
    for (const PoleScan& frame : street.frames) {
      done.push_back(runs.step(frame)[0].update);
      watched.show(runs.localization(0), frame, done.back());
    }
    return done;
  }

  TempFolder folder;
  tests::PoleStreet street;
  LocalizationOptions localization;
  report::ViewOptions view;
};

TEST_F(RunViewTest, WithoutAnythingToShowNothingIsWritten) {
  run();
  EXPECT_EQ(names(folder / "out"), Names({"summary.json"}));
  RunFolder results(folder / "out");
  EXPECT_FALSE(RunView(view, {street.map->poles(), "drive"}, results).isOpen());
}

TEST_F(RunViewTest, WritesFramesEverySoManyScans) {
  view.frames = (folder / "frames").string();
  view.frameEvery = 5;
  run();
  EXPECT_EQ(names(folder / "frames"), Names({"000000.png", "000005.png", "000010.png"}));
  mrpt::img::CImage image;
  ASSERT_TRUE(image.loadFromFile((folder / "frames/000010.png").string()));
  EXPECT_EQ(image.getWidth(), 320u);
  EXPECT_EQ(image.getHeight(), 240u);
  EXPECT_EQ(names(folder.path()), Names({"frames", "out"}));  // nothing temporary stays
}

TEST_F(RunViewTest, FramesOfAnEarlierRunDoNotStay) {
  view.frames = (folder / "frames").string();
  view.frameEvery = 4;
  run();
  view.frameEvery = 11;
  run();
  EXPECT_EQ(names(folder / "frames"), Names({"000000.png", "000011.png"}));
}

TEST_F(RunViewTest, RefusesAFolderWithOtherThings) {
  writeText(folder / "frames/000000.png", "a picture");
  writeText(folder / "frames/mine.txt", "mine");
  view.frames = (folder / "frames").string();
  EXPECT_REFUSED(run(), "mine.txt");
  EXPECT_EQ(names(folder / "frames"), Names({"000000.png", "mine.txt"}));
}

TEST_F(RunViewTest, WritesScenesIntoTheRunFolderInPlaceOfOldOnes) {
  view.scenes = 4;
  run();
  EXPECT_EQ(names(folder / "out/run_00_scenes"),
            Names({"000000.3Dscene", "000004.3Dscene", "000008.3Dscene"}));
  mrpt::opengl::COpenGLScene scene;
  ASSERT_TRUE(scene.loadFromFile((folder / "out/run_00_scenes/000008.3Dscene").string()));
  for (const char* name : {"map", "vehicle", "particles"})
    EXPECT_TRUE(scene.getViewport()->getByName(name)) << name;
  view.scenes = 10;
  run();
  EXPECT_EQ(names(folder / "out/run_00_scenes"), Names({"000000.3Dscene", "000010.3Dscene"}));
  view.scenes = 0;
  run();
  EXPECT_EQ(names(folder / "out"), Names({"summary.json"}));
}

TEST_F(RunViewTest, WatchingChangesNothing) {
  const auto alone = run();
  view.frames = (folder / "frames").string();
  view.scenes = 3;
  const auto watched = run();
  ASSERT_EQ(watched.size(), alone.size());
  for (std::size_t k = 0; k < alone.size(); ++k) {
    EXPECT_EQ(watched[k].estimate->mean.x, alone[k].estimate->mean.x);
    EXPECT_EQ(watched[k].estimate->covariance, alone[k].estimate->covariance);
  }
}

TEST_F(RunViewTest, AFrameThatCannotBeWrittenEndsTheRun) {
  view.frames = (folder / "frames").string();
  view.width = 160, view.height = 160;
  RunFolder results(folder / "out");
  RunView watched(view, {street.map->poles(), "drive"}, results);
  for (const auto& name : names(folder.path()))  // the folder under its temporary name
    if (name.rfind("frames", 0) == 0) fs::remove_all(folder / name);
  const std::string message = messageOf([&] {
    play(watched);
    watched.finish();
  });
  EXPECT_HAS(message, "000000.png");  // not only the folder that is missing at the end
}

}  // namespace
}  // namespace polemcl::test_run_view
