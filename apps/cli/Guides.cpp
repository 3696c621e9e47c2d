#include "cli/Guides.h"

namespace polemcl::apps {
namespace {

const std::map<std::string, Guide> s_guides{
    {"pole-import",
     {{"pole-import folder --input scans --output drive.rawlog",
       "pole-import kitti-odometry --input dataset/sequences/00 --output 00.rawlog"},
      "See the options of one dataset, such as pole-import folder --help."}},
    {"pole-import folder",
     {{"pole-import folder --input scans --output drive.rawlog",
       "pole-import folder --input scans --output odd.rawlog --every 2 --offset 1 "
       "--odometry-noise 0.02 --seed 7"},
      "Build a map of the drive: pole-map build --config demo.ini --input drive.rawlog --truth "
      "drive.tum --output street.polemap."}},
    {"pole-import kitti-odometry",
     {{"pole-import kitti-odometry --input dataset/sequences/00 --output 00.rawlog "
       "--odometry-noise 0.02"},
      "Build a map of the drive, with the configuration kitti.ini: pole-map build --help."}},
    {"pole-import kitti-raw",
     {{"pole-import kitti-raw --input 2011_09_26/2011_09_26_drive_0009_sync --output "
       "0009.rawlog"},
      "Build a map of the drive, with the configuration kitti.ini: pole-map build --help."}},
    {"pole-import nclt",
     {{"pole-import nclt --input 2012-01-15 --output 2012-01-15.rawlog",
       "pole-import nclt --input NCLT --session 2012-01-15 --output 2012-01-15.rawlog"},
      "Build a map of the session, with the configuration nclt.ini: pole-map build --help."}},
    {"pole-import mulran",
     {{"pole-import mulran --input KAIST01 --output kaist01.rawlog --odometry-noise 0.02 --seed "
       "7"},
      "Build a map of the sequence, with the configuration mulran.ini: pole-map build --help."}},
    {"pole-import pcd",
     {{"pole-import pcd --input scans --output drive.rawlog --turn clockwise"},
      "Find out about the LiDAR: pole-extract --inspect drive.rawlog --write-config my.ini. Then "
      "build a map: pole-map build --help."}},
    {"pole-import rosbag2",
     {{"pole-import rosbag2 --input bag --output drive.rawlog",
       "pole-import rosbag2 --input bag --output drive.rawlog --cloud-topic /points --imu-topic "
       "/imu --poses truth.tum"},
      "Find out about the LiDAR: pole-extract --inspect drive.rawlog --write-config my.ini. Then "
      "build a map: pole-map build --help."}},
    {"pole-extract",
     {{"pole-extract --config demo.ini --input drive.rawlog --output poles.rawlog --csv "
       "poles.csv --png scan.png",
       "pole-extract --inspect drive.rawlog --write-config my.ini"},
      "Rawlogs of poles take the place of rawlogs of scans: pole-map build --config demo.ini "
      "--input poles.rawlog --truth drive.tum --output street.polemap."}},
    {"pole-map",
     {{"pole-map build --config demo.ini --input drive.rawlog --truth drive.tum --output "
       "street.polemap",
       "pole-map convert street.polemap --output street.csv"},
      "See the options of one subcommand, such as pole-map build --help."}},
    {"pole-map build",
     {{"pole-map build --config demo.ini --input drive.rawlog --truth drive.tum --output "
       "street.polemap",
       "pole-map build --config hdl32e.ini --input a.rawlog b.rawlog --truth a.tum b.tum "
       "--output campus.polemap --keep-scans --scene campus.3Dscene",
       "pole-map build --config hdl32e.ini --input drive.rawlog --estimate out/run_00.tum "
       "--inventory city.polemap --output exact.polemap"},
      "Localize another drive in the map: pole-localize --help. Where the true poles are known, "
      "score the map: pole-eval map --help."}},
    {"pole-map update",
     {{"pole-map update --config demo.ini --map street.polemap --input friday.rawlog --truth "
       "friday.tum --output friday.polemap --date 2026-03-06"},
      "List what changed: pole-map diff street.polemap friday.polemap --png changes.png."}},
    {"pole-map diff",
     {{"pole-map diff street.polemap friday.polemap --png changes.png --csv changes.csv"},
      "Open a scene written with --scene in MRPT's SceneViewer3D."}},
    {"pole-map convert",
     {{"pole-map convert street.polemap --output street.csv",
       "pole-map convert street.polemap --output street.geojson --datum 52.5,13.4,90"},
      "Tables open in a spreadsheet, .geojson in QGIS."}},
    {"pole-map import",
     {{"pole-map import --input district.osm --keep kind=lamp kind=tree --sigma-m 1 --output "
       "city.polemap",
       "pole-map import --input trees.csv --separator ';' --columns Rechtswert,Hochwert --crs "
       "EPSG:25833 --output city.polemap"},
      "Localize a drive in it, and make it exact: pole-map build --inventory."}},
    {"pole-localize",
     {{"pole-localize --config demo.ini --input drive.rawlog --map street.polemap --truth "
       "drive.tum --output out --runs 5",
       "pole-localize --config demo.ini --input drive.rawlog --map street.polemap --global "
       "--output out --live",
       "pole-localize --config vlp16.ini --sensors live/vlp16.ini --map street.polemap --start "
       "0,0,0,2,5 --output out --stream -"},
      "Evaluate and draw a run: pole-eval trajectory --truth drive.tum --estimate out/run_00.tum "
      "--map street.polemap --png run.png."}},
    {"pole-eval",
     {{"pole-eval trajectory --truth drive.tum --estimate out/run_00.tum --map street.polemap "
       "--png run.png",
       "pole-eval map --truth scans/poles_gt.csv --map street.polemap --one-to-one"},
      "See the options of one subcommand, such as pole-eval map --help."}},
    {"pole-eval map",
     {{"pole-eval map --truth scans/poles_gt.csv --map street.polemap --one-to-one --radius 0.5 "
       "--json score.json"},
      "If too few poles are found, see the settings in [map]: pole-map build --config demo.ini "
      "--print-config."}},
    {"pole-eval trajectory",
     {{"pole-eval trajectory --truth drive.tum --estimate out/run_00.tum --per metre --map "
       "street.polemap --png run.png"},
      "See whether the errors fit the covariances: pole-eval consistency --help."}},
    {"pole-eval detections",
     {{"pole-eval detections --scans scans --poles poles.rawlog --json detections.json"},
      "See how often poles are found again: pole-eval repeatability --help."}},
    {"pole-eval repeatability",
     {{"pole-eval repeatability --poles poles.rawlog --truth drive.tum"},
      "Check the true poses: pole-eval motion --help."}},
    {"pole-eval rotation",
     {{"pole-eval rotation --config demo.ini --input drive.rawlog --every 10"},
      "Compare with another configuration, such as paper/kitti.ini."}},
    {"pole-eval model",
     {{"pole-eval model --drives a0.rawlog a1.rawlog b0.rawlog b1.rawlog --model my.json"},
      "Simulate long drives with it: pole-simulate --config hdl32e.ini --set "
      "simulation.detections=my.json --length 1000 --poles long.rawlog."}},
    {"pole-eval sightings",
     {{"pole-eval sightings --poles drive.rawlog --json sightings.json"},
      "Fit a model of detections to such drives: pole-eval model --help."}},
    {"pole-eval mrpt-truth",
     {{"pole-eval mrpt-truth --truth drive.tum --output truth.txt"},
      "Name it in the settings of pf-localization: ground_truth_path_file = truth.txt."}},
    {"pole-eval motion",
     {{"pole-eval motion --poles poles.rawlog --truth drive.tum --every 4"},
      "If the poses disagree, mend the times or the poses of the dataset before you build a "
      "map."}},
    {"pole-eval global",
     {{"pole-eval global --config demo.ini --map street.polemap --input poles.rawlog --truth "
       "drive.tum --trials 50"},
      "See the settings in [global]: pole-eval global --config demo.ini --print-config."}},
    {"pole-eval starts",
     {{"pole-eval starts --config demo.ini --map street.polemap --input poles.rawlog --truth "
       "drive.tum --trials 50"},
      "Start without any pose: pole-eval global --help."}},
    {"pole-eval consistency",
     {{"pole-eval consistency --truth drive.tum --cov out/run_00_cov.csv --health "
       "out/run_00_health.csv"},
      "If the errors are larger than the covariances say, state the error of the truth "
      "(--truth-sigma-m), or check it: pole-eval motion --help."}},
    {"pole-eval faults",
     {{"pole-eval faults --config demo.ini --map street.polemap --input poles.rawlog --truth "
       "drive.tum --fault kidnap --trials 50"},
      "Compare with a drive without a fault: --fault none."}},
    {"pole-eval features",
     {{"pole-eval features --config hdl32e.ini --scans scans --poles scans/poles_gt.csv "
       "--output features.csv"},
      "Weights are fitted to the tables of several drives: see "
      "share/experiments/train-classifier.sh in the sources."}},
    {"pole-simulate",
     {{"pole-simulate --config demo.ini --length 300 --output scans",
       "pole-simulate --config hdl32e.ini --length 1000 --day 30 --poles drive.rawlog"},
      "Make a rawlog of the scans: pole-import folder --input scans --output drive.rawlog. A "
      "rawlog of poles goes to pole-map and pole-localize as it is."}},
    {"pole-batch",
     {{"pole-batch batches/year.ini --output year",
       "pole-batch batches/kitti.ini --data KITTI --output kitti --jobs 4 --resume"},
      "Open report.html in the folder of the batch. After an interruption, go on with "
      "--resume."}},
    {"pole-labels",
     {{"pole-labels --input dataset/sequences/00 --output 00-truth.polemap"},
      "Score a map with it: pole-eval map --truth 00-truth.polemap --map 00.polemap "
      "--one-to-one."}},
};

}  // namespace

const std::map<std::string, Guide>& guides() {
  return s_guides;
}

const Guide& guideOf(const std::string& name) {
  static const Guide none;
  const auto found = guides().find(name);
  return found == guides().end() ? none : found->second;
}

}  // namespace polemcl::apps
