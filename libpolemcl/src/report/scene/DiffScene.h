#pragma once
/// \file DiffScene.h
/// \brief What changed between two maps as a 3D scene of stock MRPT objects.

#include <string>

#include <polemcl/mrpt/common/Compatibility.h>
#include "core/mapping/MapDiff.h"

namespace polemcl::report {

/// \brief An OverviewScene: grey what stayed, green what is new, orange what vanished, blue what
/// moved, with a ribbon from its old place; a legend with the number of each.
///
/// Names of the objects: `same`, `new`, `vanished`, `moved`, each with `<name> dots`; `moves`.
/// \throws Error when both maps are empty.
viz::Scene::Ptr makeDiffScene(const MapDiff& diff, const std::string& title = "");

}  // namespace polemcl::report
