#include <gtest/gtest.h>

#include "batch/BatchSpec.h"
#include "support/BatchTestFiles.h"

namespace polemcl::test_batch_spec {
namespace {

using namespace polemcl::apps;
using namespace testing_apps;

BatchSpec read(const std::string& text, const fs::path& data = {}) {
  const TempFolder folder;
  writeText(folder / "a.ini", text);
  return readBatchSpec(folder / "a.ini", data);
}

std::string refusal(const std::string& text) {
  return messageOf([&] { read(text); });
}

const std::string sessions = "[sessions]\nnames = a b c\ninput = x\n";
const std::string configuration = "[setting one]\nconfig = c.ini\n";

TEST(BatchSpec, ReadsSessionsWithTheirDifferences) {
  const BatchSpec spec = read(
      "[batch]\nname = n-1\ntitle = A b\nruns = 3\nseed = 9\nerrors = metre\nsettings = one\n"
      "[sessions]\nnames = a b\nsource = nclt\ninput = {data}/s/{session}\ndate = "
      "2012-01-08\n"
      "odometry_noise = 0.02\n"
      "[session b]\ninput = other/{session}.ini\nsource = simulated\nset = world.day=3 "
      "world.seed=4\nodometry_noise = 0\n"
      "[setting one]\nconfig = c.ini\nset = filter.particles=5\nsessions = b\nmaps = upkeep\n"
      "poses = estimate\n",
      "/d");
  EXPECT_EQ(spec.name, "n-1");
  EXPECT_EQ(spec.runs, 3);
  EXPECT_EQ(spec.seed, 9u);
  EXPECT_TRUE(spec.perMetre);
  ASSERT_EQ(spec.sessions.size(), 2u);
  EXPECT_EQ(spec.session("a").input, "/d/s/a");
  EXPECT_EQ(spec.session("a").source, "nclt");
  EXPECT_EQ(spec.session("a").date, "2012-01-08");
  EXPECT_EQ(spec.session("a").odometryNoise, 0.02);
  EXPECT_EQ(spec.session("b").odometryNoise, 0);
  EXPECT_EQ(spec.session("b").date, "2012-01-08");
  EXPECT_EQ(spec.session("b").set, (std::vector<std::string>{"world.day=3", "world.seed=4"}));
  EXPECT_EQ(fs::path(spec.session("b").input).filename(), "b.ini");
  EXPECT_EQ(fs::path(spec.session("b").input).parent_path().filename(), "other");
  ASSERT_EQ(spec.configurations.size(), 1u);
  EXPECT_EQ(spec.configurations[0].mapSessions, std::vector<std::string>{"a"});
  EXPECT_EQ(spec.configurations[0].sessions, std::vector<std::string>{"b"});
  EXPECT_EQ(spec.configurations[0].protocol, MapProtocol::upkeep);
  EXPECT_EQ(spec.configurations[0].poses, MapPoses::estimate);
  EXPECT_EQ(spec.configurations[0].map, MapTime::before);
}

TEST(BatchSpec, SessionsOfAConfigurationComeInTheOrderOfTheBatch) {
  const auto spec = read("[batch]\nsettings = one\n" + sessions + configuration +
                         "map_sessions = b a\nsessions = c b\n");
  EXPECT_EQ(spec.configurations[0].mapSessions, (std::vector<std::string>{"a", "b"}));
  EXPECT_EQ(spec.configurations[0].sessions, (std::vector<std::string>{"b", "c"}));
}

TEST(BatchSpec, NamesWhatIsWrong) {
  const std::string head = "[batch]\nsettings = one\n";
  EXPECT_HAS(refusal("[batch]\nsettings =\n" + sessions), "[batch] settings: at least one name");
  EXPECT_HAS(refusal("[batch]\nsettings = one one\n" + sessions + configuration),
             "'one' is given twice");
  EXPECT_HAS(refusal(head + "[sessions]\nnames = a a\ninput = x\n" + configuration),
             "'a' is given twice");
  EXPECT_HAS(refusal(head + "[sessions]\nnames = a/b\ninput = x\n" + configuration),
             "'a/b' is no name");
  EXPECT_HAS(refusal(head + "[sessions]\nnames = a.b\ninput = x\n" + configuration),
             "'a.b' is no name");
  EXPECT_HAS(refusal(head + sessions + "date = 2026-13-01\n" + configuration),
             "session a: date: '2026-13-01' is not a date");
  EXPECT_HAS(refusal(head + sessions + "date = 2026-02-01\n[session b]\ndate = 2026-01-31\n" +
                     configuration + "map_sessions = all\nsessions = c\nmaps = upkeep\n"),
             "session b of 2026-01-31 comes after one of 2026-02-01");
  const std::string estimates = configuration + "poses = estimate\nmap_sessions = all\n";
  EXPECT_HAS(refusal(head + sessions + estimates + "sessions = later\n"), "needs maps = upkeep");
  EXPECT_HAS(refusal(head + sessions + estimates + "sessions = c\nmaps = upkeep\n"),
             "session b updates the map but is not localized");
  EXPECT_HAS(refusal(head + "[sessions]\nnames = a\n" + configuration),
             "session a: input is missing");
  EXPECT_HAS(refusal(head + sessions), "config is missing");
  EXPECT_HAS(refusal(head + sessions + configuration + "sessions = d\n"), "no session 'd'");
  EXPECT_HAS(refusal(head + sessions + configuration + "sessions = b d\n"), "no session 'd'");
  EXPECT_HAS(refusal(head + sessions + configuration + "[session d]\ninput = y\n"),
             "[session d] is not known");
  EXPECT_HAS(refusal(head + sessions + configuration + "mapps = upkeep\n"), "mapps");
  EXPECT_HAS(refusal(head + sessions + configuration + "[setting two]\nconfig = c\n"),
             "[setting two] is not known");
  EXPECT_HAS(refusal(head + "[sessions]\nnames = a\ninput = {data}/x\n" + configuration), "--data");
  EXPECT_HAS(
      refusal(head + "[sessions]\nnames = a b\ninput = x\nset = world.day=1\n" + configuration),
      "simulated");
}

TEST(BatchSpec, ASessionInTheMapBeforeItNeedsOne) {
  const std::string head = "[batch]\nsettings = one\n" + sessions + configuration;
  EXPECT_HAS(refusal(head + "map_sessions = b\nsessions = all\n"),
             "session a has no map session before it");
  EXPECT_HAS(refusal(head + "map_sessions = b\nsessions = b c\n"),
             "session b has no map session before it");
  EXPECT_NO_THROW(read(head + "map_sessions = b\nsessions = c\n"));
  EXPECT_NO_THROW(read(head + "map_sessions = b\nsessions = all\nmap = finished\n"));
}

TEST(BatchSpec, ReadsTruePolesAndPublishedFigures) {
  const BatchSpec spec = read(
      "[batch]\nsettings = one\npublished = semantickitti\npublished_sessions = {here}/p.csv\n"
      "[sessions]\nnames = 00 01\nsource = kitti-odometry\ninput = {data}/{session}\n"
      "truth_map = labels\n[session 01]\ntruth_map = {data}/t_{session}.npz\n" +
          configuration + "maps = each\nmap_sessions = all\nsessions = none\n",
      "/d");
  EXPECT_EQ(spec.session("00").truthMap, truthFromLabels);
  EXPECT_EQ(spec.session("01").truthMap, "/d/t_01.npz");
  EXPECT_EQ(spec.published, "semantickitti");
  EXPECT_EQ(fs::path(spec.publishedSessions).filename(), "p.csv");
  EXPECT_EQ(spec.configurations[0].protocol, MapProtocol::each);
  EXPECT_TRUE(spec.configurations[0].sessions.empty());
  EXPECT_EQ(spec.configurations[0].mapSessions, (std::vector<std::string>{"00", "01"}));
}

TEST(BatchSpec, LaterSessionsAreAllButTheFirst) {
  const auto spec =
      read("[batch]\nsettings = one\n" + sessions + configuration + "sessions = later\n");
  EXPECT_EQ(spec.configurations[0].sessions, (std::vector<std::string>{"b", "c"}));
  EXPECT_HAS(
      refusal("[batch]\nsettings = one\n[sessions]\nnames = a\ninput = x\n" + configuration +
              "sessions = later\n"),
      "[setting one] sessions = later: two sessions or more are needed, [sessions] names has "
      "only a; ");
}

TEST(BatchSpec, InstalledFilesAreFoundByTheirNames) {
  const TempFolder folder;
  // Called as the settings that it names.
  writeText(folder / "hdl32e.ini",
            "[batch]\nsettings = a b own\npublished_sessions = nclt-table3.csv\n"
            "[sessions]\nnames = s t\nsource = simulated\ninput = config/hdl32e.ini\n"
            "[session t]\ninput = street.ini\n"
            "[setting a]\nconfig = hdl32e.ini\nsessions = t\n"
            "[setting b]\nconfig = config/paper/nclt.ini\nsessions = t\n"
            "[setting own]\nconfig = nclt.ini\nsessions = t\n");
  writeText(folder / "nclt.ini", "");
  const BatchSpec spec = readBatchSpec(folder / "hdl32e.ini");
  const auto same = [](const fs::path& file, const std::string& inSource) {
    return fs::equivalent(file, fs::path(POLEMCL_SOURCE_DIR) / inSource);
  };
  EXPECT_EQ(spec.file, folder / "hdl32e.ini");
  EXPECT_TRUE(same(spec.publishedSessions, "share/published/nclt-table3.csv"));
  EXPECT_TRUE(same(spec.session("s").input, "config/hdl32e.ini"));
  EXPECT_EQ(spec.session("t").input, folder / "street.ini");
  EXPECT_TRUE(same(spec.configurations[0].config, "config/hdl32e.ini"));
  EXPECT_TRUE(same(spec.configurations[1].config, "config/paper/nclt.ini"));
  EXPECT_EQ(spec.configurations[2].config, folder / "nclt.ini");
  for (const char* name : {"batches/year.ini", "config/batches/year.ini"})
    EXPECT_TRUE(same(readBatchSpec(name).file, "config/batches/year.ini")) << name;
}

TEST(BatchSpec, ValuesGivenMayChooseAmongWhatTheFileHas) {
  const TempFolder folder;
  writeText(folder / "a.ini", "[batch]\nsettings = one two\n" + sessions +
                                  "[session c]\ndate = 2026-01-01\n" + configuration +
                                  "map_sessions = first\nsessions = later\n"
                                  "[setting two]\nconfig = d.ini\nsessions = c\n");
  const auto with = [&](const std::vector<std::string>& set) {
    return readBatchSpec(folder / "a.ini", {}, set);
  };
  const BatchSpec spec = with({"batch.settings=one", "sessions.names=a b"});
  ASSERT_EQ(spec.configurations.size(), 1u);
  EXPECT_EQ(spec.configurations[0].sessions, std::vector<std::string>{"b"});
  EXPECT_EQ(spec.sessions.size(), 2u);
  // What the file itself does not list stays an error, and so do keys of what is left out.
  EXPECT_HAS(messageOf([&] {
               with({"batch.settings=one", "session d.every=2"});
             }),
             "[session d] is not known");
  EXPECT_HAS(messageOf([&] { with({"batch.settings=one", "setting two.confg=x"}); }), "confg");
}

TEST(BatchSpec, MapsAloneAndMapsOfEachNeedSense) {
  const std::string head = "[batch]\nsettings = one\n" + sessions;
  EXPECT_HAS(refusal(head + configuration + "sessions = none\n"), "sessions = none leaves nothing");
  EXPECT_HAS(refusal(head + configuration + "maps = each\nmap_sessions = all\n"),
             "maps = each has no map before a session");
  EXPECT_HAS(refusal(head + configuration + "maps = each\nmap_sessions = a b\nmap = finished\n"),
             "session c has no map");
  EXPECT_HAS(refusal(head + "truth_map = labels\n" + configuration),
             "needs source = kitti-odometry");
  EXPECT_HAS(refusal(head + "truth_map = {data}/x\n" + configuration), "--data");
  EXPECT_HAS(refusal("[batch]\nsettings = one\npublished = all\n" + sessions + configuration),
             "semantickitti");
}

TEST(BatchSpec, AMapAloneNeedsTruePolesOfItsLastSession) {
  const std::string head = "[batch]\nsettings = one\n" + sessions;
  const std::string alone = configuration + "map_sessions = a b\nsessions = none\n";
  EXPECT_HAS(refusal(head + "[session a]\ntruth_map = t.csv\n" + alone), "give b,");
  EXPECT_EQ(read(head + "[session b]\ntruth_map = t.csv\n" + alone).sessions[0].truthMap, "");
  EXPECT_EQ(read(head + "[session a]\ntruth_map = t.csv\n" + alone + "maps = each\n")
                .configurations[0]
                .mapSessions.size(),
            2u);
}

// `every` and `offset` split nothing there: a drive would be localized in its own data.
TEST(BatchSpec, KeysOfAnImportNeedOne) {
  const std::string head =
      "[batch]\nsettings = one\n" + configuration + "[sessions]\nnames = a b\ninput = x\n";
  for (const std::string source : {"simulated", "poles", "scans"})
    for (const std::string key : {"every = 2", "offset = 1", "odometry_noise = 0.1",
                                  "sensor_pose = 1 2 3 0 0 0", "poses = p.tum", "calib = c"})
      EXPECT_HAS(refusal(head + "source = " + source + "\n" + key + "\n"),
                 key.substr(0, key.find(' ')) + " has no effect with source = " + source);
}

TEST(BatchSpec, WordsForSeveralSessionsAreNoNames) {
  for (const std::string name : {"all", "first", "later", "none"})
    EXPECT_HAS(refusal("[batch]\nsettings = one\n[sessions]\nnames = " + name + " b\ninput = x\n" +
                       configuration),
               "'" + name + "' stands for several sessions");
}

TEST(BatchSpec, FoldersInSettingsMayHaveBlanks) {
  const TempFolder folder;
  fs::create_directories(folder / "a b");
  writeText(folder / "a b/c.ini",
            "[batch]\nsettings = one\n[sessions]\nnames = a b\nsource = simulated\ninput = x.ini\n"
            "set = world.track={here}/t.txt world.seed=6\n" +
                configuration + "sessions = b\n");
  EXPECT_EQ(readBatchSpec(folder / "a b/c.ini").session("a").set,
            (std::vector<std::string>{"world.track=" + (folder / "a b").string() + "/t.txt",
                                      "world.seed=6"}));
}

TEST(BatchSpec, ValuesCanBePutInPlaceOfTheFiles) {
  const TempFolder folder;
  writeText(folder / "a.ini", "[batch]\nsettings = one\n" + sessions + configuration +
                                  "map_sessions = first\nsessions = later\n");
  const auto with = [&](const std::vector<std::string>& set) {
    return readBatchSpec(folder / "a.ini", "/d", set);
  };
  const BatchSpec spec =
      with({"batch.runs=2", "sessions.names=a b", "sessions.input={data}/{session}",
            "setting one.set=filter.particles=7 map.min_count=2"});
  EXPECT_EQ(spec.runs, 2);
  ASSERT_EQ(spec.sessions.size(), 2u);
  EXPECT_EQ(spec.sessions[1].input, "/d/b");
  EXPECT_EQ(spec.configurations[0].set,
            (std::vector<std::string>{"filter.particles=7", "map.min_count=2"}));
  EXPECT_HAS(messageOf([&] { with({"batch.run=2"}); }), "run");
  EXPECT_HAS(messageOf([&] { with({"runs=2"}); }), "section.key=value");
}

TEST(BatchSpec, SeedsComeFromNamesAlone) {
  EXPECT_EQ(seedOf(1, "a/run 0"), seedOf(1, "a/run 0"));
  // CRC-32 of "1/a/run 0", computed with another program.
  EXPECT_EQ(seedOf(1, "a/run 0"), 0xac95152u);
  EXPECT_NE(seedOf(1, "a/run 0"), seedOf(1, "a/run 1"));
  EXPECT_NE(seedOf(1, "a/run 0"), seedOf(2, "a/run 0"));
}

TEST(BatchSpec, WhatASessionSetsComesAfterWhatAllSet) {
  const TempFolder folder;
  writeText(folder / "a.ini",
            "[batch]\nsettings = one\n[sessions]\nnames = a b\nsource = simulated\ninput = x.ini\n"
            "set = world.seed=5 simulation.detections={here}/m.json\n"
            "[session b]\nset = world.seed=6\n" +
                configuration + "sessions = b\n");
  const BatchSpec spec = readBatchSpec(folder / "a.ini");
  const std::string model = "simulation.detections=" + folder.path().string() + "/m.json";
  EXPECT_EQ(spec.session("a").set, (std::vector<std::string>{"world.seed=5", model}));
  EXPECT_EQ(spec.session("b").set,
            (std::vector<std::string>{"world.seed=5", model, "world.seed=6"}));
}

}  // namespace
}  // namespace polemcl::test_batch_spec
