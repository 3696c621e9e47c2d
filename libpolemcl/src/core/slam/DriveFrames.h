#pragma once
/// \file DriveFrames.h
/// \brief Brings drives into one frame where loops lead from one to the other. Private to the
/// library.

#include <vector>

#include "core/slam/LoopSearch.h"

namespace polemcl {

/// \brief Moves the poses of a frame and the poles of its tracks, which belong to another frame
/// then. \param motion From the frame `from` to the frame `to`.
void moveFrame(std::size_t from, std::size_t to, const Pose2D& motion, const PoleTracks& tracks,
               std::vector<std::size_t>& frames, AdjustedState& state);

/// \brief Moves the poses and poles of drives to the frame of earlier ones, by the rigid motion
/// that most of the loops between them agree on, two at least. \param loops Those that lead to a
/// drive still in another frame, or disagree, are removed. \param frames Of each scan, see
/// findLoops(). \return Whether anything was connected.
bool connectFrames(std::vector<Loop>& loops, const PoleTracks& tracks,
                   std::vector<std::size_t>& frames, AdjustedState& state);

}  // namespace polemcl
