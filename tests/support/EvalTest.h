#pragma once
// A fixture for commands of `pole-eval`: runs them on small files written by the test.

#include <functional>
#include <nlohmann/json.hpp>

#include <polemcl/mrpt/observation/CObservationPoles.h>
#include "eval/EvalApp.h"
#include "mrpt/rawlog/RawlogWriter.h"
#include "support/StreetTest.h"

namespace testing_apps {

using Arguments = std::vector<std::string>;

class EvalTest : public StreetTest {
 protected:
  static Outcome run(const Arguments& arguments) {
    return runProgram(polemcl::apps::evalMain, arguments);
  }
  /// \brief What the command writes to the file of `--json`.
  nlohmann::json figures(Arguments arguments) const {
    arguments.insert(arguments.end(), {"--json", at("figures.json")});
    const Outcome outcome = succeeded(run(arguments));
    return nlohmann::json::parse(outcome.code == 0 ? readText(at("figures.json")) : "null");
  }
  /// \brief Each row: arguments, and words of the one line that refuses them.
  static void expectRefusals(const std::vector<std::pair<Arguments, Arguments>>& rows) {
    for (const auto& [arguments, words] : rows) {
      SCOPED_TRACE(arguments[0] + ' ' + words[0]);
      expectFailure(run(arguments), words);
    }
  }

  /// \brief True poses along x, one a second, without those of some seconds.
  void writeWay(const std::string& name, int poses, double metres = 1,
                const std::function<bool(int)>& left = {}) const {
    std::string rows;
    for (int i = 0; i < poses; ++i)
      if (!left || left(i))
        rows += std::to_string(i) + ' ' + std::to_string(metres * i) + " 0 0 0 0 0 1\n";
    writeText(at(name), rows);
  }

  using Poles = std::vector<polemcl::PoleDetection>;
  static polemcl::PoleDetection detection(double x, double y, double confidence = 0.9) {
    polemcl::PoleDetection pole;
    pole.x = x;
    pole.y = y;
    pole.radius = 0.12;
    pole.confidence = confidence;
    return pole;
  }
  /// \brief A rawlog of poles. \param poles Gives those of scan i, in the frame of the sensor.
  /// \param motion Before each scan; none: no odometry.
  void writePoles(const std::string& name, const std::vector<double>& times,
                  const std::function<Poles(std::size_t)>& poles,
                  const std::optional<polemcl::PoseWithCovariance>& motion = polemcl::standstill(),
                  const mrpt::poses::CPose3D& sensorPose = {}) const {
    polemcl::RawlogWriter writer(at(name));
    for (std::size_t i = 0; i < times.size(); ++i) {
      auto scan = std::make_shared<polemcl::CObservationPoles>();
      scan->timestamp = mrpt::Clock::fromDouble(times[i]);
      scan->sensorPose = sensorPose;
      scan->poles = poles(i);
      writer.write(
          motion ? polemcl::makeActions(i > 0 ? *motion : polemcl::standstill(), scan->timestamp)
                 : mrpt::obs::CActionCollection(),
          scan);
    }
    writer.commit();
  }
};

}  // namespace testing_apps
