#include "map/MapDiffApp.h"

#include <sstream>

#include "io/file/AtomicFile.h"
#include "io/file/TextFile.h"
#include "io/map/Datum.h"
#include "io/map/PoleMapFile.h"
#include "mrpt/drawing/SceneParts.h"
#include "report/picture/Pictures.h"
#include "report/scene/DiffScene.h"

namespace polemcl::apps {
namespace {

std::string place(const MapPole& pole, const char* between) {
  return io::fixed(pole.x, 3) + between + io::fixed(pole.y, 3);
}

void writeCsv(const MapDiff& diff, const std::filesystem::path& file) {
  io::AtomicFile output(file);
  output.stream() << "change,x,y,x_before,y_before,distance\n";
  for (const MapPole& pole : diff.appeared)
    output.stream() << "new," << place(pole, ",") << ",,,\n";
  for (const MapPole& pole : diff.vanished)
    output.stream() << "vanished," << place(pole, ",") << ",,,\n";
  for (const MapDiff::Pair& pair : diff.moved)
    output.stream() << "moved," << place(pair.after, ",") << ',' << place(pair.before, ",") << ','
                    << io::fixed(pair.distance, 3) << '\n';
  output.commit();
}

}  // namespace

MapDiff diffMapFiles(const MapDiffFiles& files, const MapDiffOptions& options) {
  const auto mapBefore = io::readPoleMap(files.before), mapAfter = io::readPoleMap(files.after);
  io::requireSameDatum({files.before.string(), mapBefore.info},
                       {files.after.string(), mapAfter.info});
  MapDiff diff = diffMaps(mapBefore.poles, mapAfter.poles, options);
  const std::string before = files.before.filename().string(),
                    after = files.after.filename().string();
  if (files.csv) writeCsv(diff, *files.csv);
  if (files.png) report::drawDiffPng(diff, before + " → " + after, *files.png);
  if (files.scene) scene::save(*report::makeDiffScene(diff, before + " to " + after), *files.scene);
  return diff;
}

std::string summaryText(const MapDiff& diff) {
  std::ostringstream out;
  for (const MapPole& pole : diff.appeared) out << "new       " << place(pole, " ") << '\n';
  for (const MapPole& pole : diff.vanished) out << "vanished  " << place(pole, " ") << '\n';
  for (const MapDiff::Pair& pair : diff.moved)
    out << "moved     " << place(pair.before, " ") << " -> " << place(pair.after, " ") << " ("
        << io::fixed(pair.distance, 2) << " m)\n";
  out << diff.appeared.size() << " new, " << diff.vanished.size() << " vanished, "
      << diff.moved.size() << " moved, " << diff.same.size() << " the same\n";
  return out.str();
}

}  // namespace polemcl::apps
