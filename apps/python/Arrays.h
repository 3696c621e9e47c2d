#pragma once
/// \file Arrays.h
/// \brief NumPy arrays to the types of the library and back. All are copies: no array refers to
/// memory of the library, and no object of the library to an array.

#include <pybind11/numpy.h>

#include <Eigen/Core>
#include <string>
#include <vector>

#include <polemcl/core/common/Types.h>
#include "core/common/Deskew.h"

namespace polemcl::apps::python {

/// \brief Fields of an array of detections: those of PoleDetection.
pybind11::dtype detectionType();
/// \brief Fields of an array of map poles: those of MapPole.
pybind11::dtype mapPoleType();

/// \brief Coordinates of a scan, one vector each.
struct Points {
  std::vector<float> x, y, z;
};

/// \name From Python
/// Arrays may have any strides and byte order.
/// \throws Error naming the argument, what is needed and what was given.
/// @{
/// \brief Rows of x, y, z and, not used, an intensity. float32 only: nothing is rounded in silence.
Points pointsFrom(const pybind11::object& array);
/// \brief A structured array with the fields of detectionType(); `time_offset` and `turn_rate` may
/// be missing.
std::vector<PoleDetection> detectionsFrom(const pybind11::object& array);
/// \brief A structured array with the fields of mapPoleType().
std::vector<MapPole> mapPolesFrom(const pybind11::object& array);
/// \brief Numbers of an array of that shape, row by row; -1: any length.
std::vector<double> numbersFrom(const pybind11::object& array, const std::string& argument,
                                const std::vector<pybind11::ssize_t>& shape);
/// \brief x, y, yaw.
Pose2D poseFrom(const pybind11::object& array, const std::string& argument);
/// \brief Rows of x, y, yaw.
std::vector<Pose2D> posesFrom(const pybind11::object& array);
/// \brief 3 x 3, of x, y, yaw.
Eigen::Matrix3d covarianceFrom(const pybind11::object& array);
/// \brief x, y, yaw per second.
Velocity velocityFrom(const pybind11::object& array);
/// @}

/// \name To Python
/// @{
pybind11::array toArray(const std::vector<PoleDetection>& poles);
pybind11::array toArray(const std::vector<MapPole>& poles);
pybind11::array toArray(const std::vector<Pose2D>& poses);
pybind11::array toArray(const std::vector<double>& numbers);
pybind11::array toArray(const Pose2D& pose);
pybind11::array toArray(const Eigen::Matrix3d& matrix);
/// @}

}  // namespace polemcl::apps::python
