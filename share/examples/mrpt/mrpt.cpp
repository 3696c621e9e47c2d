// MRPT's own particle filter on a pole map: mrpt DRIVE.rawlog SETTINGS.ini X Y YAW. The rawlog
// holds poles; the last three are the pose at the first scan, roughly (m, rad). Prints time, x, y,
// yaw. Maps and observations are known by their names in the files only; including polemcl loads
// the library.
#include <mrpt/bayes/CParticleFilter.h>
#include <mrpt/config/CConfigFile.h>
#include <mrpt/io/CFileGZInputStream.h>
#include <mrpt/maps/CMultiMetricMap.h>
#include <mrpt/obs/CRawlog.h>
#include <mrpt/random/RandomGenerators.h>
#include <mrpt/serialization/CArchive.h>
#include <mrpt/slam/CMonteCarloLocalization2D.h>

#include <cstdio>
#include <cstdlib>
#include <exception>
#include <stdexcept>

#include <polemcl/polemcl.h>

namespace {

mrpt::maps::CMultiMetricMap::Ptr loadMaps(const mrpt::config::CConfigFile& settings) {
  mrpt::maps::TSetOfMetricMapInitializers list;
  list.loadFromConfigFile(settings, "MetricMap");
  auto maps = mrpt::maps::CMultiMetricMap::Create();
  maps->setListOfMaps(list);
  if (maps->maps.empty()) throw std::runtime_error("no map; set poleMap_count = 1 in [MetricMap]");
  return maps;
}

void run(char** arguments) {
  const mrpt::config::CConfigFile settings(arguments[2]);
  mrpt::random::getRandomGenerator().randomize(1);
  mrpt::slam::CMonteCarloLocalization2D filter;
  filter.options.metricMap = loadMaps(settings);
  filter.options.KLD_params.loadFromConfigFile(settings, "KLD_options");
  mrpt::bayes::CParticleFilter algorithm;
  algorithm.m_options.loadFromConfigFile(settings, "PF_options");
  const double x = std::atof(arguments[3]), y = std::atof(arguments[4]),
               yaw = std::atof(arguments[5]);
  filter.resetUniform(x - 0.5, x + 0.5, y - 0.5, y + 0.5, yaw - 0.03, yaw + 0.03, 10000);

  mrpt::io::CFileGZInputStream file(arguments[1]);
  auto rawlog = mrpt::serialization::archiveFrom(file);
  mrpt::obs::CActionCollection::Ptr action;
  mrpt::obs::CSensoryFrame::Ptr frame;
  mrpt::obs::CObservation::Ptr single;
  for (std::size_t entry = 0; mrpt::obs::CRawlog::getActionObservationPairOrObservation(
           rawlog, action, frame, single, entry);) {
    if (!frame || frame->empty()) continue;
    algorithm.executeOn(filter, action.get(), frame.get());
    const auto pose = filter.getMeanVal();
    std::printf("%.6f %.3f %.3f %.4f\n", mrpt::Clock::toDouble((*frame->begin())->timestamp),
                pose.x(), pose.y(), pose.phi());
  }
}

}  // namespace

int main(int count, char** arguments) try {
  if (count != 6) throw std::runtime_error("usage: mrpt DRIVE.rawlog SETTINGS.ini X Y YAW");
  run(arguments);
  return 0;
} catch (const std::exception& error) {
  std::fprintf(stderr, "mrpt: %s\n", error.what());
  return 1;
}
