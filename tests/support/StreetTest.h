#pragma once
// Shared by the tests of pole-extract and pole-map: an imported street.

#include <functional>

#include "cli/Projections.h"
#include "cli/Settings.h"
#include "import/DatasetImport.h"
#include "io/data/Trajectory.h"
#include "io/file/TextFile.h"
#include "map/MapApp.h"
#include "support/PoleStreetFiles.h"

namespace testing_apps {

class StreetTest : public testing::Test {
 protected:
  StreetTest() {
    // Own settings, so that changes of config/ do not affect the tests.
    writeText(configFolder / "street.ini",
              "[sensor]\nmodel = hdl32e\nheight_m = 1.0\n[map]\nsection_length_m = 1.5\n"
              "min_count = 2\nevery_scan = false\nmin_share = 0\n"
              "[likelihood]\nsigma_m = 0.15\nweighted = false\n");
  }
  std::string config() const { return (configFolder / "street.ini").string(); }
  polemcl::apps::AllSettings settings() const { return polemcl::apps::loadSettings(config()); }
  std::string at(const std::string& name) const { return (folder / name).string(); }

  /// Imports `folder/NAME` as `folder/NAME.rawlog` and `folder/NAME.tum`.
  void import(const std::string& name, bool embed = true, const std::string& sensorPose = "") {
    polemcl::apps::ImportOptions options;
    options.input = folder / name;
    options.output = folder / (name + ".rawlog");
    options.embed = embed;
    if (!sensorPose.empty()) options.T_robot_sensor = polemcl::apps::parseSensorPose(sensorPose);
    polemcl::apps::importDataset(options);
  }

  void importStreet(const std::string& name, std::size_t scans) {
    writeStreet(folder / name, scans);
    import(name);
  }

  /// `pole-map build` of `in.rawlog` at its true poses: `map.polemap`.
  void buildAtTruth() const {
    const Outcome built = succeeded(runProgram(
        polemcl::apps::mapMain, {"build", "--config", config(), "--input", at("in.rawlog"),
                                 "--truth", at("in.tum"), "--output", at("map.polemap")}));
  }
  /// The same without true poses: `street.polemap`, and its poses in `found.tum`.
  Outcome buildWithoutTruth(const std::vector<std::string>& more = {}) const {
    return runProgram(polemcl::apps::mapMain,
                      {"build", "--config", config(), "--input", at("in.rawlog"), "--output",
                       at("street.polemap"), "--trajectory", at("found.tum")},
                      more);
  }
  /// Writes `fixes.csv`, a fix just after each true pose. The truth begins at (100, 50) of a map
  /// with the datum 48,9. \param along What the receiver says of the x of the truth.
  void writeFixes(const std::function<double(double)>& along = [](double x) { return x; }) const {
    using polemcl::io::fixed;
    std::string fixes = "time,latitude,longitude,sigma\n";
    const polemcl::apps::MapPlane plane({48, 9, 0});
    for (const auto& [time, pose] : polemcl::io::readPlanarTum(folder / "in.tum")) {
      const Eigen::Vector2d lonLat = plane.lonLat({100 + along(pose.x), 50 + pose.y});
      fixes += fixed(time + 0.01, 3) + ',' + fixed(lonLat.y(), 10) + ',' + fixed(lonLat.x(), 10) +
               ",0.02\n";
    }
    writeText(folder / "fixes.csv", fixes);
  }

  /// Replaces a word by another of the same length everywhere in a file.
  void replace(const std::string& name, const std::string& word, const std::string& by) const {
    std::string bytes = readText(folder / name);
    for (auto p = bytes.find(word); p != std::string::npos; p = bytes.find(word, p + 1))
      bytes.replace(p, word.size(), by);
    writeText(folder / name, bytes);
  }

  TempFolder folder;

 private:
  TempFolder configFolder;
};

}  // namespace testing_apps
