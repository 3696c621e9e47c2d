#include "python/Maps.h"

#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <cmath>
#include <memory>

#include <polemcl/core/localization/PoleLikelihood.h>
#include <polemcl/core/mapping/PoleMapBuilder.h>
#include "core/common/DetectionCheck.h"
#include "core/common/PoleIndex.h"
#include "core/mapping/LandmarkFusion.h"
#include "python/Arrays.h"
#include "python/Classes.h"
#include "python/Lock.h"

namespace py = pybind11;

namespace polemcl::apps::python {

PoleMap::PoleMap(MapContent mapContent)
    : content(std::move(mapContent)), index(content.map.poles) {}

namespace {

using MapPtr = std::shared_ptr<PoleMap>;
using Facts = std::map<std::string, std::string>;

MapPtr mapOf(const py::object& poles, const Facts& info) {
  MapContent content;
  content.map.poles = mapPolesFrom(poles);
  content.map.info = info;
  return withoutLock([&] {
    io::requireSound(content.map, "");
    return std::make_shared<PoleMap>(std::move(content));
  });
}

MapPtr load(const std::filesystem::path& file) {
  return withoutLock([&] { return std::make_shared<PoleMap>(readMapFile(file)); });
}

/// The array `polemeans` of the authors' program: x, y, radius of each pole.
void saveNpz(const PoleMap& map, const std::filesystem::path& file) {
  const std::vector<MapPole>& poles = map.content.map.poles;
  py::array_t<double> means({static_cast<py::ssize_t>(poles.size()), py::ssize_t{3}});
  double* mean = means.mutable_data();
  for (const MapPole& pole : poles)
    for (const double value : {pole.x, pole.y, pole.radius}) *mean++ = value;
  py::module_::import("numpy").attr("savez")(file, py::arg("polemeans") = means);
}

void save(const PoleMap& map, const std::filesystem::path& file) {
  if (file.extension() == ".npz") return saveNpz(map, file);
  withoutLock([&] { writeMapFile(file, map.content); });
}

/// Index (-1: none) and distance (infinite: none) of the nearest pole of each place.
py::tuple nearest(const PoleMap& map, const py::object& places, double radius) {
  const std::vector<double> xy = numbersFrom(places, "places", {-1, 2});
  if (!(radius > 0))
    throw Error("radius: a number above 0 is needed, not " + std::to_string(radius));
  const auto count = static_cast<py::ssize_t>(xy.size() / 2);
  py::array_t<std::int64_t> indices(count);
  py::array_t<double> distances(count);
  std::int64_t* index = indices.mutable_data();
  double* distance = distances.mutable_data();
  withoutLock([&] {
    for (std::size_t i = 0; i < xy.size(); i += 2) {
      const auto pole = map.index.nearest(xy[i], xy[i + 1], radius);
      *index++ = pole ? static_cast<std::int64_t>(pole->index) : -1;
      *distance++ = pole ? pole->distance : INFINITY;
    }
  });
  return py::make_tuple(indices, distances);
}

/// Collects scans until the map is built.
class Builder {
 public:
  Builder(const std::filesystem::path& configFile, const py::dict& settings)
      : m_options(settingsFrom(configFile, settings).map) {}

  void add(const py::object& pose, const py::object& poles, const py::object& velocity,
           std::uint32_t drive) {
    MappingScan scan;
    scan.pose_map_robot = poseFrom(pose, "pose");
    scan.poles_robot = detectionsFrom(poles);
    keepMostConfident(scan.poles_robot);
    scan.drive = drive;
    if (!velocity.is_none()) deskew(scan.poles_robot, velocityFrom(velocity));
    alone(m_mutex, [&] {
      checkScan(scan.pose_map_robot, scan.poles_robot, "scan " + std::to_string(m_scans.size()));
      m_scans.push_back(std::move(scan));
    });
  }

  MapPtr build() {
    return alone(m_mutex, [&] {
      MapContent content;
      content.map.poles = buildPoleMap(m_scans, m_options).poles;
      return std::make_shared<PoleMap>(std::move(content));
    });
  }

 private:
  std::mutex m_mutex;
  PoleMapOptions m_options;
  std::vector<MappingScan> m_scans;
};

/// The likelihood with an index that is prepared for its gate. Never changed.
class Likelihood {
 public:
  Likelihood(const MapPtr& map, const std::filesystem::path& configFile, const py::dict& settings)
      : m_options(settingsFrom(configFile, settings).likelihood),
        m_index(map->content.map.poles, m_options.gate) {}

  py::array logLikelihoods(const py::object& polesArray, const py::object& posesArray) const {
    const std::vector<PoleDetection> poles = detectionsFrom(polesArray);
    const std::vector<Pose2D> poses = posesFrom(posesArray);
    std::vector<double> result;
    withoutLock([&] { polemcl::logLikelihoods(poles, poses, m_index, m_options, result); });
    return toArray(result);
  }

 private:
  LikelihoodOptions m_options;
  PoleIndex m_index;
};

}  // namespace

void addMaps(py::module_& module) {
  py::class_<PoleMap, MapPtr>(module, "PoleMap", "Poles in the frame of the map. Never changed.")
      .def(py::init(&mapOf), py::arg("poles"), py::arg("info") = Facts(),
           "poles: an array of map_pole_type; info: facts about the map, name -> text.")
      .def_static("load", &load, py::arg("file"),
                  "From .polemap, .csv, .npz or .geojson, as pole-map convert reads them.")
      .def("save", &save, py::arg("file"),
           "To .polemap, .csv or .geojson, as pole-map convert writes them; to .npz by "
           "numpy.savez: the array polemeans, x, y, radius of each pole.")
      .def_property_readonly(
          "poles", [](const PoleMap& map) { return toArray(map.content.map.poles); },
          "A copy of the poles, an array of map_pole_type.")
      .def_property_readonly("info", [](const PoleMap& map) { return map.content.map.info; })
      .def("__len__", [](const PoleMap& map) { return map.content.map.poles.size(); })
      .def("nearest", &nearest, py::arg("places"), py::arg("radius") = INFINITY,
           "places: (n, 2), m. Returns the index of the nearest pole nearer than radius (-1: none) "
           "and its distance (infinite: none), two arrays (n,).");
  py::class_<Builder>(module, "PoleMapBuilder", "Makes a map from detections at known poses.")
      .def(py::init<const std::filesystem::path&, const py::dict&>(), py::arg("config_file") = "",
           py::arg("settings") = py::dict())
      .def("add", &Builder::add, py::arg("pose"), py::arg("poles"),
           py::arg("velocity") = py::none(), py::arg("drive") = 0,
           "The next scan. pose: x, y, yaw of the robot on the map; poles: of PoleExtractor; "
           "velocity: x, y (m/s), yaw (rad/s) of the robot, corrects poles with a time_offset; "
           "drive: another number begins another drive.")
      .def("build", &Builder::build, "Returns the PoleMap of all scans so far.");
  py::class_<Likelihood>(module, "PoleLikelihood", "How well poses explain detections.")
      .def(py::init<const MapPtr&, const std::filesystem::path&, const py::dict&>(),
           py::arg("map").none(false), py::arg("config_file") = "",
           py::arg("settings") = py::dict())
      .def("log_likelihoods", &Likelihood::logLikelihoods, py::arg("poles"), py::arg("poses"),
           "poles: of PoleExtractor; poses: (n, 3), x, y, yaw on the map. Returns (n,): the "
           "natural logarithm of the likelihood up to a constant.");
}

}  // namespace polemcl::apps::python
