#pragma once
/// \file LabelledScans.h
/// \brief What a simulated folder knows beyond the scans: labels of the points, the true poles.

#include <cstdint>
#include <filesystem>
#include <vector>

#include "core/evaluation/PoleVisibility.h"
#include "io/data/Cloud.h"

namespace polemcl::io {

struct LabelledCloud {
  Cloud cloud;
  std::vector<std::uint32_t> labels;  ///< one per point of the cloud
};

/// \brief A KITTI `.bin` with its `.label` (uint32, little-endian, one per point). Points that
/// readKittiBin() would drop are dropped with their labels.
/// \throws Error when either cannot be read, or their numbers of points differ.
LabelledCloud readLabelledCloud(const std::filesystem::path& bin,
                                const std::filesystem::path& label);

/// \brief `labels/000012.label` of a folder for its `velodyne/000012.bin`.
std::filesystem::path labelFile(const std::filesystem::path& bin);

/// \brief `poles_gt.csv`: columns id, x, y, radius, top. \throws Error naming file and line.
std::vector<WorldPole> readWorldPoles(const std::filesystem::path& file);

}  // namespace polemcl::io
