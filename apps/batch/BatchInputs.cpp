#include "batch/BatchInputs.h"

#include "io/dataset/Nclt.h"
#include "io/file/ErrorPlace.h"
#include "report/batch/PublishedResults.h"

namespace polemcl::apps {
namespace fs = std::filesystem;
namespace {

std::string sessionObstacle(const BatchSession& session) {
  const bool isFile =
      session.source == "simulated" || session.source == "poles" || session.source == "scans";
  if (session.source == "nclt" && io::isNcltSession(session.input)) return {};
  if (!fs::exists(session.input)) return session.input + " is not there";
  if (isFile && !fs::is_regular_file(session.input)) return session.input + " is no file";
  if (!isFile && !fs::is_directory(session.input)) return session.input + " is no folder";
  const fs::path truth = fs::path(session.input).replace_extension(".tum");
  if (isFile && session.source != "simulated" && !fs::is_regular_file(truth))
    return truth.string() + ", its true poses, is not there";
  return {};
}

std::string truthObstacle(const BatchSession& session) {
  if (session.truthMap != truthFromLabels)
    return fs::is_regular_file(session.truthMap)
               ? ""
               : session.truthMap + ", its truth_map, is not there";
  const fs::path labels = fs::path(session.input) / "labels";
  return fs::is_directory(labels) ? "" : labels.string() + " is not there";
}

}  // namespace

std::string inputObstacle(const BatchSession& session, bool scored) {
  const std::string what = sessionObstacle(session);
  return what.empty() && scored ? truthObstacle(session) : what;
}

std::string besideBatch(const BatchSpec& spec, const std::string& file) {
  if (file.empty()) return file;
  const fs::path beside = fs::absolute(spec.file.parent_path() / file);
  return fs::is_regular_file(beside) ? beside.string() : file;
}

AllSettings settingsFor(const BatchSpec& spec, const BatchConfiguration& configuration) {
  const std::string where = "batch " + spec.name + ": [setting " + configuration.name + "] ";
  if (!fs::is_regular_file(configuration.config))
    throw Error(
        where + "config: " + configuration.config +
        " is not there; name a file beside the batch, or an installed one such as nclt.ini");
  return io::located(where, [&] { return loadSettings(configuration.config, configuration.set); });
}

void requirePublished(const BatchSpec& spec) {
  if (spec.publishedSessions.empty()) return;
  io::located("batch " + spec.name + ": [batch] published_sessions: ",
              [&] { report::readPublishedSessions(spec.publishedSessions); });
}

}  // namespace polemcl::apps
