#pragma once
/// \file MapScene.h
/// \brief Maps as 3D scenes of stock MRPT objects: SceneViewer3D opens them without a plugin.

#include <string>

#include <polemcl/mrpt/common/Compatibility.h>
#include "core/mapping/MapDiff.h"
#include "mrpt/drawing/SceneParts.h"
#include "report/picture/MapView.h"

namespace polemcl::report {

/// \brief A drive: poles coloured by count, the estimate as a ribbon, the truth as one at either
/// side of it, loops as bars from place to place, ground and legend: an OverviewScene.
///
/// Names of the objects: `ground`, `poles`, `poles dots`, `truth`, `estimate`, `loops`.
/// \throws Error when there is nothing to show, or a coordinate is not finite.
viz::Scene::Ptr makeMapScene(const MapView& view);

/// \brief What changed between two maps: grey what stayed, green what is new, orange what vanished,
/// blue what moved, with a ribbon from its old place; a legend with the number of each: an
/// OverviewScene.
///
/// Names of the objects: `same`, `new`, `vanished`, `moved`, each with `<name> dots`; `moves`.
/// \throws Error when both maps are empty.
viz::Scene::Ptr makeDiffScene(const MapDiff& diff, const std::string& title = "");

}  // namespace polemcl::report
