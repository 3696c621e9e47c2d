#pragma once
/// \file DetectionModelFile.h
/// \brief Detection models as JSON.

#include <filesystem>

#include "sim/detections/DetectionModel.h"

namespace polemcl::sim {

/// \brief \throws Error naming the file and the key: cannot be read, no JSON, another format, a key
/// missing or not known, a value of the wrong type or out of range.
DetectionModel readDetectionModel(const std::filesystem::path& file);

/// \brief Writes it, atomically, numbers with three digits. \throws Error when it cannot be
/// written.
void writeDetectionModel(const std::filesystem::path& file, const DetectionModel& model);

}  // namespace polemcl::sim
