#pragma once
/// \file DetectionModelFile.h
/// \brief Detection models as JSON.

#include <filesystem>

#include "sim/detections/DetectionModel.h"

namespace polemcl::sim {

/// \brief Reads a model. \throws Error with file and key: not readable, not JSON, other format,
/// missing or unknown key, value of the wrong type or out of range.
DetectionModel readDetectionModel(const std::filesystem::path& file);

/// \brief Writes the model atomically, numbers with three digits. \throws Error when it cannot be
/// written.
void writeDetectionModel(const std::filesystem::path& file, const DetectionModel& model);

}  // namespace polemcl::sim
