#include <algorithm>
#include <cmath>

#include "io/file/AtomicFile.h"
#include "report/batch/BatchFiles.h"
#include "report/batch/ComparedResults.h"
#include "report/batch/Html.h"
#include "report/batch/NumberFormat.h"
#include "report/batch/PublishedResults.h"
#include "report/batch/ReportParts.h"

namespace polemcl::report {
namespace {

/// A section of the page; without content it is left out.
struct Section {
  std::string id, title, content;
};

/// All that the sections are made from.
struct Page {
  explicit Page(const BatchResults& batch) : results(batch), summaries(summarize(batch)) {}
  const BatchResults& results;
  const Summaries summaries;
  PlotIds ids;
  const BatchConfiguration& configuration(std::size_t i) const { return results.configurations[i]; }
  /// Whether any session was localized, or ought to have been.
  bool localized() const {
    return std::any_of(summaries.begin(), summaries.end(),
                       [](const ConfigurationSummary& summary) { return summary.counts.runs > 0; });
  }
};

std::string paragraph(const std::string& text, const std::string& className = "") {
  return text.empty() ? "" : element("p", classed(className), text) + '\n';
}

std::string sideBySide(const std::string& content) {
  return content.empty() ? "" : element("div", "class=\"two\"", '\n' + content) + '\n';
}

std::string sessionFigures(Page& page) {
  return sessionsFigure(page.results, page.summaries,
                        {"mean position error", "m", &MetricSpreads::posMean}, page.ids) +
         sessionsFigure(page.results, page.summaries,
                        {"mean heading error", "°", &MetricSpreads::angMeanDeg}, page.ids);
}

Section configurationsSection(Page& page) {
  const BatchResults& results = page.results;
  if (!page.localized()) return {};
  std::string content;
  if (results.configurations.size() > 1) content += configurationsTable(results, page.summaries);
  if (results.sessions.size() > 1) content += sessionFigures(page);
  if (results.configurations.size() > 1)
    content += foldable("Sessions with all settings side by side",
                        sideBySideTable(results, page.summaries), false);
  return {"settings", results.configurations.size() > 1 ? "Settings compared" : "Error per session",
          content};
}

Section publishedSection(const Page& page) {
  const PublishedDataset* dataset = publishedResults(page.results.dataset);
  if (!dataset || dataset->figures.empty() || !page.localized()) return {};
  return {"published", "Published results and those of this batch",
          paragraph("Published: " + escaped(dataset->protocol)) +
              publishedTable(page.results, page.summaries) +
              paragraph("A dash: not published. Figures are comparable only under the same "
                        "protocol and over the same sessions.",
                        "note")};
}

/// The paper's first table.
Section scoresSection(const Page& page) {
  const std::string table = mapScoresTable(page.results, page.summaries);
  if (table.empty()) return {};
  const PublishedDataset* dataset = publishedResults(page.results.dataset);
  std::string content;
  if (dataset && !dataset->maps.empty())
    content += paragraph("Published: " + escaped(dataset->mapProtocol));
  std::string rows;
  for (std::size_t i = 0; i < page.summaries.size(); ++i)
    if (page.summaries[i].scores.maps > 0)
      rows += element("li", "polemcl, " +
                                escaped(page.configuration(i).name + ": " +
                                        scoreRowText(page.configuration(i), page.summaries[i]))) +
              '\n';
  content += table + element("ul", "class=\"note\"", '\n' + rows) + '\n' +
             paragraph(
                 "P is the share of a map's poles that are true ones, R the share of the true "
                 "ones that it has, F1 their harmonic mean. The authors count a map pole with "
                 "a true one within 1\xC2\xA0m as found, in P and in R, so that two map poles "
                 "may share a true one. One to one, each pole is matched at most once. A "
                 "dash: not published.",
                 "note");
  const std::string every = everyScoreTable(page.results);
  if (!every.empty()) content += foldable("Map by map", every, true);
  return {"scores", "Map scores", content};
}

Section sessionTables(const Page& page) {
  std::string content;
  for (std::size_t i = 0; i < page.results.configurations.size(); ++i) {
    const BatchConfiguration& configuration = page.configuration(i);
    content += element("h3", escaped(configuration.name)) + '\n';
    content += paragraph(escaped(sentence(configuration.description)));
    if (!configuration.protocol.empty())
      content += paragraph("Protocol: " + escaped(sentence(configuration.protocol)));
    if (page.summaries[i].counts.runs > 0)
      content += paperTable(page.results, i, page.summaries[i]);
  }
  return {"sessions", "Sessions", content};
}

Section histograms(Page& page) {
  return {
      "histograms", "Error histograms",
      sideBySide(histogramFigure(page.results,
                                 {"position error", "m", &SessionPlots::positionErrors}, page.ids) +
                 histogramFigure(page.results, {"heading error", "°", &SessionPlots::headingErrors},
                                 page.ids))};
}

Section paths(Page& page) {
  const BatchResults& results = page.results;
  std::string content;
  bool opened = false;
  for (std::size_t k = 0; k < results.sessions.size(); ++k) {
    std::string maps;
    for (std::size_t i = 0; i < results.configurations.size(); ++i)
      if (const SessionResult* result = results.find(i, k))
        maps += mapFigure(results, *result, page.ids);
    const std::string errors = distanceFigure(results, k, page.ids);
    if (maps.empty() && errors.empty()) continue;
    // The first that was localized is open, to show what the others hold.
    content += foldable(sessionLine(results, page.summaries, k), sideBySide(maps) + errors,
                        !opened && !errors.empty());
    opened |= !errors.empty();
  }
  return {"paths", "Paths and maps", content.empty() ? "" : mapLegend() + content};
}

Section health(const Page& page) {
  std::string content;
  for (std::size_t i = 0; i < page.results.configurations.size(); ++i)
    if (page.summaries[i].counts.runs > 0)
      content += foldable("Setting " + element("em", escaped(page.configuration(i).name)),
                          healthTable(page.results, i, page.summaries[i]), i == 0);
  if (content.empty()) return {};
  return {
      "health", "Health",
      paragraph("What the runs said of themselves while they drove, without the truth.") + content};
}

Section runs(const Page& page) {
  std::string content;
  for (std::size_t i = 0; i < page.results.configurations.size(); ++i) {
    const std::string table = runsTable(page.results, i);
    if (!table.empty())
      content += foldable("Runs and seeds of " + element("em", escaped(page.configuration(i).name)),
                          table, false);
  }
  return {"runs", "Runs and seeds", content};
}

Section timings(const BatchTimings* timings) {
  if (!timings) return {};
  std::string words;
  if (std::isfinite(timings->wall)) words += "From start to end: " + durationText(timings->wall);
  if (timings->jobs > 0)
    words += (words.empty() ? "" : ", ") + plural(timings->jobs, "task") + " at a time";
  if (!timings->machine.empty())
    words += (words.empty() ? "" : ", on ") + escaped(timings->machine);
  return {
      "timings", "Timings",
      paragraph(sentence(words)) + timingsTable(*timings) +
          paragraph("The only part of this page that changes from one time to the next.", "note")};
}

Section configurationsInFull(const Page& page) {
  std::string content = differencesTable(page.results);
  for (std::size_t i = 0; i < page.results.configurations.size(); ++i)
    if (!page.configuration(i).config.empty())
      content +=
          foldable("Effective settings of " + element("em", escaped(page.configuration(i).name)),
                   element("pre", "tabindex=\"0\"", escaped(page.configuration(i).config)), false);
  return {"configuration", "Settings in full", content};
}

Section origin(const Page& page) {
  const BatchResults& results = page.results;
  const BatchVersions& versions = results.versions;
  std::string facts;
  const auto add = [&](const std::string& name, const std::string& value, const char* tag) {
    if (!value.empty())
      facts += element("dt", name) +
               element("dd", *tag ? element(tag, escaped(value)) : escaped(value)) + '\n';
  };
  add("batch", results.name, "");
  add("polemcl", versions.polemcl, "");
  add("MRPT", versions.mrpt, "");
  add("compiler", versions.compiler, "");
  add("date", results.date, "");
  add("command", results.command, "code");
  return {"origin", "Data and versions",
          element("dl", "class=\"facts\"", '\n' + facts) + '\n' + sessionsTable(results)};
}

Section terms(const Page& page) {
  const auto term = [](const std::string& name, const std::string& meaning) {
    return element("dt", name) + element("dd", meaning) + '\n';
  };
  return {
      "terms", "What the figures mean",
      element(
          "dl", "class=\"terms\"",
          '\n' +
              term("<i>f</i><sub>map</sub>",
                   "Share of a session's scans that were used to build the map; its mean is over "
                   "the localized sessions. A dash: there is no map with the session in it, as "
                   "where it is localized before it goes into the map and none comes after "
                   "it.") +
              term("Δ<sub>pos</sub>, RMSE<sub>pos</sub>",
                   "Mean and root mean square of the distance between estimate and truth "
                   "in the plane, the first metres until the filter has converged "
                   "included.") +
              term("Δ<sub>ang</sub>, RMSE<sub>ang</sub>",
                   "The same for the absolute heading error.") +
              term("Δ<sub>lat</sub>, Δ<sub>lon</sub>, σ<sub>lat</sub>, σ<sub>lon</sub>",
                   "Means of the absolute errors across and along the true heading, and "
                   "standard deviations of the signed ones.") +
              term("RMSE per axis",
                   "Root of half the mean of <i>x</i>² + <i>y</i>²: the position RMSE "
                   "divided by √2.") +
              term("mean ± spread",
                   "Mean and standard deviation over the runs of a session, which differ "
                   "in their seeds. Means over sessions give every session the same "
                   "weight.") +
              term("wrong",
                   "A run of which no pose could be compared, or whose position error is larger "
                   "than " +
                       metricText(page.results.lostBound, 1) +
                       "\xC2\xA0m on average or at the end. CSV and JSON call it lost.") +
              term("ok, degraded, lost",
                   "What a run said of itself, scan by scan, without knowing the truth.") +
              term("m, cm",
                   "A column of position errors is in centimetres if any of them is below "
                   "0.1\xC2\xA0m: these have two significant digits. Elsewhere errors below "
                   "1\xC2\xA0m are in centimetres.") +
              term("failed", "The run has no result: its task ended with an error."))};
}

std::string headOfPage(const Page& page, const std::vector<Section>& sections) {
  const BatchResults& results = page.results;
  std::string links;
  for (const Section& section : sections)
    links += element("li", element("a", "href=\"#" + section.id + '"', section.title)) + '\n';
  const std::string title = results.title.empty() ? results.name : results.title;
  std::size_t runCount = 0;
  for (const ConfigurationSummary& summary : page.summaries) runCount += summary.counts.runs;
  return element("header",
                 '\n' + element("p", "class=\"over\"", "polemcl · localization among poles") +
                     '\n' + element("h1", escaped(title)) + '\n' +
                     element("p", "class=\"meta\"",
                             plural(results.sessions.size(), "session") + ", " +
                                 plural(results.configurations.size(), "setting") + ", " +
                                 plural(runCount, "run") + (runCount > 1 ? " in all" : "") +
                                 (results.date.empty() ? "" : " · " + escaped(results.date))) +
                     '\n' + headlines(results, page.summaries) +
                     configurationCards(results, page.summaries) +
                     element("nav", "aria-label=\"Sections\"", element("ul", '\n' + links)) +
                     '\n') +
         '\n';
}

std::vector<Section> sectionsOf(Page& page, const BatchTimings* times) {
  std::vector<Section> sections;
  const auto add = [&](Section section) {
    if (!section.content.empty()) sections.push_back(std::move(section));
  };
  add({"troubles", "What went wrong", troublesTables(page.results)});
  add(configurationsSection(page));
  add(publishedSection(page));
  add(scoresSection(page));
  add(sessionTables(page));
  add(histograms(page));
  add(paths(page));
  add(health(page));
  add(runs(page));
  add(timings(times));
  add(configurationsInFull(page));
  add(origin(page));
  add(terms(page));
  return sections;
}

}  // namespace

std::string batchReport(const BatchResults& results, const BatchTimings* times) {
  results.validate();
  Page page(results);
  const std::vector<Section> sections = sectionsOf(page, times);
  const std::string title = results.title.empty() ? results.name : results.title;
  std::string html =
      "<!doctype html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\"/>\n"
      "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\"/>\n" +
      element("title", escaped(title)) + "\n<style>" + reportStyle + "</style>\n</head>\n<body>\n" +
      headOfPage(page, sections) + "<main>\n";
  for (const Section& section : sections)
    html += element("section", "id=\"" + section.id + '"',
                    '\n' + element("h2", section.title) + '\n' + section.content) +
            '\n';
  return html + "</main>\n" +
         element("footer", element("p", "Written by polemcl " + escaped(results.versions.polemcl) +
                                            ". The same figures lie beside this page as JSON, CSV "
                                            "and a LaTeX table.")) +
         "\n</body>\n</html>\n";
}

void writeBatchReport(const BatchResults& results, const BatchTimings* timings,
                      const std::filesystem::path& file) {
  const std::string page = batchReport(results, timings);
  io::AtomicFile out(file);
  out.stream() << page;
  out.commit();
}

}  // namespace polemcl::report
