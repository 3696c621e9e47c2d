#include <gtest/gtest.h>
#include <mrpt/config/CConfigFileMemory.h>
#include <mrpt/maps/CMultiMetricMap.h>
#include <mrpt/maps/CSimpleMap.h>
#include <mrpt/obs/CObservationOdometry.h>
#include <mrpt/opengl/CCylinder.h>
#include <mrpt/opengl/COpenGLScene.h>
#include <mrpt/poses/CPose3DPDFGaussian.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <sstream>

#include <polemcl/mrpt/map/CPoleMap.h>
#include "core/common/PoleIndex.h"
#include "io/map/PoleMapFile.h"
#include "io/map/PoleTables.h"
#include "support/Refusal.h"
#include "support/Samples.h"

namespace polemcl::test_cpole_map {
namespace {

using mrpt::poses::CPose3D;

MapPole mapPole(double x, double y, std::uint32_t count = 3) {
  MapPole p = tests::variedMapPole(x, y);
  p.radius = 0.15;
  p.bottom = 0.1;
  p.top = 4;
  p.confidence = 0.5;
  p.covariance << 0.01, 0.002, 0.002, 0.02;
  p.count = count;
  return p;
}

CPoleMap sampleMap() {
  CPoleMap map;
  map.setPoles({mapPole(0, 0, 1), mapPole(10, 0, 4), mapPole(0, 10, 2)});
  map.info["source"] = "made up";
  return map;
}

void expectEqual(const CPoleMap& a, const CPoleMap& b) {
  ASSERT_EQ(a.poles().size(), b.poles().size());
  for (std::size_t i = 0; i < a.poles().size(); ++i) tests::expectSame(a.poles()[i], b.poles()[i]);
  EXPECT_EQ(a.info, b.info);
}

mrpt::maps::CMultiMetricMap::Ptr fromIni(const std::string& text) {
  const mrpt::config::CConfigFileMemory ini(text);
  mrpt::maps::TSetOfMetricMapInitializers list;
  list.loadFromConfigFile(ini, "MetricMap");
  auto maps = mrpt::maps::CMultiMetricMap::Create();
  maps->setListOfMaps(list);
  return maps;
}

std::string refusal(const std::string& ini) {
  try {
    fromIni(ini);
  } catch (const std::exception& error) {
    return error.what();
  }
  return "";
}

const std::string kOne = "[MetricMap]\npoleMap_count = 1\n";

TEST(CPoleMap, StartsEmpty) {
  const CPoleMap map;
  EXPECT_TRUE(map.isEmpty());
  EXPECT_EQ(map.index().size(), 0u);
  EXPECT_EQ(map.asString(), "polemcl::CPoleMap: 0 poles");
}

TEST(CPoleMap, IndexFollowsThePoles) {
  CPoleMap map = sampleMap();
  ASSERT_TRUE(map.index().nearest(9.9, 0.1, 1));
  EXPECT_EQ(map.index().nearest(9.9, 0.1, 1)->index, 1u);
  map.setPoles({mapPole(50, 50)});
  EXPECT_FALSE(map.index().nearest(9.9, 0.1, 1));
  EXPECT_TRUE(map.index().nearest(50, 50, 1));
  map.clear();
  EXPECT_TRUE(map.isEmpty());
  EXPECT_TRUE(map.info.empty());
  EXPECT_FALSE(map.index().nearest(50, 50, 1));
}

TEST(CPoleMap, IndexIsPreparedForTheGate) {
  CPoleMap map;
  map.likelihoodOptions.gate = 2.5;
  map.setPoles({mapPole(0, 0)});
  EXPECT_EQ(map.index().preparedRadius(), 2.5);
}

TEST(CPoleMap, RefusesBadPoles) {
  CPoleMap map = sampleMap();
  MapPole bad = mapPole(1, std::nan(""));
  EXPECT_THROW(map.setPoles({mapPole(0, 0), bad}), Error);
  bad = mapPole(1, 1);
  bad.covariance(0, 0) = INFINITY;
  EXPECT_THROW(map.setPoles({bad}), Error);
  bad.covariance << 1, 2, 2, 1;
  EXPECT_THROW(map.setPoles({bad}), Error);
  bad.covariance = 1.7e308 * Eigen::Matrix2d::Identity();
  EXPECT_REFUSED(map.setPoles({bad}), "pole 0: the covariance must be at most 1e12 m²");
  EXPECT_EQ(map.poles().size(), 3u);  // unchanged
}

TEST(CPoleMap, CopiesAreIndependent) {
  CPoleMap copy;
  {
    CPoleMap map = sampleMap();
    copy = map;
    map.setPoles({});
  }
  expectEqual(copy, sampleMap());
  EXPECT_EQ(copy.index().nearest(0, 9.5, 1)->index, 2u);
  const auto clone = std::dynamic_pointer_cast<CPoleMap>(copy.duplicateGetSmartPtr());
  ASSERT_TRUE(clone);
  copy.clear();
  expectEqual(*clone, sampleMap());
}

// Equal to the core's value in the robot frame, with a rotated sensor mounting.
TEST(CPoleMap, LikelihoodIsTheCores) {
  CPoleMap map = sampleMap();
  CObservationPoles scan = samples::observation();
  std::mt19937_64 generator(3);
  const auto uniform = [&](double half) {
    return (static_cast<double>(generator() >> 11) / 9007199254740992.0 - 0.5) * 2 * half;
  };
  int matched = 0;
  for (const auto model : {LikelihoodModel::paper, LikelihoodModel::mixture})
    for (const bool weighted : {false, true}) {
      map.likelihoodOptions.model = model;
      map.likelihoodOptions.weighted = weighted;
      for (int i = 0; i < 50; ++i) {
        const Pose2D pose{uniform(3), uniform(3), uniform(M_PI)};
        scan.poles = {samples::pole(uniform(10), uniform(10)), samples::pole(uniform(10), 0)};
        const double own =
            map.computeObservationLikelihood(scan, CPose3D(pose.x, pose.y, 0.7, pose.yaw, 0, 0));
        const double core =
            logLikelihood(scan.polesInRobotFrame(), pose, map.index(), map.likelihoodOptions);
        EXPECT_NEAR(own, core, 1e-9);
        if (std::abs(core - logLikelihood(scan.polesInRobotFrame(), {1e6, 0, 0}, map.index(),
                                          map.likelihoodOptions)) > 1e-6)
          ++matched;
      }
    }
  EXPECT_GT(matched, 10);  // not only poles without a match
}

// Enough poses for several blocks of the batch, near each other and far apart. Some gates use the
// grid; after setPoles(), one uses nanoflann's tree.
TEST(CPoleMap, ManyPosesGetTheSameBitsAsEachAlone) {
  std::mt19937_64 generator(4);
  const auto uniform = [&](double half) {
    return (static_cast<double>(generator() >> 11) * 0x1p-53 - 0.5) * 2 * half;
  };
  const std::vector<double> widenings{1, 2, 8};
  for (const auto model : {LikelihoodModel::paper, LikelihoodModel::mixture})
    for (const bool weighted : {false, true})
      for (const double gate : {1.0, 3.0})
        for (const CPose3D& mounting : {CPose3D(), CPose3D(0.7, -0.2, 1.7, 0.5, 0.1, 0)}) {
          CPoleMap map = sampleMap();
          map.likelihoodOptions.model = model;
          map.likelihoodOptions.weighted = weighted;
          map.likelihoodOptions.gate = gate;
          CObservationPoles scan;
          scan.setSensorPose(mounting);
          for (const Pose2D& place : {Pose2D{10, 0, 0}, Pose2D{0, 9.8, 0}, Pose2D{-30, 0, 0}}) {
            const Pose2D seen = relative(scan.planarSensorPose(), place);
            scan.poles.push_back(samples::pole(seen.x, seen.y));
          }
          std::vector<CPose3D> alone;
          std::vector<Pose2D> together;
          for (int i = 0; i < 300; ++i) {
            const double half = i < 200 ? 0.5 : 10;
            alone.emplace_back(uniform(half), uniform(half), 0.3, uniform(i < 200 ? 0.1 : 3.1), 0,
                               0);
            together.push_back({alone[i].x(), alone[i].y(), alone[i].yaw()});
          }
          std::vector<double> many;
          std::vector<std::vector<double>> widened;
          map.logLikelihoods(scan, together, many);
          map.widenedLogLikelihoods(scan, map.likelihoodOptions, together, widenings, widened);
          ASSERT_EQ(many.size(), together.size());
          ASSERT_EQ(widened.size(), widenings.size());
          EXPECT_EQ(widened[0], many);
          const double sigma = map.likelihoodOptions.sigma;
          for (std::size_t k = 0; k < widenings.size(); ++k) {
            map.likelihoodOptions.sigma = sigma * widenings[k];
            std::vector<double> single;
            for (const CPose3D& pose : alone)
              single.push_back(map.computeObservationLikelihood(scan, pose));
            EXPECT_EQ(widened[k], single) << k;
            const auto [least, most] = std::minmax_element(single.begin(), single.end());
            EXPECT_GT(*most - *least, 0.1) << "or the comparison says nothing";
          }
        }
}

TEST(CPoleMap, ForeignObservationsSayNothing) {
  CPoleMap map = sampleMap();
  const mrpt::obs::CObservationOdometry odometry;
  EXPECT_EQ(map.computeObservationLikelihood(odometry, CPose3D()), 0);
  EXPECT_FALSE(map.canComputeObservationLikelihood(odometry));
  EXPECT_FALSE(map.insertObservation(odometry, CPose3D()));
  EXPECT_EQ(map.poles().size(), 3u);
  EXPECT_TRUE(map.canComputeObservationLikelihood(samples::observation()));
  std::vector<double> many{3};
  map.logLikelihoods(odometry, {{0, 0, 0}, {1, 0, 0}}, many);
  EXPECT_EQ(many, (std::vector<double>{0, 0}));
}

TEST(CPoleMap, HonoursTheGenericSwitches) {
  CPoleMap map = sampleMap();
  CObservationPoles scan;
  scan.poles = {samples::pole(0.3, 0)};
  EXPECT_LT(map.computeObservationLikelihood(scan, CPose3D()), 0);
  std::vector<double> many;
  map.logLikelihoods(scan, {{0, 0, 0}}, many);
  EXPECT_EQ(many, std::vector<double>{map.computeObservationLikelihood(scan, CPose3D())});
  map.genericMapParams.enableObservationLikelihood = false;
  EXPECT_EQ(map.computeObservationLikelihood(scan, CPose3D()), 0);
  map.logLikelihoods(scan, {{0, 0, 0}}, many);
  EXPECT_EQ(many, std::vector<double>{0});
  map.genericMapParams.enableObservationInsertion = false;
  EXPECT_FALSE(map.insertObservation(scan));
}

TEST(CPoleMap, ComesFromASimpleMap) {
  mrpt::maps::CSimpleMap simple;
  for (int i = 0; i < 3; ++i) {
    auto scan = std::make_shared<CObservationPoles>();
    scan->poles = {samples::pole(20 - i, 0.01 * i)};
    auto frame = mrpt::obs::CSensoryFrame::Create();
    frame->insert(scan);
    simple.insert(mrpt::poses::CPose3DPDFGaussian::Create(CPose3D(i, 0, 0, 0, 0, 0)), frame);
  }
  CPoleMap map = sampleMap();
  map.loadFromSimpleMap(simple);
  ASSERT_EQ(map.poles().size(), 1u);
  EXPECT_NEAR(map.poles()[0].x, 20, 1e-12);
  EXPECT_NEAR(map.poles()[0].y, 0.01, 1e-12);
  EXPECT_EQ(map.poles()[0].count, 3u);
}

TEST(CPoleMap, SurvivesSerialization) {
  CPoleMap map = sampleMap();
  map.genericMapParams.enableSaveAs3DObject = false;
  map.insertionOptions.mergeDistance = 0.75;
  map.insertionOptions.minConfidence = 0.25;
  map.likelihoodOptions.model = LikelihoodModel::paper;
  map.likelihoodOptions.sigma = 0.5;
  map.likelihoodOptions.outlier = 0.125;
  map.likelihoodOptions.gate = 2;
  map.likelihoodOptions.floor = 0.375;
  map.likelihoodOptions.farOutlier = 0.25;
  map.likelihoodOptions.weighted = !LikelihoodOptions().weighted;
  const std::string bytes = samples::bytesOf(map);
  const auto read = std::dynamic_pointer_cast<CPoleMap>(samples::objectFrom(bytes));
  ASSERT_TRUE(read);
  expectEqual(*read, map);
  EXPECT_FALSE(read->genericMapParams.enableSaveAs3DObject);
  EXPECT_EQ(read->insertionOptions.mergeDistance, 0.75);
  EXPECT_EQ(read->insertionOptions.minConfidence, 0.25);
  EXPECT_EQ(read->likelihoodOptions.model, LikelihoodModel::paper);
  EXPECT_EQ(read->likelihoodOptions.sigma, 0.5);
  EXPECT_EQ(read->likelihoodOptions.outlier, 0.125);
  EXPECT_EQ(read->likelihoodOptions.gate, 2);
  EXPECT_EQ(read->likelihoodOptions.floor, 0.375);
  EXPECT_EQ(read->likelihoodOptions.farOutlier, 0.25);
  EXPECT_EQ(read->likelihoodOptions.weighted, map.likelihoodOptions.weighted);
  EXPECT_EQ(read->index().nearest(10, 0, 1)->index, 1u);
  EXPECT_EQ(samples::bytesOf(*read), bytes);
}

TEST(CPoleMap, ReadsMapsOfOlderVersions) {
  // Version 0 had no floor; neither 0 nor 1 told far outliers from others.
  for (const int version : {0, 1}) {
    CPoleMap map = sampleMap();
    map.info.clear();
    map.likelihoodOptions.floor = 0.375;
    std::string bytes = samples::bytesOf(map);
    const double value = 0.375;
    const std::string floor(reinterpret_cast<const char*>(&value), sizeof value);
    const std::size_t at = bytes.find(floor);
    ASSERT_NE(at, std::string::npos);
    bytes.erase(at + version * floor.size(), (2 - version) * floor.size());
    bytes[1 + std::string("polemcl::CPoleMap").size()] = static_cast<char>(version);
    const auto read = std::dynamic_pointer_cast<CPoleMap>(samples::objectFrom(bytes));
    ASSERT_TRUE(read);
    expectEqual(*read, map);
    EXPECT_EQ(read->likelihoodOptions.floor, version == 0 ? LikelihoodOptions().floor : 0.375);
    EXPECT_EQ(read->likelihoodOptions.farOutlier, 1);
  }
}

// A bool holds 0 or 1: any other byte in it is undefined behaviour.
TEST(CPoleMap, ReadsAnyByteAsYesOrNo) {
  CPoleMap map = sampleMap();
  auto& g = map.genericMapParams;
  for (bool* flag : {&g.enableSaveAs3DObject, &g.enableObservationLikelihood,
                     &g.enableObservationInsertion, &map.likelihoodOptions.weighted}) {
    *flag = false;
    std::string no = samples::bytesOf(map);
    *flag = true;
    const std::string yes = samples::bytesOf(map);
    const auto place = std::mismatch(no.begin(), no.end(), yes.begin()).first;
    ASSERT_NE(place, no.end());
    *place = '\x42';
    EXPECT_EQ(samples::bytesOf(*samples::objectFrom(no)), yes);
  }
}

TEST(CPoleMap, RefusesNewerVersions) {
  std::string bytes = samples::bytesOf(sampleMap());
  const std::string name = "polemcl::CPoleMap";
  ASSERT_EQ(bytes.substr(1, name.size()), name);
  bytes[1 + name.size()] = 3;
  EXPECT_ANY_THROW(samples::objectFrom(bytes));
}

TEST(CPoleMap, KeepsItsOwnFile) {
  const testing_apps::TempFolder folder;
  const CPoleMap map = sampleMap();
  map.saveToPoleMapFile(folder / "m.polemap");
  CPoleMap read;
  read.setPoles({mapPole(77, 77)});
  read.loadFromPoleMapFile(folder / "m.polemap");
  expectEqual(read, map);
  EXPECT_THROW(read.loadFromPoleMapFile(folder / "none.polemap"), Error);
  expectEqual(read, map);
}

TEST(CPoleMap, SavesRepresentations) {
  const testing_apps::TempFolder folder;
  sampleMap().saveMetricMapRepresentationToFile(folder / "m");
  EXPECT_EQ(io::readPoleMap(folder / "m.polemap").poles.size(), 3u);
  EXPECT_EQ(io::readPolePositions(folder / "m.csv").size(), 3u);
  mrpt::opengl::COpenGLScene scene;
  ASSERT_TRUE(scene.loadFromFile(folder / "m.3Dscene"));
  const auto pole = std::dynamic_pointer_cast<mrpt::opengl::CCylinder>(scene.getByName("pole 2"));
  ASSERT_TRUE(pole);
  EXPECT_NEAR(pole->getPose().y, 10, 1e-6);  // map frame, m: no scale
  const auto group =
      std::dynamic_pointer_cast<mrpt::opengl::CSetOfObjects>(*scene.getViewport()->begin());
  ASSERT_TRUE(group);
  EXPECT_EQ(group->getScaleX(), 1);
}

TEST(CPoleMap, DrawsPolesColouredByCount) {
  CPoleMap map = sampleMap();
  const auto scene = map.getVisualization();
  ASSERT_EQ(scene->size(), 3u);
  const auto seldom = scene->getByClass<mrpt::opengl::CCylinder>(0);
  const auto often = scene->getByClass<mrpt::opengl::CCylinder>(1);
  EXPECT_NEAR(often->getPose().x, 10, 1e-6);
  EXPECT_NEAR(often->getPose().z, 0.1, 1e-6);
  EXPECT_NEAR(often->getHeight(), 3.9, 1e-6);
  EXPECT_NEAR(often->getTopRadius(), 0.15, 1e-6);
  EXPECT_FALSE(seldom->getColor_u8() == often->getColor_u8());
  map.genericMapParams.enableSaveAs3DObject = false;
  EXPECT_EQ(map.getVisualization()->size(), 0u);
}

TEST(CPoleMap, IsCreatedFromIni) {
  const auto maps = fromIni(kOne +
                            "[MetricMap_poleMap_00_creationOpts]\nenableSaveAs3DObject = false\n"
                            "[MetricMap_poleMap_00_insertOpts]\nmerge_distance = 0.3\n"
                            "[MetricMap_poleMap_00_likelihoodOpts]\nsigma_m = 0.2 // m\n"
                            "model = paper\n");
  ASSERT_EQ(maps->maps.size(), 1u);  // one, not two: names ignore case
  const auto map = maps->mapByClass<CPoleMap>();
  ASSERT_TRUE(map);
  EXPECT_FALSE(map->genericMapParams.enableSaveAs3DObject);
  EXPECT_EQ(map->insertionOptions.mergeDistance, 0.3);
  EXPECT_EQ(map->likelihoodOptions.sigma, 0.2);
  EXPECT_EQ(map->likelihoodOptions.model, LikelihoodModel::paper);
  EXPECT_TRUE(map->isEmpty());
}

TEST(CPoleMap, LoadsItsFileAtCreation) {
  const testing_apps::TempFolder folder;
  sampleMap().saveToPoleMapFile(folder / "m.polemap");
  const auto maps = fromIni(
      kOne + "[MetricMap_poleMap_00_creationOpts]\nmap_file = " + (folder / "m.polemap").string());
  expectEqual(*maps->mapByClass<CPoleMap>(), sampleMap());
}

TEST(CPoleMap, RefusesBadIni) {
  EXPECT_HAS(refusal(kOne + "[MetricMap_poleMap_00_likelihoodOpts]\nsigma_m = 0\n"), "sigma_m = 0");
  EXPECT_HAS(refusal(kOne + "[MetricMap_poleMap_00_insertOpts]\nmerge_distance = 3x\n"), "3x");
  EXPECT_HAS(refusal(kOne + "[MetricMap_poleMap_00_insertOpts]\nmin_confidence = 1.5\n"), "1.5");
  EXPECT_HAS(refusal(kOne + "[MetricMap_poleMap_00_creationOpts]\nmap_file = /no/such.polemap\n"),
             "/no/such.polemap");
}

// As MRPT's options do, but not silently.
TEST(CPoleMap, PassesOverUnknownKeysWithAWarning) {
  for (const std::string section : {"creationOpts", "insertOpts", "likelihoodOpts"}) {
    testing::internal::CaptureStderr();
    const auto maps = fromIni(kOne + "[MetricMap_poleMap_00_" + section + "]\nof_mrpt_3 = 0.2\n");
    const std::string said = testing::internal::GetCapturedStderr();
    EXPECT_TRUE(maps->mapByClass<CPoleMap>());
    EXPECT_HAS(said, "of_mrpt_3 = 0.2: key is not known");
  }
}

TEST(CPoleMap, OptionsSurviveIni) {
  CPoleMap map;
  map.insertionOptions.mergeDistance = 0.7;
  map.likelihoodOptions.gate = 1.25;
  map.likelihoodOptions.model = LikelihoodModel::paper;
  mrpt::config::CConfigFileMemory ini;
  map.insertionOptions.saveToConfigFile(ini, "insert");
  map.likelihoodOptions.saveToConfigFile(ini, "likelihood");
  CPoleMap read;
  read.insertionOptions.loadFromConfigFile(ini, "insert");
  read.likelihoodOptions.loadFromConfigFile(ini, "likelihood");
  EXPECT_EQ(read.insertionOptions.mergeDistance, 0.7);
  EXPECT_EQ(read.likelihoodOptions.gate, 1.25);
  EXPECT_EQ(read.likelihoodOptions.model, LikelihoodModel::paper);
}

TEST(CPoleMap, ShowsItsDefinition) {
  const mrpt::config::CConfigFileMemory ini(kOne);
  mrpt::maps::TSetOfMetricMapInitializers list;
  list.loadFromConfigFile(ini, "MetricMap");
  std::ostringstream text;
  list.dumpToTextStream(text);
  for (const char* part : {"polemcl::CPoleMap", "map_file", "merge_distance", "sigma_m"})
    EXPECT_HAS(text.str(), part) << part;
}

TEST(CPoleMap, LikelihoodOptionsTakeTheCores) {
  LikelihoodOptions options;
  options.sigma = 0.4;
  CPoleMap map;
  map.likelihoodOptions = options;
  EXPECT_EQ(map.likelihoodOptions.sigma, 0.4);
}

TEST(CPoleMap, TravelsInAMultiMetricMap) {
  auto maps = fromIni(kOne);
  *maps->mapByClass<CPoleMap>() = sampleMap();
  const auto read = std::dynamic_pointer_cast<mrpt::maps::CMultiMetricMap>(
      samples::objectFrom(samples::bytesOf(*maps)));
  ASSERT_TRUE(read);
  expectEqual(*read->mapByClass<CPoleMap>(), sampleMap());
}

TEST(RegisterClasses, AgainDoesNoHarm) {
  registerClasses();
  registerClasses();
  EXPECT_NE(mrpt::rtti::findRegisteredClass("polemcl::CPoleMap"), nullptr);
}

}  // namespace
}  // namespace polemcl::test_cpole_map
