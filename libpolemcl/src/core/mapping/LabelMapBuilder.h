#pragma once
/// \file LabelMapBuilder.h
/// \brief Labelled points of a whole sequence -> the poles that really stand there.
///
/// As Dong, Chen and Stachniss (ECMR 2021) made their ground truth from SemanticKITTI: the points
/// of poles, trunks and traffic signs of all scans are put into the map frame and clustered; each
/// cluster is a pole. How exactly they did it is not published; here the points fall into columns
/// of the plane, columns near each other are one thing.

#include <Eigen/Geometry>
#include <cstdint>
#include <unordered_map>
#include <vector>

#include <polemcl/core/common/Types.h>

namespace polemcl {

/// \brief How labelled points become poles.
struct LabelMapOptions {
  /// Semantic classes, the lower 16 bits of a label, of upright stems: SemanticKITTI's trunk, pole.
  std::vector<std::uint32_t> stems{71, 80};
  /// Classes of what hangs on stems: traffic sign. A pole stands where its stem is; a sign without
  /// a stem is a pole of its own.
  std::vector<std::uint32_t> signs{81};
  double cell = 0.1;       ///< side of a column, m
  double link = 0.3;       ///< columns nearer than this, centre to centre, are one thing, m
  double maxWidth = 1.5;   ///< things wider than this are several poles, m
  double maxRange = 50;    ///< points farther from the LiDAR are not used, m
  double minHeight = 0.5;  ///< poles reach at least from their lowest to so far above it, m
  int minScans = 3;        ///< poles were seen in at least this number of scans
  int minPoints = 20;      ///< and have at least this number of points
  void validate() const;   ///< \throws Error naming the field
};

/// \brief Takes scan after scan; keeps columns only, however many points there are.
class LabelMapBuilder {
 public:
  /// \throws Error on options out of range.
  explicit LabelMapBuilder(const LabelMapOptions& options = {});

  /// \brief One scan. \param T_map_lidar Pose of the frame of the points, map z up.
  /// \param labels One a point; the upper 16 bits (instance) are not looked at.
  /// \throws Error on a pose that is not finite, and when the numbers of points and labels differ.
  void add(const Eigen::Isometry3d& T_map_lidar, const PointsView& points,
           const std::vector<std::uint32_t>& labels);

  std::size_t scans() const { return m_scans; }
  std::size_t points() const { return m_points; }           ///< of these classes, within range
  std::size_t columns() const { return m_columns.size(); }  ///< held in memory

  /// \brief The poles, sorted by x then y: centre of the columns of its stem, radius of a disc that
  /// spreads as they do, `top` the height from lowest to highest point (`bottom` 0), `count` the
  /// scans that saw it, confidence 1. The same for any order of the points in a scan.
  std::vector<MapPole> poles() const;

 private:
  struct Column {
    double x = 0, y = 0;  ///< sums, m
    float lowest = 0, highest = 0;
    std::uint32_t points = 0, scans = 0, lastScan = 0;
  };
  using Columns = std::unordered_map<std::uint64_t, Column>;
  void put(const Eigen::Vector3d& point, bool sign);

  LabelMapOptions m_options;
  Columns m_columns;  ///< by packed cell, stems and signs apart
  std::size_t m_scans = 0, m_points = 0;
};

}  // namespace polemcl
