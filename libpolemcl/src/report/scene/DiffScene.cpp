#include "report/scene/DiffScene.h"

#include "mrpt/drawing/OverviewScene.h"

namespace polemcl::report {
namespace {

using scene::TColor;

std::vector<MapPole> laterOf(const std::vector<MapDiff::Pair>& pairs) {
  std::vector<MapPole> poles;
  poles.reserve(pairs.size());
  for (const MapDiff::Pair& pair : pairs) poles.push_back(pair.after);
  return poles;
}

}  // namespace

viz::Scene::Ptr makeDiffScene(const MapDiff& diff, const std::string& title) {
  struct Kind {
    const char *name, *text;
    std::vector<MapPole> poles;
    TColor color;
  };
  const TColor movedTint(0x00, 0x72, 0xb2);
  const Kind kinds[] = {
      {"same", "on both maps", laterOf(diff.same), {0x9a, 0xa2, 0xad}},
      {"new", "new, on the later map only", diff.appeared, {0x00, 0x9e, 0x73}},
      {"vanished", "vanished, on the earlier map only", diff.vanished, {0xd5, 0x5e, 0x00}},
      {"moved", "moved, with a ribbon from the old place", laterOf(diff.moved), movedTint}};
  scene::Path places;
  for (const Kind& kind : kinds)
    for (const MapPole& pole : kind.poles) places.emplace_back(pole.x, pole.y);
  if (places.empty()) throw Error("nothing to show: both maps are empty");

  OverviewScene overview(places, title);
  for (const Kind& kind : kinds) {
    overview.addPoles(kind.name, kind.poles, [&](const MapPole&) { return kind.color; });
    overview.addLegend({{std::to_string(kind.poles.size()) + " " + kind.text, kind.color}});
  }
  std::vector<scene::Path> moves;
  for (const MapDiff::Pair& pair : diff.moved)
    moves.push_back({{pair.before.x, pair.before.y}, {pair.after.x, pair.after.y}});
  overview.addRibbons("moves", moves, {movedTint, false, 0.3});
  return overview.finish();
}

}  // namespace polemcl::report
