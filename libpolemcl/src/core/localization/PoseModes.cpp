#include "core/localization/PoseModes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numeric>

namespace polemcl {
namespace {

using Cell = std::array<std::int64_t, 3>;  // x, y, heading

constexpr std::int64_t kHeadings = 24;    // cells of modeCellYaw round the circle
constexpr double kLeastCellShare = 1e-6;  // share of a cell below which it joins nothing

Cell poseCellOf(const Pose2D& pose) {
  const auto index = [](double value, double size) {
    return static_cast<std::int64_t>(std::floor(value / size));
  };
  const std::int64_t heading = index(wrapAngle(pose.yaw) + M_PI, modeCellYaw);
  return {index(pose.x, modeCell), index(pose.y, modeCell),
          ((heading % kHeadings) + kHeadings) % kHeadings};
}

/// Cells with their weight and the place they belong to.
struct Occupied {
  double weight = 0;
  int place = -1;
};

std::vector<double> normalized(const std::vector<double>& logWeights) {
  const double most = *std::max_element(logWeights.begin(), logWeights.end());
  std::vector<double> weights;
  double sum = 0;
  for (const double w : logWeights) {
    weights.push_back(std::exp(w - most));
    sum += weights.back();
  }
  for (double& w : weights) w /= sum;
  return weights;
}

/// Marks all cells that touch `start`, and those that touch these, as one place.
void flood(std::map<Cell, Occupied>& cells, const Cell& start, int place) {
  std::vector<Cell> open{start};
  cells[start].place = place;
  while (!open.empty()) {
    const Cell cell = open.back();
    open.pop_back();
    for (int i = 0; i < 27; ++i) {
      const Cell next{cell[0] + i % 3 - 1, cell[1] + i / 3 % 3 - 1,
                      (cell[2] + i / 9 - 1 + kHeadings) % kHeadings};
      const auto found = cells.find(next);
      if (found == cells.end() || found->second.place >= 0) continue;
      found->second.place = place;
      open.push_back(next);
    }
  }
}

}  // namespace

PoseMode heaviestMode(const std::vector<Pose2D>& particles, const std::vector<double>& logWeights) {
  PoseMode mode;
  mode.estimate = weightedMean(particles, logWeights);  // refuses what cannot be used
  const Pose2D& mean = mode.estimate.mean;
  const bool together = std::all_of(particles.begin(), particles.end(), [&](const Pose2D& p) {
    return std::abs(p.x - mean.x) < 0.5 * modeCell && std::abs(p.y - mean.y) < 0.5 * modeCell &&
           std::abs(wrapAngle(p.yaw - mean.yaw)) < 0.5 * modeCellYaw;
  });
  if (together) return mode;

  const std::vector<double> weights = normalized(logWeights);
  std::map<Cell, Occupied> all;
  for (std::size_t i = 0; i < particles.size(); ++i)
    all[poseCellOf(particles[i])].weight += weights[i];
  std::map<Cell, Occupied> cells;  // a few lost particles are no bridge between places
  for (const auto& [cell, occupied] : all)
    if (occupied.weight > kLeastCellShare) cells[cell] = occupied;

  std::vector<double> shares;
  for (const Pose2D& particle : particles) {
    const auto found = cells.find(poseCellOf(particle));
    if (found == cells.end() || found->second.place >= 0) continue;
    flood(cells, found->first, static_cast<int>(shares.size()));
    shares.push_back(0);
  }
  for (const auto& [cell, occupied] : cells) shares[occupied.place] += occupied.weight;
  const auto best = std::max_element(shares.begin(), shares.end());
  mode.share = std::min(1.0, *best);
  if (shares.size() == 1) return mode;

  std::vector<double> inside(logWeights);
  for (std::size_t i = 0; i < particles.size(); ++i) {
    const auto found = cells.find(poseCellOf(particles[i]));
    if (found == cells.end() || found->second.place != best - shares.begin()) inside[i] = -INFINITY;
  }
  mode.estimate.mean = weightedMean(particles, inside).mean;
  mode.estimate.covariance = covarianceAbout(mode.estimate.mean, particles, logWeights);
  return mode;
}

}  // namespace polemcl
