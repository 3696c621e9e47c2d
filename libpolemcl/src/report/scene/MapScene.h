#pragma once
/// \file MapScene.h
/// \brief The drive as a 3D scene of stock MRPT objects: SceneViewer3D opens it without a plugin.

#include <polemcl/mrpt/common/Compatibility.h>
#include "mrpt/drawing/SceneParts.h"
#include "report/picture/MapView.h"

namespace polemcl::report {

/// \brief Poles coloured by count, the estimate as a ribbon, the truth as one at either side of it,
/// loops as bars from place to place, ground and legend: an OverviewScene.
///
/// Names of the objects: `ground`, `poles`, `poles dots`, `truth`, `estimate`, `loops`.
/// \throws Error when there is nothing to show, or a coordinate is not finite.
viz::Scene::Ptr makeMapScene(const MapView& view);

}  // namespace polemcl::report
