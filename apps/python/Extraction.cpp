#include <mrpt/maps/CSimplePointsMap.h>
#include <mrpt/obs/CObservationPointCloud.h>
#include <pybind11/stl/filesystem.h>

#include <memory>

#include <polemcl/mrpt/observation/ObservationPoleExtractor.h>
#include "python/Arrays.h"
#include "python/Classes.h"
#include "python/Lock.h"

namespace py = pybind11;

namespace polemcl::apps::python {
namespace {

/// What pole-extract does with one scan.
class Extractor {
 public:
  Extractor(const std::filesystem::path& configFile, const py::dict& settings,
            const py::object& sensorPose)
      : m_extractor(settingsFrom(configFile, settings).poleExtraction()) {
    const auto pose = numbersFrom(sensorPose, "sensor_pose", {6});
    m_scan.sensorPose = mrpt::poses::CPose3D(pose[0], pose[1], pose[2], pose[3], pose[4], pose[5]);
    m_scan.pointcloud = std::make_shared<mrpt::maps::CSimplePointsMap>();
  }

  py::array extract(const py::object& array) {
    const Points points = pointsFrom(array);
    return toArray(alone(m_mutex, [&] {
      m_scan.pointcloud->setAllPoints(points.x, points.y, points.z);
      return m_extractor.process(m_scan)->polesInRobotFrame();
    }));
  }

  py::dict report() {
    const auto report = alone(m_mutex, [&] { return m_extractor.report(); });
    py::dict rejected;
    for (int i = 0; i < static_cast<int>(RejectionReason::count_); ++i)
      rejected[name(static_cast<RejectionReason>(i))] = report.refused[i];
    py::dict counts;
    counts["points"] = report.points;
    counts["invalid"] = report.invalid;
    counts["out_of_view"] = report.outOfView;
    counts["out_of_range"] = report.outOfRange;
    counts["candidates"] = report.candidates;
    counts["rejected"] = rejected;
    return counts;
  }

 private:
  std::mutex m_mutex;
  ObservationPoleExtractor m_extractor;
  mrpt::obs::CObservationPointCloud m_scan;
};

}  // namespace

void addExtraction(py::module_& module) {
  py::class_<Extractor>(module, "PoleExtractor", "Finds poles in scans, as pole-extract does.")
      .def(py::init<const std::filesystem::path&, const py::dict&, const py::object&>(),
           py::arg("config_file") = "", py::arg("settings") = py::dict(),
           py::arg("sensor_pose") = py::make_tuple(0, 0, 0, 0, 0, 0),
           "sensor_pose: x, y, z (m), yaw, pitch, roll (rad) of the LiDAR on the robot.")
      .def("extract", &Extractor::extract, py::arg("points"),
           "points: (n, 3) or (n, 4) of float32, one full turn: x, y, z in m, frame of the LiDAR.\n"
           "Returns the poles, an array of detection_type, in the frame of the robot. The first "
           "scans are compared with [sensor]; one that contradicts it is an Error.")
      .def_property_readonly("report", &Extractor::report,
                             "What became of the points and candidates of the last scan: counts.");
}

}  // namespace polemcl::apps::python
