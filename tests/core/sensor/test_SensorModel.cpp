#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/common/Binder.h"
#include "core/sensor/SensorModel.h"
#include "support/Clouds.h"
#include "support/Refusal.h"
#include "support/Sensors.h"

namespace polemcl::test_sensor_model {
namespace {

using polemcl::clouds::kDegree;
using tests::sensorNamed;

SensorOptions uniform(int rows, double upDeg, double downDeg) {
  return tests::uniformSensor(rows, upDeg, downDeg, 1000);
}

SensorOptions table(const std::vector<double>& degrees) {
  SensorOptions options = sensorNamed("table");
  for (const double d : degrees) options.elevations.push_back(d * kDegree);
  options.columns = 1000;
  return options;
}

/// A point made by each beam is given back to that beam, near and far.
void expectOwnRows(const SensorModel& sensor, std::initializer_list<double> ranges) {
  for (const double rho : ranges)
    for (int row = 0; row < sensor.beamCount(); ++row) {
      const Beam& beam = sensor.beam(row);
      const double z = rho * beam.slope + beam.offset;
      ASSERT_EQ(sensor.row(static_cast<float>(rho), static_cast<float>(z)), row) << rho;
    }
}

const std::vector<std::pair<std::string, int>> kBeams = {
    {"hdl64e", 64},      {"hdl32e", 32},   {"vlp16", 16}, {"os1_64", 64},
    {"os1_64_gen2", 64}, {"os1_128", 128}, {"os0_64", 64}};

TEST(SensorModel, PresetsHaveTheBeamsOfTheirNames) {
  for (const auto& [model, beams] : kBeams)
    EXPECT_EQ(SensorModel(sensorNamed(model)).beamCount(), beams) << model;
}

TEST(SensorModel, NamesAreWhatModelAccepts) {
  const auto names = SensorModel::modelNames();
  EXPECT_EQ(names.size(), kBeams.size() + 2);
  for (const auto& name : names) {
    SensorOptions options = sensorNamed(name);
    options.elevations = {-0.1, 0.1};
    options.columns = 500;
    EXPECT_NO_THROW(SensorModel{options}) << name;
  }
}

TEST(SensorModel, OutermostBeamsAreThoseOfTheDataSheets) {
  const auto expectFan = [](const std::string& model, double topDeg, double bottomDeg) {
    const SensorModel sensor(sensorNamed(model));
    EXPECT_NEAR(std::atan(sensor.beam(0).slope), topDeg * kDegree, 0.002 * kDegree) << model;
    EXPECT_NEAR(std::atan(sensor.beam(sensor.beamCount() - 1).slope), bottomDeg * kDegree,
                0.002 * kDegree);
  };
  expectFan("hdl32e", 10.667, -30.667);
  expectFan("vlp16", 15, -15);
  expectFan("os1_64", 16.611, -16.611);
  expectFan("os1_128", 22.5, -22.5);
  expectFan("os0_64", 45, -45);
}

TEST(SensorModel, BeamsAreOrderedFromTheTop) {
  for (const auto& [model, beams] : kBeams)
    for (const bool upsideDown : {false, true}) {
      const SensorModel sensor(sensorNamed(model, upsideDown));
      for (int row = 1; row < beams; ++row)
        EXPECT_LT(sensor.beam(row).slope, sensor.beam(row - 1).slope) << model << row;
    }
}

TEST(SensorModel, APointOfEachBeamIsGivenToThatBeam) {
  for (const auto& [model, beams] : kBeams)
    for (const bool upsideDown : {false, true}) {
      SCOPED_TRACE(model);
      expectOwnRows(SensorModel(sensorNamed(model, upsideDown)), {1, 3, 12, 60});
    }
}

// The lower block of the HDL-64E starts 8 cm below the upper one: 1.5° at 3 m, 0.08° at 60 m.
TEST(SensorModel, BlocksOfTheHdl64eHaveTheirOwnOffsets) {
  const SensorModel sensor(sensorNamed("hdl64e"));
  EXPECT_GT(sensor.beam(0).offset, sensor.beam(63).offset + 0.05);
  EXPECT_EQ(sensor.beam(0).offset, sensor.beam(31).offset);
  EXPECT_EQ(sensor.beam(32).offset, sensor.beam(63).offset);
  // Seen from the origin, a point of beam 40 at 3 m lies where beam 36 would be without offsets.
  const float rho = 3, z = static_cast<float>(rho * sensor.beam(40).slope + sensor.beam(40).offset);
  EXPECT_GT(z / rho, sensor.beam(37).slope);
  EXPECT_EQ(sensor.row(rho, z), 40);
}

TEST(SensorModel, APointBetweenTwoBeamsIsGivenToTheNearer) {
  sim::Random random(1);
  for (const SensorOptions& options :
       {sensorNamed("hdl32e"), sensorNamed("os1_64_gen2"), table({5, -1, 0.3})}) {
    const SensorModel sensor(options);
    for (int i = 0; i < 5000; ++i) {
      const double slope =
          random.uniform(sensor.beam(sensor.beamCount() - 1).slope, sensor.beam(0).slope);
      std::vector<double> distance;
      for (int row = 0; row < sensor.beamCount(); ++row)
        distance.push_back(std::abs(sensor.beam(row).slope - slope));
      const auto nearest = std::min_element(distance.begin(), distance.end());
      const int row = sensor.row(20, static_cast<float>(20 * slope));
      ASSERT_GE(row, 0);
      EXPECT_LT(distance[row], *nearest + 0.0006) << slope;  // lookup cells are 0.0005 wide
    }
  }
}

TEST(SensorModel, OutsideTheFanThereIsNoRow) {
  const float nan = std::nanf(""), inf = std::numeric_limits<float>::infinity();
  for (const auto& [model, beams] : kBeams) {
    const SensorModel sensor(sensorNamed(model));
    const Beam &top = sensor.beam(0), &bottom = sensor.beam(beams - 1);
    for (const double rho : {3.0, 60.0}) {
      const double over = rho * std::tan(std::atan(top.slope) + 1.5 * kDegree) + top.offset;
      const double under = rho * std::tan(std::atan(bottom.slope) - 1.5 * kDegree) + bottom.offset;
      EXPECT_EQ(sensor.row(static_cast<float>(rho), static_cast<float>(over)), -1) << model;
      EXPECT_EQ(sensor.row(static_cast<float>(rho), static_cast<float>(under)), -1) << model;
    }
    EXPECT_EQ(sensor.row(1, 1e20f), -1);
    EXPECT_EQ(sensor.row(1, -1e20f), -1);
    EXPECT_EQ(sensor.row(1, nan), -1);
    EXPECT_EQ(sensor.row(1, inf), -1);
    EXPECT_EQ(sensor.row(0, 1), -1);
  }
}

TEST(SensorModel, UpsideDownTheFanIsMirrored) {
  for (const std::string model : {"hdl32e", "hdl64e", "vlp16"}) {
    const SensorModel upright(sensorNamed(model)), hanging(sensorNamed(model, true));
    for (int row = 0; row < upright.beamCount(); ++row) {
      const Beam &a = upright.beam(row), &b = hanging.beam(upright.beamCount() - 1 - row);
      EXPECT_DOUBLE_EQ(b.slope, -a.slope) << model;
      EXPECT_DOUBLE_EQ(b.offset, -a.offset) << model;
    }
  }
  EXPECT_NEAR(std::atan(SensorModel(sensorNamed("hdl32e", true)).beam(0).slope), 30.667 * kDegree,
              1e-6);
}

TEST(SensorModel, ATableMayComeInAnyOrder) {
  const SensorModel sensor(table({-5, 10, 2}));
  ASSERT_EQ(sensor.beamCount(), 3);
  EXPECT_DOUBLE_EQ(sensor.beam(0).slope, std::tan(10 * kDegree));
  EXPECT_DOUBLE_EQ(sensor.beam(1).slope, std::tan(2 * kDegree));
  EXPECT_DOUBLE_EQ(sensor.beam(2).slope, std::tan(-5 * kDegree));
  EXPECT_EQ(sensor.beam(1).offset, 0);
  expectOwnRows(sensor, {1, 30});
}

// As the HDL-64E: two blocks, each with its own apex.
TEST(SensorModel, ATableMayHaveALowerBlock) {
  SensorOptions options = table({2, 0, -4, -2});
  options.lowerElevations = {-10 * kDegree, -6 * kDegree, -8 * kDegree};
  options.upperApex = 0.2;
  options.lowerApex = 0.12;
  const SensorModel sensor(options);
  ASSERT_EQ(sensor.beamCount(), 7);
  EXPECT_DOUBLE_EQ(sensor.beam(3).slope, std::tan(-4 * kDegree));
  EXPECT_EQ(sensor.beam(3).offset, 0.2);
  EXPECT_DOUBLE_EQ(sensor.beam(4).slope, std::tan(-6 * kDegree));
  EXPECT_EQ(sensor.beam(4).offset, 0.12);
  expectOwnRows(sensor, {3, 12, 60});
}

TEST(SensorModel, UniformBeamsAreEvenlySpaced) {
  const SensorModel sensor(tests::uniformSensor(5, 10, -30, 720));
  ASSERT_EQ(sensor.beamCount(), 5);
  for (int row = 0; row < 5; ++row)
    EXPECT_NEAR(std::atan(sensor.beam(row).slope), (10 - 10 * row) * kDegree, 1e-12);
  EXPECT_EQ(sensor.columns(), 720);
  EXPECT_NEAR(sensor.columnAngle(), 0.5 * kDegree, 1e-12);
  expectOwnRows(sensor, {1, 30});
}

TEST(SensorModel, SpacingIsTheAngleToTheBeamAbove) {
  const SensorModel sensor(table({10, 7, 2, -5}));
  EXPECT_NEAR(sensor.spacingAbove(0), 3 * kDegree, 1e-12);  // repeats its lower gap
  EXPECT_NEAR(sensor.spacingAbove(1), 3 * kDegree, 1e-12);
  EXPECT_NEAR(sensor.spacingAbove(2), 5 * kDegree, 1e-12);
  EXPECT_NEAR(sensor.spacingAbove(3), 7 * kDegree, 1e-12);
}

TEST(SensorModel, ColumnsOfAPresetCanBeSet) {
  SensorOptions options = sensorNamed("os1_64");
  EXPECT_EQ(SensorModel(options).columns(), 1024);
  options.columns = 2048;
  EXPECT_EQ(SensorModel(options).columns(), 2048);
}

TEST(SensorOptions, DefaultsAreAccepted) {
  for (const SensorOptions& options : {SensorOptions(), uniform(2, 1, -1), table({1, -1})})
    EXPECT_NO_THROW(checkOptions(options));
}
TEST(SensorOptions, RefusesAnUnknownModelAndNamesTheKnown) {
  EXPECT_REFUSED(SensorModel{sensorNamed("hdl128")}, "model = hdl128", "vlp16");
  EXPECT_THROW(SensorModel{sensorNamed("")}, Error);
}
TEST(SensorOptions, RefusesAnglesThatHaveNoTangentForAnyModel) {
  EXPECT_REFUSED(checkOptions(table({1, 90})), "elevations_deg");
  EXPECT_REFUSED(checkOptions(uniform(16, 90, -1)), "fov_up_deg");
  EXPECT_REFUSED(checkOptions(uniform(16, 1, -90)), "fov_down_deg");
  SensorOptions options;
  options.elevations = {M_PI / 2};
  EXPECT_REFUSED(checkOptions(options), "elevations_deg = 90");
}

}  // namespace
}  // namespace polemcl::test_sensor_model
