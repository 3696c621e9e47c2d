#pragma once
// A city of poles, its map and a drive through it, as the files that programs read.

#include <polemcl/mrpt/map/CPoleMap.h>
#include <polemcl/mrpt/observation/CObservationPoles.h>
#include "io/data/Trajectory.h"
#include "mrpt/rawlog/RawlogWriter.h"
#include "support/PoleCity.h"
#include "support/TempFolder.h"

namespace testing_apps {

/// \brief `city.polemap`, `drive.rawlog` (one frame per metre, 0.2 s), `drive.tum`, `city.ini`.
class CityFiles {
 public:
  explicit CityFiles(double metres, std::uint64_t seed = 21) {
    polemcl::tests::CityOptions options;
    options.seed = seed;
    const polemcl::tests::PoleCity city(options);
    polemcl::CPoleMap map;
    map.setPoles(city.map());
    map.saveToPoleMapFile(at("city.polemap"));
    polemcl::sim::Random random(seed + 1);
    const auto way = city.randomWay(random, metres);
    polemcl::tests::DriveOptions driving;
    driving.falsePerFrame = 0.5;
    frames = polemcl::tests::drive(city.surroundings(), way, driving, random);
    write();
    writeText(folder / "city.ini", "[likelihood]\nsigma_m = 0.05\nweighted = true\n");
  }

  std::string at(const std::string& name) const { return (folder / name).string(); }
  static double time(std::size_t i) { return 1e9 + 0.2 * static_cast<double>(i); }

  TempFolder folder;
  std::vector<polemcl::tests::Frame> frames;

 private:
  void write() {
    using namespace polemcl;
    RawlogWriter writer(at("drive.rawlog"));
    std::vector<StampedPose2D> truth;
    for (std::size_t i = 0; i < frames.size(); ++i) {
      auto poles = CObservationPoles::Create();
      poles->timestamp = mrpt::Clock::fromDouble(time(i));
      poles->poles = frames[i].poles_robot;
      poles->points = 1000;
      PoseWithCovariance motion;
      motion.mean = frames[i].motion;
      const Eigen::Vector3d moved(motion.mean.x, motion.mean.y, motion.mean.yaw);
      motion.covariance = (0.02 * moved).cwiseAbs2().asDiagonal();  // as sampled by the drive
      writer.write(makeActions(motion, poles->timestamp), poles);
      truth.push_back({time(i), frames[i].truth});
    }
    writer.commit();
    io::writeTum(at("drive.tum"), truth);
  }
};

}  // namespace testing_apps
