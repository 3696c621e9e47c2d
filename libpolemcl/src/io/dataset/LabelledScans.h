#pragma once
/// \file LabelledScans.h
/// \brief Ground truth of a simulated folder: labels of the points and the true poles.

#include <cstdint>
#include <filesystem>
#include <vector>

#include <polemcl/io/data/Cloud.h>
#include "core/evaluation/DetectionEvaluation.h"

namespace polemcl::io {

struct LabelledCloud {
  Cloud cloud;
  std::vector<std::uint32_t> labels;  ///< one per point of the cloud
};

/// \brief Reads a KITTI `.bin` with its `.label` file (uint32, little-endian, one per point).
/// Points that readKittiBin() drops are dropped together with their labels.
/// \throws Error when a file cannot be read, or the numbers of points and labels differ.
LabelledCloud readLabelledCloud(const std::filesystem::path& bin,
                                const std::filesystem::path& label);

/// \brief Path of the label file: `labels/000012.label` for `velodyne/000012.bin`.
std::filesystem::path labelFile(const std::filesystem::path& bin);

/// \brief Reads `poles_gt.csv`: columns id, x, y, radius, top. \throws Error with file and line.
std::vector<WorldPole> readWorldPoles(const std::filesystem::path& file);

}  // namespace polemcl::io
