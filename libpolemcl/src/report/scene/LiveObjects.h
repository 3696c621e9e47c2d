#pragma once
/// \file LiveObjects.h
/// \brief The single objects of a LiveScene.

#include <vector>

#include "mrpt/drawing/SceneParts.h"
#include "report/scene/LiveMoment.h"

namespace polemcl::report::live {

using scene::TColor;

/// Told apart by lightness too, for those who do not see all colours.
inline const TColor mapColor(0x8a, 0x93, 0x9f), matchedColor(0x00, 0x9e, 0x63),
    unmatchedColor(0xe0, 0x4f, 0x10), hypothesisColor(0x8e, 0x44, 0xad),
    particleColor(0x6a, 0x1b, 0x9a), particleLight(0xe9, 0xa8, 0xd8),
    ellipseColor(0x10, 0x10, 0x10), lowPoint(0xb7, 0xc8, 0xdc), highPoint(0x2b, 0x4c, 0x7e);

/// Colour of the words and of the vehicle: green, amber, red.
TColor colorOf(HealthState state);
/// Colour of paths and of the time line: blue, yellow, red.
TColor pathColorOf(HealthState state);

viz::CSetOfObjects::Ptr makeMap(const std::vector<MapPole>& poles);
/// For views from far above, where cylinders are thinner than a pixel.
viz::CPointCloudColoured::Ptr makeDots(const std::vector<MapPole>& poles, double pointSize);
/// Observed poles whose match is `matched`, at the estimate.
viz::CSetOfObjects::Ptr makeObserved(const LiveMoment& moment, bool matched);
/// A ribbon, coloured by health; null without a way.
viz::CSetOfTriangles::Ptr makeWay(const std::vector<WayPoint>& way);
/// A ribbon above it, of this width, m; null without a way.
viz::CSetOfTriangles::Ptr makeTrueWay(const std::vector<WayPoint>& way, double width);
/// The points of the scan at the estimate, the higher the darker; null without.
viz::CPointCloudColoured::Ptr makePoints(const LiveMoment& moment, double pointSize);
/// An arrow of this length, m, in the direction of the pose, its middle on the pose.
viz::CSetOfObjects::Ptr makeArrow(const Pose2D& pose, double length, const TColor& color);
viz::CSetOfObjects::Ptr makeHypotheses(const std::vector<GlobalHypothesis>& places, double length,
                                       int letters);
/// Light ones first, so that heavy ones are not hidden.
viz::CPointCloudColoured::Ptr makeParticles(const LiveMoment& moment, double height,
                                            double pointSize);
/// \param width Width of the band, m.
viz::CSetOfTriangles::Ptr makeEllipse(const PoseWithCovariance& pose, double height, double width);

}  // namespace polemcl::report::live
