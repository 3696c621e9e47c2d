#pragma once
// A model that is simple enough to compute its results by hand.

#include "sim/detections/DetectionModel.h"

namespace polemcl::sim::testing_sim {

/// All poles within 40 m are found with probability 0.6 in every scan, with errors of 5 cm (1
/// sigma) in both directions. No persistent noise, no false detections.
inline DetectionModel plainModel() {
  DetectionModel model;
  model.sensor = "hdl32e";
  model.detectedRange = {5, 35};
  model.reportedRange = {20};
  const auto all = [](double value) {
    Quantiles quantiles;
    quantiles.fill(value);
    return quantiles;
  };
  // Standard normal numbers at kQuantileLevels, from a table.
  const Quantiles normal{-2.878, -2.326, -1.645, -1.036, -0.5244, 0,
                         0.5244, 1.036,  1.645,  2.326,  2.878};
  for (int c = 0; c < kDetectionClasses; ++c) {
    ClassModel& own = model.classes[c];
    if (static_cast<DetectionClass>(c) != DetectionClass::passing) own.detected = {0.6, 0.6};
    own.reported = {std::vector<Quantiles>{all(0.05)},
                    {all(0.05)},
                    {normal},
                    {normal},
                    {all(0.7)},
                    {all(0)},
                    {all(0.2)},
                    {all(3)},
                    {all(20)}};
  }
  model.clutterLateral = all(8);
  model.passingRange = all(15);
  return model;
}

}  // namespace polemcl::sim::testing_sim
