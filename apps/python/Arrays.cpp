#include "python/Arrays.h"

#include <algorithm>
#include <cstring>
#include <functional>

#include "python/Lock.h"

namespace py = pybind11;

namespace polemcl::apps::python {

/// One row of an array of detections. Counts are signed, so that differences are right.
struct DetectionRow {
  double x, y, radius, bottom, top, confidence, cov_xx, cov_xy, cov_yy, time_offset, turn_rate;
  std::int64_t points;
};

/// One row of an array of map poles.
struct MapPoleRow {
  double x, y, radius, bottom, top, confidence, cov_xx, cov_xy, cov_yy;
  std::int64_t count;
};

namespace {

/// What was given, for messages: `(10, 2) of float64`.
std::string described(const py::array& array) {
  std::string shape;
  for (py::ssize_t i = 0; i < array.ndim(); ++i)
    shape += (i > 0 ? ", " : "") + std::to_string(array.shape(i));
  if (array.ndim() == 1) shape += ',';
  return "(" + shape + ") of " + std::string(py::str(array.dtype()));
}

std::string described(const std::vector<py::ssize_t>& shape) {
  std::string text;
  for (std::size_t i = 0; i < shape.size(); ++i)
    text += (i > 0 ? ", " : "") + (shape[i] < 0 ? "n" : std::to_string(shape[i]));
  return "(" + text + (shape.size() == 1 ? ",)" : ")");
}

/// Any object as an array with NumPy's rules.
py::array arrayFrom(const py::object& object, const std::string& argument) {
  py::array array =
      object.is_none() ? py::array() : untilPythonEnds([&] { return py::array::ensure(object); });
  if (object.is_none() || !array)
    throw Error(argument + ": a NumPy array is needed, not " +
                std::string(py::str(py::type::of(object).attr("__name__"))));
  return array;
}

/// NumPy lets go of Python's lock while it copies.
template <class Number>
auto copyOf(const py::array& array, const std::string& argument) {
  using Copy = py::array_t<Number, py::array::c_style | py::array::forcecast>;
  Copy copy = untilPythonEnds([&] { return Copy::ensure(array); });
  if (!copy) throw Error(argument + ": cannot be copied; is there memory enough?");
  return copy;
}

bool hasShape(const py::array& array, const std::vector<py::ssize_t>& shape) {
  if (array.ndim() != static_cast<py::ssize_t>(shape.size())) return false;
  for (std::size_t i = 0; i < shape.size(); ++i)
    if (shape[i] >= 0 && array.shape(static_cast<py::ssize_t>(i)) != shape[i]) return false;
  return true;
}

/// A structured array of one dimension.
py::array recordsFrom(const py::object& object, const std::string& argument,
                      const std::string& type) {
  py::array array = arrayFrom(object, argument);
  if (array.ndim() != 1 || !array.dtype().has_fields())
    throw Error(argument + ": a structured array (n,) of polemcl." + type + " is needed, not " +
                described(array));
  return array;
}

std::vector<double> fieldOf(const py::array& records, const std::string& argument,
                            const char* name) {
  if (!records.dtype().attr("names").contains(name))
    throw Error(argument + ": the field '" + name + "' is missing; there are " +
                std::string(py::str(records.dtype().attr("names"))));
  return numbersFrom(records[name], argument + "['" + name + "']", {records.shape(0)});
}

/// A count from a column of numbers.
std::uint32_t countFrom(double value, const std::string& field) {
  if (!(value >= 0 && value <= 4294967295.0))
    throw Error(field + ": a count from 0 to 4294967295 is needed, not " + std::to_string(value));
  return static_cast<std::uint32_t>(value);
}

/// Fills a field of whole numbers of all poles.
template <class Pole, class Count>
void fillCounts(const py::array& records, const char* name, Count Pole::*field,
                std::vector<Pole>& poles) {
  const std::vector<double> values = fieldOf(records, "poles", name);
  for (std::size_t i = 0; i < poles.size(); ++i)
    poles[i].*field = countFrom(values[i], std::string("poles['") + name + "']");
}

/// The fields that detections and map poles share.
template <class Pole>
std::vector<Pole> polesFrom(const py::array& records, const std::string& argument) {
  std::vector<Pole> poles(static_cast<std::size_t>(records.shape(0)));
  const auto fill = [&](const char* name, const auto& set) {
    const std::vector<double> values = fieldOf(records, argument, name);
    for (std::size_t i = 0; i < poles.size(); ++i) set(poles[i], values[i]);
  };
  fill("x", [](Pole& pole, double value) { pole.x = value; });
  fill("y", [](Pole& pole, double value) { pole.y = value; });
  fill("radius", [](Pole& pole, double value) { pole.radius = value; });
  fill("bottom", [](Pole& pole, double value) { pole.bottom = value; });
  fill("top", [](Pole& pole, double value) { pole.top = value; });
  fill("confidence", [](Pole& pole, double value) { pole.confidence = value; });
  fill("cov_xx", [](Pole& pole, double value) { pole.covariance(0, 0) = value; });
  fill("cov_yy", [](Pole& pole, double value) { pole.covariance(1, 1) = value; });
  fill("cov_xy",
       [](Pole& pole, double value) { pole.covariance(0, 1) = pole.covariance(1, 0) = value; });
  return poles;
}

/// A row with the fields that detections and map poles share.
template <class Row, class Pole>
Row rowOf(const Pole& pole) {
  Row row = {};
  row.x = pole.x;
  row.y = pole.y;
  row.radius = pole.radius;
  row.bottom = pole.bottom;
  row.top = pole.top;
  row.confidence = pole.confidence;
  row.cov_xx = pole.covariance(0, 0);
  row.cov_xy = pole.covariance(0, 1);
  row.cov_yy = pole.covariance(1, 1);
  return row;
}

}  // namespace

py::dtype detectionType() {
  static const bool known = [] {
    PYBIND11_NUMPY_DTYPE(DetectionRow, x, y, radius, bottom, top, confidence, cov_xx, cov_xy,
                         cov_yy, time_offset, turn_rate, points);
    return true;
  }();
  static_cast<void>(known);
  return py::dtype::of<DetectionRow>();
}

py::dtype mapPoleType() {
  static const bool known = [] {
    PYBIND11_NUMPY_DTYPE(MapPoleRow, x, y, radius, bottom, top, confidence, cov_xx, cov_xy, cov_yy,
                         count);
    return true;
  }();
  static_cast<void>(known);
  return py::dtype::of<MapPoleRow>();
}

Points pointsFrom(const py::object& object) {
  const py::array array = arrayFrom(object, "points");
  const bool shaped = array.ndim() == 2 && (array.shape(1) == 3 || array.shape(1) == 4);
  if (!shaped || array.dtype().kind() != 'f' || array.itemsize() != sizeof(float))
    throw Error("points: an array (n, 3) or (n, 4) of float32 is needed, not " + described(array) +
                "; numpy.float32(points) converts numbers");
  const auto rows = copyOf<float>(array, "points");
  const auto values = rows.unchecked<2>();
  Points points;
  for (auto* axis : {&points.x, &points.y, &points.z})
    axis->resize(static_cast<std::size_t>(values.shape(0)));
  for (std::size_t i = 0; i < points.x.size(); ++i) {
    const auto row = static_cast<py::ssize_t>(i);
    points.x[i] = values(row, 0);
    points.y[i] = values(row, 1);
    points.z[i] = values(row, 2);
  }
  return points;
}

std::vector<PoleDetection> detectionsFrom(const py::object& object) {
  const py::array records = recordsFrom(object, "poles", "detection_type");
  auto poles = polesFrom<PoleDetection>(records, "poles");
  fillCounts(records, "points", &PoleDetection::points, poles);
  const py::object names = records.dtype().attr("names");
  const auto fillKnown = [&](const char* name, double PoleDetection::*field) {
    if (!names.contains(name)) return;
    const std::vector<double> values = fieldOf(records, "poles", name);
    for (std::size_t i = 0; i < poles.size(); ++i) poles[i].*field = values[i];
  };
  fillKnown("time_offset", &PoleDetection::timeOffset);
  fillKnown("turn_rate", &PoleDetection::turnRate);
  return poles;
}

std::vector<MapPole> mapPolesFrom(const py::object& object) {
  const py::array records = recordsFrom(object, "poles", "map_pole_type");
  auto poles = polesFrom<MapPole>(records, "poles");
  fillCounts(records, "count", &MapPole::count, poles);
  return poles;
}

std::vector<double> numbersFrom(const py::object& object, const std::string& argument,
                                const std::vector<py::ssize_t>& shape) {
  const py::array array = arrayFrom(object, argument);
  if (!hasShape(array, shape) || std::string("fiu").find(array.dtype().kind()) == std::string::npos)
    throw Error(argument + ": " + described(shape) + " of numbers is needed, not " +
                described(array));
  const auto values = copyOf<double>(array, argument);
  return {values.data(), values.data() + values.size()};
}

Pose2D poseFrom(const py::object& array, const std::string& argument) {
  const std::vector<double> values = numbersFrom(array, argument, {3});
  return {values[0], values[1], values[2]};
}

std::vector<Pose2D> posesFrom(const py::object& array) {
  const std::vector<double> values = numbersFrom(array, "poses", {-1, 3});
  std::vector<Pose2D> poses(values.size() / 3);
  for (std::size_t i = 0; i < poses.size(); ++i)
    poses[i] = {values[3 * i], values[3 * i + 1], values[3 * i + 2]};
  return poses;
}

Eigen::Matrix3d covarianceFrom(const py::object& array) {
  const std::vector<double> values = numbersFrom(array, "covariance", {3, 3});
  return Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(values.data());
}

Velocity velocityFrom(const py::object& array) {
  const Pose2D velocity = poseFrom(array, "velocity");
  return {velocity.x, velocity.y, velocity.yaw};
}

py::array toArray(const std::vector<PoleDetection>& poles) {
  detectionType();
  py::array_t<DetectionRow> array(static_cast<py::ssize_t>(poles.size()));
  std::transform(poles.begin(), poles.end(), array.mutable_data(), [](const PoleDetection& pole) {
    auto row = rowOf<DetectionRow>(pole);
    row.time_offset = pole.timeOffset;
    row.turn_rate = pole.turnRate;
    row.points = pole.points;
    return row;
  });
  return array;
}

py::array toArray(const std::vector<MapPole>& poles) {
  mapPoleType();
  py::array_t<MapPoleRow> array(static_cast<py::ssize_t>(poles.size()));
  std::transform(poles.begin(), poles.end(), array.mutable_data(), [](const MapPole& pole) {
    auto row = rowOf<MapPoleRow>(pole);
    row.count = pole.count;
    return row;
  });
  return array;
}

py::array toArray(const std::vector<Pose2D>& poses) {
  py::array_t<double> array({static_cast<py::ssize_t>(poses.size()), py::ssize_t{3}});
  double* out = array.mutable_data();
  for (const Pose2D& pose : poses)
    for (const double value : {pose.x, pose.y, pose.yaw}) *out++ = value;
  return array;
}

py::array toArray(const std::vector<double>& numbers) {
  py::array_t<double> array(static_cast<py::ssize_t>(numbers.size()));
  std::copy(numbers.begin(), numbers.end(), array.mutable_data());
  return array;
}

py::array toArray(const Pose2D& pose) {
  return toArray(std::vector<double>{pose.x, pose.y, pose.yaw});
}

py::array toArray(const Eigen::Matrix3d& matrix) {
  py::array_t<double> array({3, 3});
  for (int row = 0; row < 3; ++row)
    for (int column = 0; column < 3; ++column) array.mutable_at(row, column) = matrix(row, column);
  return array;
}

}  // namespace polemcl::apps::python
