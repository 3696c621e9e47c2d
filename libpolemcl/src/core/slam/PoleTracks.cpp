#include "core/slam/PoleTracks.h"

namespace polemcl {
namespace {

/// Adds the poles that the latest scan saw.
void addSeen(const LocalSubmap& submap, std::size_t scan, std::size_t before, PoleTracks& found) {
  for (const SubmapPole& pole : submap.poles()) {
    if (pole.seenFrame != submap.frames()) continue;
    const std::size_t number = before + pole.number;
    if (number >= found.tracks.size()) found.tracks.resize(number + 1, {scan, scan, 0, 0});
    PoleTrack& track = found.tracks[number];
    track.last = scan;
    track.hits = pole.hits;
    track.radius = pole.radius;
    found.sightings.push_back({scan, pole.detection, number});
  }
}

}  // namespace

PoleTracks trackPoles(const std::vector<DrivenScan>& scans, const std::vector<Pose2D>& poses,
                      const SubmapVisitor& visit) {
  PoleTracks found;
  LocalSubmap submap;
  std::size_t before = 0;
  for (std::size_t i = 0; i < scans.size(); ++i) {
    if (i == 0 || !scans[i].motion) {
      submap.clear();
      before = found.tracks.size();
      submap.add(Pose2D(), scans[i].poles_robot);
    } else {
      submap.add(relative(poses[i - 1], poses[i]), scans[i].motion->covariance,
                 scans[i].poles_robot);
    }
    addSeen(submap, i, before, found);
    if (visit) visit(i, submap, before);
  }
  return found;
}

}  // namespace polemcl
