#include "sim/world/SightLines.h"

#include <algorithm>
#include <cmath>

namespace polemcl::sim {
namespace {

/// The share of a line at which it enters a block; 1 if it does not enter.
double entry(const SightLines::Block& block, const Eigen::Vector2d& from,
             const Eigen::Vector2d& to) {
  const Eigen::Vector2d start = block.axes * (from - block.centre), step = block.axes * (to - from);
  double enter = 0, leave = 1;  // shares of the line inside the rectangle
  for (int i = 0; i < 2 && enter < leave; ++i) {
    const double inverse = 1 / (std::abs(step(i)) > 1e-12 ? step(i) : 1e-12);
    const double a = (-block.half(i) - start(i)) * inverse,
                 b = (block.half(i) - start(i)) * inverse;
    enter = std::max(enter, std::min(a, b));
    leave = std::min(leave, std::max(a, b));
  }
  return enter < leave ? enter : 1;
}

bool isA(Kind kind, Obstacle obstacle) {
  if (obstacle == Obstacle::mesh) return kind == Kind::siteFence;
  return kind == Kind::house || kind == Kind::wall || kind == Kind::hoarding ||
         kind == Kind::container;
}

}  // namespace

SightLines::SightLines(const World& world, Obstacle obstacle) {
  const Shape shape = obstacle == Obstacle::mesh ? Shape::thicket : Shape::box;
  // Lower obstacles hide nothing behind them.
  const double lowest = obstacle == Obstacle::mesh ? 0.8 : 1;
  constexpr double kSmallest = 0.5;  // m; drain pipes, sills and the like hide nothing
  for (const WorldObject& object : world.objects()) {
    if (!isA(object.kind, obstacle)) continue;
    for (const Solid& solid : object.solids) {
      if (solid.shape != shape || solid.size.head<2>().maxCoeff() < kSmallest) continue;
      if (solid.size.z() < lowest) continue;
      m_blocks.push_back({solid.position.head<2>(), solid.size.head<2>(),
                          solid.axes.topLeftCorner<2, 2>().transpose(),
                          solid.size.head<2>().norm()});
    }
  }
}

std::vector<const SightLines::Block*> SightLines::around(const Eigen::Vector2d& place,
                                                         double radius) const {
  std::vector<const Block*> found;
  for (const Block& block : m_blocks)
    if ((block.centre - place).squaredNorm() < (radius + block.reach) * (radius + block.reach))
      found.push_back(&block);
  return found;
}

bool SightLines::blocked(const std::vector<const Block*>& blocks, const Eigen::Vector2d& from,
                         const Eigen::Vector2d& to) {
  for (const Block* block : blocks)
    if (entry(*block, from, to) < 1) return true;
  return false;
}

double SightLines::freeWay(const std::vector<const Block*>& blocks, const Eigen::Vector2d& from,
                           const Eigen::Vector2d& to) {
  double share = 1;
  for (const Block* block : blocks) share = std::min(share, entry(*block, from, to));
  return share * (to - from).norm();
}

}  // namespace polemcl::sim
