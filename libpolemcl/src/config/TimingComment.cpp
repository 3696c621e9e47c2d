#include "config/TimingComment.h"

#include "config/Config.h"
#include "core/common/Binder.h"

namespace polemcl {
namespace {

void bind(Binder& binder, ScanTiming& timing) {
  binder.section("scan_timing", "When the points of these scans were measured", Tier::sensor);
  bindTiming(binder, timing);
}

}  // namespace

std::string timingComment(const ScanTiming& timing) {
  ConfigWriter writer;
  ScanTiming copy = timing;
  bind(writer, copy);
  return writer.text();
}

ScanTiming timingIn(const std::string& comment, const std::string& rawlog) {
  ScanTiming timing;
  const auto begin = comment.find("[scan_timing]");
  if (begin == std::string::npos) return timing;
  ConfigReader reader(
      ConfigFile::fromText(comment.substr(begin), rawlog + ": comment of the rawlog"));
  bind(reader, timing);
  reader.finish();
  return timing;
}

ScanTiming timingInFile(const std::string& file) {
  const ConfigFile config = ConfigFile::read(file);
  if (!config.source().sectionExists("scan_timing"))
    throw Error(file + ": no section [scan_timing]; write it, or remove the file");
  ScanTiming timing;
  ConfigReader reader(config);
  bind(reader, timing);
  reader.finish();
  return timing;
}

}  // namespace polemcl
