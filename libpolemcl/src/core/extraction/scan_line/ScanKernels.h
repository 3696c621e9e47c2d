#pragma once
/// \file ScanKernels.h
/// \brief The loops over all points and segments, vectorised and chosen at run time. Private to the
/// library.
///
/// Only IEEE-exact operations (no fused multiply-add, no reciprocal estimates but where an exact
/// check decides), so that every instruction set gives the same bits.

#include <cmath>

#include "core/extraction/scan_line/GroundKernels.h"
#include "core/extraction/scan_line/ScanLines.h"

namespace polemcl {

/// \brief Positions of the bits that are set, for each byte.
struct SetBits {
  constexpr SetBits() {
    for (int byte = 0; byte < 256; ++byte) {
      int n = 0;
      for (int bit = 0; bit < 8; ++bit)
        if ((byte >> bit & 1) != 0) of[byte][n++] = static_cast<std::uint8_t>(bit);
    }
  }
  std::uint8_t of[256][8] = {};
};
inline constexpr SetBits kSetBits;

/// \brief Where returns are written: a stream for each half turn of each row, in the order of the
/// cloud, so that a cloud in the order of rings or firings fills sorted streams.
struct ReturnStreams {
  Return* returns;
  /// In and out, per stream 2 * row + (azimuth >= 0), and for what is out of view: where its next
  /// return is written. It is counted up beyond `end`, but nothing is written there.
  std::uint32_t* next;
  const std::uint32_t* end;
};

/// \brief Returns of the points that lie above a limit.
/// \param cell,level Per point, see GroundGrid. \param limit Per cell: least level, m.
/// \param rows Beams.
void classifyPoints(const PointsView& points, const std::uint16_t* cell, const float* level,
                    const float* limit, const RingLookup& lookup, int rows,
                    const ReturnStreams& out);

/// \brief The first i from `from` on for which return i + 1 does not have a greater azimuth than
/// return i; `count`: all have.
std::size_t findDisorder(const Return* returns, std::size_t count, std::size_t from);

/// \brief Widest gap, m, that neighbours up to two `gap`s apart may have between them.
constexpr float kBridge = 0.15f;

/// \brief True when returns a and b, `turn` rad apart, are neighbours on one surface: ranges differ
/// by less than `step`, and the azimuth by less than `gap` (twice that where it is < kBridge).
inline bool joined(const Return& a, const Return& b, float turn, float step, float gap) {
  return std::abs(b.rho - a.rho) < step &&
         (turn < gap || (turn < 2 * gap && turn * a.rho < kBridge));
}

/// \brief Where runs of neighbours in a row end, and what lies beside each return.
struct RowEdges {
  float *azimuth, *rho;  ///< buffers; two numbers before the first can be read
  /// Out, per return at a break or behind one: Side::… to the left, and to the right times 4, if
  /// the run ended there. Not of the first and last two, whose neighbours may be across the seam.
  std::int32_t* sides;
  /// Out, ascending: positions i in [0, count - 1) where returns i and i + 1 are not joined().
  std::uint32_t* breaks;
};

/// \brief Finds the edges in a row. \param edge m: least step to what lies behind.
/// \param out Room for count + kKernelPadding each. \return Number of breaks.
std::size_t findEdges(const Return* returns, std::size_t count, float step, float gap, float edge,
                      const RowEdges& out);

/// \brief Tips of clusters in one cell of the plane.
struct TipBlock {
  static constexpr int kSlots = 4;
  float x[kSlots], y[kSlots], z[kSlots];  ///< m; z is infinite where the slot is free
  std::int32_t row[kSlots];
  std::uint32_t cluster[kSlots];
  std::uint32_t cell, next;  ///< another block of the same cell; 0: none
};

/// \brief A segment that looks for a tip above it.
struct TipQuery {
  float x, y, z;  ///< m
  std::int32_t row;
  float gap;             ///< greatest height of the tip above it, m
  std::uint32_t corner;  ///< of the four cells that are searched: the one of least x and y
};

constexpr std::uint32_t kNoCluster = ~0u;

/// \brief Tips by the cells of a square grid.
struct TipGrid {
  const TipBlock* blocks;      ///< number 0 is empty, and of kNoCluster
  const std::uint32_t* first;  ///< per cell: its first block; 0: none
  std::uint32_t cells;         ///< per side
  float squaredReach;          ///< greatest squared distance in the plane, m²
};

/// \brief For each query the cluster with the nearest tip in four cells, from another row and
/// within reach; of two tips at the same distance the one of the lower number. kNoCluster: none.
void findNearestTips(const TipGrid& grid, const TipQuery* queries, std::size_t count,
                     std::uint32_t* clusters);

}  // namespace polemcl
