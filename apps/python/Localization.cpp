#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <memory>
#include <optional>

#include <polemcl/localizer/Localizer.h>
#include "python/Arrays.h"
#include "python/Classes.h"
#include "python/Lock.h"
#include "python/Maps.h"

namespace py = pybind11;

namespace polemcl::apps::python {
namespace {

LocalizationMap localizationMap(const PoleMap& map, const AllSettings& settings) {
  auto poleMap = std::make_shared<CPoleMap>();
  poleMap->likelihoodOptions = settings.likelihood;  // first: the index is prepared for its gate
  poleMap->setPoles(map.content.map.poles);
  return {poleMap};
}

Localizer localizerOf(const PoleMap& map, const AllSettings& settings, std::uint32_t seed) {
  return withoutLock(
      [&] { return Localizer(Settings(settings), localizationMap(map, settings), seed); });
}

/// A polemcl::Localizer with its lock.
class DriveLocalizer {
 public:
  DriveLocalizer(const std::shared_ptr<PoleMap>& map, const std::filesystem::path& configFile,
                 const py::dict& values, std::optional<std::uint32_t> seed)
      : m_settings(settingsFrom(configFile, values)),
        m_localizer(localizerOf(*map, m_settings, seed.value_or(m_settings.runs.seed))) {}

  void start(const py::object& pose, std::optional<double> radius, std::optional<double> heading) {
    const Pose2D at = poseFrom(pose, "pose");
    alone(m_mutex, [&] { m_localizer.start(at, radius, heading); });
  }

  void startAnywhere() {
    alone(m_mutex, [&] { m_localizer.startAnywhere(); });
  }

  void startWithin(double x, double y, double radius) {
    alone(m_mutex, [&] { m_localizer.startWithin(x, y, radius); });
  }

  LocalizationUpdate step(double time, const py::object& motion, const py::object& covariance,
                          const py::object& poles, const py::object& velocity) {
    PoleScan frame;
    frame.time = time;
    frame.poles_robot = detectionsFrom(poles);
    if (!motion.is_none()) frame.motion = motionFrom(motion, covariance);
    if (!velocity.is_none()) frame.velocity = velocityFrom(velocity);
    return alone(m_mutex, [&] { return m_localizer.step(frame); });
  }

  py::array particles() {
    return toArray(alone(m_mutex, [&] {
      const LocalizationPipeline& pipeline = m_localizer.pipeline();
      return pipeline.hasPose() ? pipeline.filter().particles() : std::vector<Pose2D>();
    }));
  }

 private:
  PoseWithCovariance motionFrom(const py::object& motion, const py::object& covariance) const {
    const Pose2D mean = poseFrom(motion, "motion");
    if (covariance.is_none()) return {mean, motionCovariance(mean, m_settings.motion)};
    return {mean, m_settings.motion.covarianceFactor * covarianceFrom(covariance)};
  }

  std::mutex m_mutex;
  AllSettings m_settings;
  Localizer m_localizer;
};

const char* nameOf(OdometryVerdict verdict) {
  switch (verdict) {
    case OdometryVerdict::agrees:
      return "agrees";
    case OdometryVerdict::contradicted:
      return "contradicted";
    case OdometryVerdict::unknown:
      break;
  }
  return "unknown";
}

void addUpdate(py::module_& module) {
  py::class_<PoseWithCovariance>(module, "Estimate", "A pose on the map.")
      .def_property_readonly(
          "mean", [](const PoseWithCovariance& pose) { return toArray(pose.mean); },
          "(3,): x, y (m), yaw (rad).")
      .def_property_readonly(
          "covariance", [](const PoseWithCovariance& pose) { return toArray(pose.covariance); },
          "(3, 3), of x, y, yaw.");
  py::class_<Health>(module, "Health", "What speaks against the pose: share/doc/health.md.")
      .def_property_readonly(
          "state", [](const Health& health) { return name(health.state); },
          "'ok', 'degraded' or 'lost'.")
      .def_property_readonly("reason", [](const Health& health) { return name(health.reason); })
      .def_readonly("matched_share", &Health::matchedShare)
      .def_readonly("seen_share", &Health::seenShare)
      .def_readonly("innovation", &Health::innovation)
      .def_readonly("effective_particles", &Health::effectiveParticles)
      .def_readonly("mode_share", &Health::modeShare)
      .def_readonly("spread", &Health::spread, "m")
      .def_readonly("spread_heading", &Health::spreadHeading, "rad")
      .def("__repr__", [](const Health& health) {
        return std::string("<Health ") + name(health.state) + ", " + name(health.reason) + ">";
      });
  py::class_<LocalizationUpdate>(module, "LocalizationUpdate", "What one scan brought.")
      .def_readonly("time", &LocalizationUpdate::time, "s")
      .def_property_readonly(
          "estimate",
          [](const LocalizationUpdate& update) -> py::object {
            return update.estimate ? py::cast(*update.estimate) : py::none();
          },
          "An Estimate; None while no pose is known.")
      .def_property_readonly("health",
                             [](const LocalizationUpdate& update) { return update.health; })
      .def_readonly("poles", &LocalizationUpdate::poles, "Number of poles in the scan.")
      .def_readonly("relocalized", &LocalizationUpdate::relocalized,
                    "True: the global search moved the pose to this place.")
      .def_property_readonly(
          "odometry", [](const LocalizationUpdate& update) { return nameOf(update.motion); },
          "What the poles say of the motion: 'agrees', 'contradicted' or 'unknown'.");
}

}  // namespace

void addLocalization(py::module_& module) {
  addUpdate(module);
  py::class_<DriveLocalizer>(module, "Localizer",
                             "Localizes one drive, as a run of pole-localize does.")
      .def(py::init<const std::shared_ptr<PoleMap>&, const std::filesystem::path&, const py::dict&,
                    std::optional<std::uint32_t>>(),
           py::arg("map").none(false), py::arg("config_file") = "",
           py::arg("settings") = py::dict(), py::arg("seed") = py::none(),
           "seed: None takes that of [runs].")
      .def("start", &DriveLocalizer::start, py::arg("pose"), py::arg("radius") = py::none(),
           py::arg("heading") = py::none(),
           "pose: x, y (m), yaw (rad) at the first scan, right within radius (m) and heading "
           "(rad); None takes those of [start].")
      .def("start_anywhere", &DriveLocalizer::startAnywhere,
           "No pose is known: the whole map is searched during the drive.")
      .def("start_within", &DriveLocalizer::startWithin, py::arg("x"), py::arg("y"),
           py::arg("radius"),
           "The heading is not known: the map is searched within radius of x, y (m).")
      .def("initialize_globally", &DriveLocalizer::startAnywhere, "The former name.")
      .def("step", &DriveLocalizer::step, py::arg("time"), py::arg("motion"), py::arg("covariance"),
           py::arg("poles"), py::arg("velocity") = py::none(),
           "The next scan. time: s; motion: x, y, yaw since the scan before, in the frame of the "
           "robot then, None for the first scan; covariance: (3, 3) of it, None: by [motion]; "
           "poles: of PoleExtractor; velocity: x, y (m/s), yaw (rad/s) at the scan, None: as the "
           "motions tell. Returns a LocalizationUpdate.")
      .def_property_readonly("particles", &DriveLocalizer::particles,
                             "(n, 3): x, y, yaw of the particles; n = 0 while no pose is known.");
}

}  // namespace polemcl::apps::python
