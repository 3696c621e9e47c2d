#include <gtest/gtest.h>

#include <algorithm>

#include "batch/BatchPlan.h"
#include "support/BatchTestFiles.h"

namespace polemcl::test_batch_plan {
namespace {

using namespace polemcl::apps;
using namespace testing_apps;

const std::string source = POLEMCL_SOURCE_DIR;

/// Three sessions in folders that are there, two configurations; `change` may alter it.
BatchPlan planOf(const std::function<void(BatchSpec&)>& change = {}) {
  static const TempFolder folder;
  BatchSpec spec;
  spec.name = "try";
  spec.runs = 2;
  for (const char* name : {"a", "b", "c"}) {
    BatchSession session;
    session.name = name;
    session.source = "nclt";
    session.input = (folder / name).string();
    fs::create_directories(session.input);
    spec.sessions.push_back(session);
  }
  BatchConfiguration configuration;
  configuration.name = "one";
  configuration.config = source + "/config/nclt.ini";
  configuration.mapSessions = {"a", "b"};
  configuration.sessions = {"b", "c"};
  spec.configurations = {configuration};
  if (change) change(spec);
  BatchPlan plan = planBatch(spec);
  writePlan(folder / "plan.json", plan);
  EXPECT_EQ(messageOf([&] { readPlan(folder / "plan.json"); }), "no error");
  return plan;
}

std::vector<std::string> ids(const BatchPlan& plan) {
  std::vector<std::string> all;
  for (const auto& task : plan.tasks) all.push_back(task.id);
  return all;
}

/// The value behind an option.
std::string argument(const std::vector<std::string>& command, const std::string& option) {
  const auto found = std::find(command.begin(), command.end(), option);
  return found == command.end() ? "none" : *(found + 1);
}

using Names = std::vector<std::string>;

TEST(BatchPlan, LocalizesInTheMapOfEarlierSessions) {
  const BatchPlan plan = planOf();
  EXPECT_EQ(ids(plan), (Names{"poles.a", "poles.b", "poles.c", "map.one.a", "map.one.b",
                              "run.one.b.00", "run.one.b.01", "run.one.c.00", "run.one.c.01"}));
  EXPECT_EQ(plan.task("run.one.b.00").needs, (Names{"poles.b", "map.one.a"}));
  EXPECT_EQ(plan.task("run.one.c.00").needs, (Names{"poles.c", "map.one.b"}));
  EXPECT_EQ(plan.task("map.one.b").needs, (Names{"poles.a", "poles.b"}));
  const auto& run = plan.task("run.one.b.01").commands.at(0);
  EXPECT_EQ(argument(run, "--map"), "../map.one.a/map.polemap");
  EXPECT_EQ(argument(run, "--input"), "../poles.b/one/b.rawlog");
  EXPECT_EQ(argument(run, "--seed"), std::to_string(seedOf(1, "b/run 1")));
}

TEST(BatchPlan, LocalizesInTheFinishedMap) {
  const BatchPlan plan = planOf([](BatchSpec& spec) {
    spec.configurations[0].map = MapTime::finished;
    spec.configurations[0].sessions = {"a", "b", "c"};
  });
  EXPECT_EQ(ids(plan).size(), 3u + 1 + 6);
  for (const char* run : {"run.one.a.00", "run.one.b.00", "run.one.c.00"})
    EXPECT_EQ(plan.task(run).needs.back(), "map.one.b") << run;
  ASSERT_EQ(plan.experiments.size(), 3u);
  EXPECT_EQ(plan.experiments[0].ownMap, "map.one.b");
  EXPECT_EQ(plan.experiments[2].ownMap, "");
}

TEST(BatchPlan, UpkeepIsAChain) {
  const BatchPlan plan = planOf([](BatchSpec& spec) {
    spec.configurations[0].protocol = MapProtocol::upkeep;
    spec.configurations[0].mapSessions = {"a", "b", "c"};
    spec.configurations[0].sessions = {"c"};
  });
  EXPECT_EQ(ids(plan), (Names{"poles.a", "poles.b", "poles.c", "map.one.a", "map.one.b",
                              "run.one.c.00", "run.one.c.01"}));
  EXPECT_EQ(plan.task("map.one.b").needs, (Names{"map.one.a", "poles.b"}));
  const auto& update = plan.task("map.one.b").commands.at(0);
  EXPECT_EQ(update.at(4), "update");
  EXPECT_EQ(argument(update, "--map"), "../map.one.a/map.polemap");
  EXPECT_EQ(argument(update, "--input"), "../poles.b/one/b.rawlog");
  EXPECT_EQ(plan.task("map.one.a").commands.at(0).at(4), "build");
}

TEST(BatchPlan, UpkeepByEstimatesWaitsForTheRuns) {
  const BatchPlan plan = planOf([](BatchSpec& spec) {
    spec.configurations[0].protocol = MapProtocol::upkeep;
    spec.configurations[0].poses = MapPoses::estimate;
    spec.configurations[0].mapSessions = {"a", "b"};
    spec.configurations[0].sessions = {"b", "c"};
  });
  EXPECT_EQ(ids(plan), (Names{"poles.a", "poles.b", "poles.c", "map.one.a", "run.one.b.00",
                              "run.one.b.01", "map.one.b", "run.one.c.00", "run.one.c.01"}));
  EXPECT_EQ(plan.task("map.one.b").needs, (Names{"map.one.a", "run.one.b.00", "poles.b"}));
  const auto& update = plan.task("map.one.b").commands.at(0);
  EXPECT_EQ(argument(update, "--estimate"), "../run.one.b.00/out/run_00.tum");
  EXPECT_EQ(std::count(update.begin(), update.end(), "--truth"), 0);
  EXPECT_EQ(plan.task("run.one.b.00").outputs.back(), "out/run_00_cov.csv");
  EXPECT_NE(plan.task("run.one.b.01").outputs.back(), "out/run_00_cov.csv");
  EXPECT_EQ(argument(plan.task("map.one.a").commands.at(0), "--truth"), "../poles.a/a.tum");
}

TEST(BatchPlan, SettingsWithTheSameExtractionShareTheirPoles) {
  const BatchPlan plan = planOf([](BatchSpec& spec) {
    spec.configurations.push_back(spec.configurations[0]);
    spec.configurations[1].name = "two";
    spec.configurations[1].set = {"filter.particles=7"};
    spec.configurations.push_back(spec.configurations[0]);
    spec.configurations[2].name = "paper";
    spec.configurations[2].config = source + "/config/paper/nclt.ini";
  });
  const BatchTask& poles = plan.task("poles.a");
  ASSERT_EQ(poles.commands.size(), 3u);  // one import, two extractions
  EXPECT_EQ(poles.commands[0][0], "pole-import");
  EXPECT_EQ(argument(poles.commands[1], "--config"), "../../settings/one.ini");
  EXPECT_EQ(argument(poles.commands[2], "--config"), "../../settings/paper.ini");
  EXPECT_EQ(poles.outputs, (Names{"a.tum", "one/a.rawlog", "paper/a.rawlog"}));
  EXPECT_EQ(argument(plan.task("run.two.b.00").commands[0], "--input"), "../poles.b/one/b.rawlog");
  EXPECT_EQ(argument(plan.task("run.paper.b.00").commands[0], "--input"),
            "../poles.b/paper/b.rawlog");
  // Configurations are compared on the same random numbers.
  EXPECT_EQ(plan.experiments[1].seeds, plan.experiments[4].seeds);
  EXPECT_NE(plan.files.at("settings/two.ini").find("particles = 7"), std::string::npos);
}

// They would be compared on the same poles.
TEST(BatchPlan, SettingsOfTheExtractionNeedScans) {
  static const TempFolder folder;
  writeText(folder / "a.ini", "[world]\nlength_m = 60\n");
  const auto settings = [](const std::string& second) {
    return [=](BatchSpec& spec) {
      for (auto& session : spec.sessions) {
        session.source = "simulated";
        session.input = (folder / "a.ini").string();
      }
      spec.configurations.push_back(spec.configurations[0]);
      spec.configurations[1].name = "two";
      spec.configurations[1].set = {second};
    };
  };
  EXPECT_HAS(messageOf([&] { planOf(settings("scan_line.max_range_m=10")); }),
             "settings one and two extract poles in different ways, but session a (source = "
             "simulated)");
  EXPECT_EQ(planOf(settings("filter.particles=7")).task("poles.a").outputs.size(), 3u);
}

TEST(BatchPlan, TracksAreTakenFromBesideTheBatch) {
  static const TempFolder folder;
  writeText(folder / "a.ini", "[world]\ntrack = track.txt\n");
  writeText(folder / "track.txt", "1 0 0 0 0 1 0 0 0 0 1 0\n1 0 0 0 0 1 0 0 0 0 1 60\n");
  const BatchPlan plan = planOf([](BatchSpec& spec) {
    spec.file = folder / "batch.ini";
    spec.sessions[0].source = "simulated";
    spec.sessions[0].input = (folder / "a.ini").string();
  });
  EXPECT_EQ(plan.files.at("files/track.txt"), readText(folder / "track.txt"));
}

// A batch of others must not get other files of this machine into its folder.
TEST(BatchPlan, RefusesFilesOfASimulationThatAreNoModelAndNoTrack) {
  static const TempFolder folder;
  writeText(folder / "secret.env", "PASSWORD=open");
  const auto refusal = [&](const std::string& setting) {
    writeText(folder / "a.ini", setting + " = " + (folder / "secret.env").string() + "\n");
    return messageOf([&] {
      planOf([](BatchSpec& spec) {
        spec.sessions[0].source = "simulated";
        spec.sessions[0].input = (folder / "a.ini").string();
      });
    });
  };
  EXPECT_HAS(refusal("[simulation]\ndetections"), "session a: ");
  EXPECT_HAS(refusal("[simulation]\ndetections"), "secret.env: ");
  EXPECT_HAS(refusal("[world]\ntrack"), "secret.env:1: ");
  writeText(folder / "secret.env", R"({"password": "open"})");
  EXPECT_HAS(refusal("[simulation]\ndetections"), "secret.env: is no model of detections");
}

TEST(BatchPlan, MapsTakeDoubtfulPolesWhereTheyAreAskedFor) {
  const BatchPlan plan = planOf([](BatchSpec& spec) {
    spec.configurations[0].set = {"map.min_confidence=0.3"};
    spec.configurations.push_back(spec.configurations[0]);
    spec.configurations[1].name = "two";
    spec.configurations[1].set.clear();
  });
  const BatchTask& poles = plan.task("poles.b");  // mapped and localized
  EXPECT_EQ(poles.outputs, (Names{"b.tum", "one/b.rawlog", "one.map/b.rawlog", "two/b.rawlog"}));
  ASSERT_EQ(poles.commands.size(), 4u);
  EXPECT_EQ(argument(poles.commands[2], "--set"), "scan_line.min_confidence=0.3");
  EXPECT_EQ(argument(poles.commands[2], "--output"), "one.map/b.rawlog");
  EXPECT_EQ(argument(plan.task("map.one.a").commands[0], "--input"), "../poles.a/one.map/a.rawlog");
  EXPECT_EQ(argument(plan.task("run.one.b.00").commands[0], "--input"), "../poles.b/one/b.rawlog");
  EXPECT_EQ(argument(plan.task("map.two.a").commands[0], "--input"), "../poles.a/two/a.rawlog");
}

TEST(BatchPlan, PolesAreSharedOnlyBetweenTheSameLidarsAndMotions) {
  const std::vector<std::string> front{"vehicle.lidars=front"};
  const BatchPlan plan = planOf([&](BatchSpec& spec) {
    const BatchConfiguration first = spec.configurations[0];
    const auto add = [&](const std::string& name, const std::vector<std::string>& set) {
      spec.configurations.push_back(first);
      spec.configurations.back().name = name;
      spec.configurations.back().set = set;
    };
    spec.configurations[0].set = front;
    add("same", {"vehicle.lidars=front", "motion.covariance_factor=2"});
    add("both", {"vehicle.lidars=front stern", "map.min_confidence=0.3"});
    add("noisy", {"vehicle.lidars=front", "motion.xy_per_m=0.5"});
  });
  const BatchTask& poles = plan.task("poles.b");
  EXPECT_EQ(poles.outputs, (Names{"b.tum", "one/b.rawlog", "both/b.rawlog", "both.map/b.rawlog",
                                  "noisy/b.rawlog"}));
  const std::vector<std::string>& forMaps = poles.commands[3];
  for (const char* value : {"scan_line.min_confidence=0.3", "scan_line:front.min_confidence=0.3",
                            "scan_line:stern.min_confidence=0.3"})
    EXPECT_EQ(std::count(forMaps.begin(), forMaps.end(), value), 1) << value;
}

TEST(BatchPlan, SessionsHaveThePolesOfTheConfigurationsThatUseThem) {
  const BatchPlan plan = planOf([](BatchSpec& spec) {
    spec.configurations[0].set = {"map.min_confidence=0.3"};
    spec.configurations.push_back(spec.configurations[0]);
    spec.configurations[1].name = "paper";
    spec.configurations[1].config = source + "/config/paper/nclt.ini";
    spec.configurations[1].set.clear();
    spec.configurations[1].mapSessions = spec.configurations[1].sessions = {"b"};
    spec.configurations[1].map = MapTime::finished;
  });
  // a is only mapped, and by the first configuration alone; c is only localized, by the same.
  EXPECT_EQ(plan.task("poles.a").outputs, (Names{"a.tum", "one.map/a.rawlog"}));
  EXPECT_EQ(plan.task("poles.b").outputs,
            (Names{"b.tum", "one/b.rawlog", "one.map/b.rawlog", "paper/b.rawlog"}));
  EXPECT_EQ(plan.task("poles.c").outputs, (Names{"c.tum", "one/c.rawlog"}));
  for (const char* id : {"poles.a", "poles.b", "poles.c"})
    EXPECT_EQ(plan.task(id).commands.size(), plan.task(id).outputs.size()) << id;
}

TEST(BatchPlan, FinishedMapsAreScoredAgainstTruePoles) {
  static const TempFolder folder;
  writeText(folder / "truth.csv", "x,y\n1,2\n");
  const auto scored = [&](const std::function<void(BatchSpec&)>& more) {
    return planOf([&](BatchSpec& spec) {
      for (auto& session : spec.sessions) session.truthMap = (folder / "truth.csv").string();
      more(spec);
    });
  };
  const BatchPlan plan = scored([](BatchSpec&) {});
  // Two maps are made, of a, and of a and b; the last one is scored.
  EXPECT_EQ(ids(plan).size(), 3u + 2 + 1 + 4);
  const BatchTask& score = plan.task("score.one.b");
  EXPECT_EQ(score.kind, TaskKind::score);
  EXPECT_EQ(score.needs, Names{"map.one.b"});
  EXPECT_EQ(score.outputs, (Names{"near_1m.json", "one_to_one_1m.json", "one_to_one_0.5m.json"}));
  ASSERT_EQ(score.commands.size(), 3u);
  EXPECT_EQ(argument(score.commands[0], "--map"), "../map.one.b/map.polemap");
  EXPECT_EQ(argument(score.commands[0], "--truth"), (folder / "truth.csv").string());
  const auto oneToOne = [&](std::size_t i) {
    const auto& command = score.commands[i];
    return std::find(command.begin(), command.end(), "--one-to-one") != command.end();
  };
  EXPECT_FALSE(oneToOne(0));
  EXPECT_TRUE(oneToOne(1) && oneToOne(2));
  EXPECT_EQ(argument(score.commands[2], "--radius"), "0.5");
  ASSERT_EQ(plan.experiments.size(), 3u);
  EXPECT_EQ(plan.experiments[0].score, "");
  EXPECT_EQ(plan.experiments[1].score, "score.one.b");
  // A map that no session is localized in is made for its score.
  const BatchPlan strict = scored([](BatchSpec& spec) {
    spec.configurations[0].mapSessions = {"a", "b", "c"};
    spec.configurations[0].sessions = {"b"};
  });
  EXPECT_EQ(strict.task("score.one.c").needs, Names{"map.one.c"});
  EXPECT_EQ(strict.task("map.one.c").needs, (Names{"poles.a", "poles.b", "poles.c"}));
}

TEST(BatchPlan, EachSessionMayHaveItsOwnMapAndTruth) {
  const BatchPlan plan = planOf([](BatchSpec& spec) {
    for (auto& session : spec.sessions) {
      session.source = "kitti-odometry";
      session.truthMap = truthFromLabels;
      fs::create_directories(session.input + "/labels");
    }
    spec.configurations[0].protocol = MapProtocol::each;
    spec.configurations[0].mapSessions = {"a", "b"};
    spec.configurations[0].sessions.clear();
  });
  EXPECT_EQ(ids(plan), (Names{"poles.a", "poles.b", "truth.a", "truth.b", "map.one.a", "map.one.b",
                              "score.one.a", "score.one.b"}));
  EXPECT_EQ(plan.task("map.one.b").needs, Names{"poles.b"});
  EXPECT_EQ(plan.task("score.one.b").needs, (Names{"map.one.b", "truth.b"}));
  EXPECT_EQ(argument(plan.task("score.one.b").commands[0], "--truth"), "../truth.b/truth.polemap");
  EXPECT_EQ(plan.task("truth.a").commands[0][0], "pole-labels");
  EXPECT_EQ(plan.experiments[1].ownMap, "map.one.b");
  // Localized, it is in its own map.
  const BatchPlan localized = planOf([](BatchSpec& spec) {
    spec.configurations[0].protocol = MapProtocol::each;
    spec.configurations[0].map = MapTime::finished;
    spec.configurations[0].sessions = {"a", "b"};
  });
  EXPECT_EQ(localized.task("run.one.a.00").needs, (Names{"poles.a", "map.one.a"}));
  EXPECT_EQ(localized.task("run.one.b.00").needs, (Names{"poles.b", "map.one.b"}));
}

TEST(BatchPlan, ImportsAsTheSessionSays) {
  const BatchPlan plan = planOf([](BatchSpec& spec) {
    BatchSession& session = spec.sessions[1];
    session.source = "kitti-raw";
    session.every = 2;
    session.offset = 1;
    session.odometryNoise = 0.02;
    session.calib = "/calibration";
    session.date = "2011-09-26";
  });
  const auto& command = plan.task("poles.b").commands.at(0);
  EXPECT_NE(std::find(command.begin(), command.end(), "kitti-raw"), command.end());
  EXPECT_EQ(argument(command, "--every"), "2");
  EXPECT_EQ(argument(command, "--offset"), "1");
  EXPECT_EQ(std::stod(argument(command, "--odometry-noise")), 0.02);
  EXPECT_EQ(argument(command, "--seed"), std::to_string(seedOf(1, "b/odometry")));
  EXPECT_EQ(argument(command, "--calib"), "/calibration");
  // Only if all of its sessions have one.
  EXPECT_EQ(argument(plan.task("map.one.b").commands.at(0), "--date"), "none");
  const BatchPlan dated = planOf([](BatchSpec& spec) {
    spec.sessions[0].date = "2011-09-25";
    spec.sessions[1].date = "2011-09-26";
  });
  EXPECT_EQ(argument(dated.task("map.one.a").commands.at(0), "--date"), "2011-09-25");
}

TEST(BatchPlan, KeysChangeWithWhatTheOutputsDependOn) {
  const BatchPlan plan = planOf();
  EXPECT_EQ(planOf().task("run.one.c.00").key, plan.task("run.one.c.00").key);
  const auto changed = [&](const std::function<void(BatchSpec&)>& change) {
    const BatchPlan other = planOf(change);
    Names different;
    for (const auto& task : plan.tasks)
      if (other.task(task.id).key != task.key) different.push_back(task.id);
    return different;
  };
  EXPECT_EQ(changed([](BatchSpec& spec) { spec.seed = 2; }),
            (Names{"run.one.b.00", "run.one.b.01", "run.one.c.00", "run.one.c.01"}));
  EXPECT_EQ(changed([](BatchSpec& spec) { spec.sessions[2].every = 2; }),
            (Names{"poles.c", "run.one.c.00", "run.one.c.01"}));
  EXPECT_EQ(changed([](BatchSpec& spec) { spec.sessions[1].every = 2; }).size(), 6u);
  // Configurations are frozen as a whole: poles depend on them, and all else on the poles.
  EXPECT_EQ(
      changed([](BatchSpec& spec) { spec.configurations[0].set = {"map.min_count=4"}; }).size(),
      plan.tasks.size());
  EXPECT_EQ(changed([](BatchSpec& spec) { spec.runs = 3; }), Names{});
}

TEST(BatchPlan, NamesAllInputsThatAreMissing) {
  const std::string message = messageOf([] {
    planOf([](BatchSpec& spec) { spec.sessions[0].input = spec.sessions[2].input = "/not/there"; });
  });
  EXPECT_HAS(
      message,
      "inputs of 2 sessions are missing: a: /not/there is not there; c: /not/there is not there");
  EXPECT_HAS(messageOf([] {
               planOf([](BatchSpec& spec) { spec.sessions[1].truthMap = "/not/there.npz"; });
             }),
             "b: /not/there.npz, its truth_map, is not there");
  // True poles that no map is scored against need not be there.
  EXPECT_NO_THROW(planOf([](BatchSpec& spec) { spec.sessions[0].truthMap = "/not/there.npz"; }));
  // Sessions that no configuration uses need not be there.
  EXPECT_NO_THROW(planOf([](BatchSpec& spec) {
    spec.sessions[2].input = "/not/there";
    spec.configurations[0].sessions = {"b"};
  }));
}

TEST(BatchPlan, TakesSessionsOfNcltAsItsDownloaderLaysThemOut) {
  const TempFolder data;
  const BatchSpec spec = readBatchSpec(source + "/config/batches/nclt.ini", data.path());
  const std::string message = messageOf([&] { planBatch(spec); });
  EXPECT_HAS(message, "inputs of 27 sessions are missing: 2012-01-08: ");
  EXPECT_HAS(message, "2012-01-22 is not there; and so on; check --data");
  for (const auto& session : spec.sessions)
    fs::create_directories(data / "velodyne_data" / session.name / "velodyne_sync");
  const BatchPlan plan = planBatch(spec);
  const Names& import = plan.task("poles.2012-01-08").commands[0];
  EXPECT_NE(std::find(import.begin(), import.end(), (data / "2012-01-08").string()), import.end());
}

TEST(BatchPlan, TheProjectsOwnBatchesCanBePlanned) {
  std::size_t batches = 0;
  for (const auto& entry : fs::directory_iterator(source + "/config/batches")) {
    SCOPED_TRACE(entry.path().string());
    const TempFolder data;
    const BatchSpec spec = readBatchSpec(entry.path(), data.path());
    for (const auto& session : spec.sessions)
      if (session.source != "simulated") {
        fs::create_directories(session.input + "/labels");
        if (!session.truthMap.empty() && session.truthMap != truthFromLabels)
          writeText(session.truthMap, "");
      }
    const BatchPlan plan = planBatch(spec);
    std::size_t runs = 0;
    for (const auto& configuration : spec.configurations)
      runs += configuration.sessions.size() * spec.runs;
    EXPECT_EQ(std::count_if(plan.tasks.begin(), plan.tasks.end(),
                            [](const BatchTask& task) { return task.kind == TaskKind::run; }),
              static_cast<std::ptrdiff_t>(runs));
    EXPECT_FALSE(spec.title.empty());
    ++batches;
  }
  EXPECT_GE(batches, 6u);
}

TEST(BatchPlan, NamesWhereAFileIsMissingBeforeTheData) {
  const TempFolder folder;
  const auto refusal = [&](const std::string& batch, const std::string& setting) {
    writeText(folder / "a.ini", "[batch]\nsettings = one\n" + batch +
                                    "[sessions]\nnames = s t\ninput = /not/there\n"
                                    "[setting one]\n" +
                                    setting);
    return messageOf([&] { planBatch(readBatchSpec(folder / "a.ini")); });
  };
  EXPECT_EQ(refusal("", "config = nobody.ini\nsessions = later\n")
                .rfind("batch a: [setting one] config: " + (folder / "nobody.ini").string() +
                           " is not there; name a file beside the batch, or an installed one",
                       0),
            0u);
  EXPECT_HAS(refusal("", "config = nclt.ini\nset = filter.particles=-1\nsessions = later\n"),
             "batch a: [setting one] ");
  EXPECT_EQ(refusal("published_sessions = mine.csv\n", "config = nclt.ini\nsessions = later\n")
                .rfind("batch a: [batch] published_sessions: ", 0),
            0u);
}

TEST(BatchPlan, KeysStandForTheBuild) {
  const TempFolder folder;
  const BatchSpec spec = readBatchSpec(writeStreetBatch(folder), "");
  const BatchPlan here = planBatch(spec), again = planBatch(spec),
                  other = planBatch(spec, "0123456789ab, GNU 12.2.0, Debug, -g");
  ASSERT_EQ(ids(here), ids(other));
  for (std::size_t i = 0; i < here.tasks.size(); ++i) {
    EXPECT_EQ(here.tasks[i].key, again.tasks[i].key);
    EXPECT_NE(here.tasks[i].key, other.tasks[i].key) << here.tasks[i].id;
  }
}

TEST(BatchPlan, LevelsHoldWhatCanBeDoneAtOnce) {
  const auto all = levels(planOf());
  ASSERT_EQ(all.size(), 3u);
  EXPECT_EQ(all[0], (Names{"poles.a", "poles.b", "poles.c"}));
  EXPECT_EQ(all[1], (Names{"map.one.a", "map.one.b"}));
  EXPECT_EQ(all[2].size(), 4u);
}

TEST(BatchPlan, SurvivesItsFile) {
  const TempFolder folder;
  writeText(folder / "truth.csv", "x,y\n1,2\n");
  const BatchPlan plan =
      planOf([&](BatchSpec& spec) { spec.sessions[1].truthMap = (folder / "truth.csv").string(); });
  EXPECT_EQ(plan.experiments[1].score, "score.one.b");
  writePlan(folder / "plan.json", plan);
  const BatchPlan read = readPlan(folder / "plan.json");
  EXPECT_EQ(read.name, plan.name);
  EXPECT_EQ(read.build, buildIdentity());
  ASSERT_EQ(ids(read), ids(plan));
  for (std::size_t i = 0; i < plan.tasks.size(); ++i) {
    EXPECT_EQ(read.tasks[i].commands, plan.tasks[i].commands);
    EXPECT_EQ(read.tasks[i].needs, plan.tasks[i].needs);
    EXPECT_EQ(read.tasks[i].outputs, plan.tasks[i].outputs);
    EXPECT_EQ(read.tasks[i].key, plan.tasks[i].key);
    EXPECT_EQ(read.tasks[i].kind, plan.tasks[i].kind);
  }
  ASSERT_EQ(read.experiments.size(), plan.experiments.size());
  EXPECT_EQ(read.experiments[1].seeds, plan.experiments[1].seeds);
  EXPECT_EQ(read.experiments[1].map, plan.experiments[1].map);
  EXPECT_EQ(read.experiments[1].score, plan.experiments[1].score);
  writeText(folder / "plan.json", readText(folder / "plan.json").substr(0, 100));
  EXPECT_REFUSED(readPlan(folder / "plan.json"), "is no plan of a batch");
}

}  // namespace
}  // namespace polemcl::test_batch_plan
