#pragma once
/// \file PoleStacks.h
/// \brief Step B2, native: slices of several beams, one above the other, make a candidate.

#include <polemcl/core/Slices.h>

#include <cstdint>
#include <vector>

namespace polemcl {

/// \brief Slices that stand above one another; indices into the slices, topmost first.
struct Stack {
  std::vector<std::uint32_t> slices;
};

/// \brief Stacks the slices from the top row down; every slice joins the nearest stack above it
/// whose last slice lies within reach, or starts its own. Keeps its buffers between scans.
class SliceStacker {
 public:
  SliceStacker(const SensorModel& sensor, const NativeOptions& options);
  /// \brief Stacks of at least two slices. Valid until the next call.
  /// \param slices As findSlices() gives them: rows ascending.
  std::size_t stack(const std::vector<Slice>& slices);
  const Stack& at(std::size_t i) const { return m_stacks[m_kept[i]]; }

 private:
  static constexpr int kBins = 1024;
  struct Node {
    std::uint32_t stack;
    std::int32_t next;
  };
  int bin(float azimuth) const;
  std::int32_t nearestStack(const std::vector<Slice>& slices, const Slice& slice) const;
  void enter(std::uint32_t stack, float azimuth);
  Stack& open();

  const SensorModel& m_sensor;
  NativeOptions m_options;
  std::vector<Stack> m_stacks;  ///< reused; the first m_used are this scan's
  std::size_t m_used = 0;
  std::vector<std::uint32_t> m_kept;
  std::vector<std::int32_t> m_head;
  std::vector<Node> m_nodes;
};

}  // namespace polemcl
