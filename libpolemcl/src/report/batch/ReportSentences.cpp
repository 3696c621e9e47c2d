#include <algorithm>
#include <cmath>

#include "report/batch/Html.h"
#include "report/batch/NumberFormat.h"
#include "report/batch/ReportParts.h"
#include "report/batch/SvgPlot.h"

namespace polemcl::report {
namespace {

std::string emphasized(const BatchConfiguration& configuration) {
  return element("em", escaped(configuration.name));
}

std::string headingText(double value) {
  return metricText(value, 3) + "°";
}

/// "A, B and C".
std::string listed(const std::vector<std::string>& parts) {
  std::string text;
  for (std::size_t i = 0; i < parts.size(); ++i)
    text += (i == 0 ? "" : i + 1 == parts.size() ? " and " : ", ") + parts[i];
  return text;
}

constexpr std::size_t mostNamed =
    3;  // of more configurations, sentences name the best and the worst

/// The configuration with the smallest mean error first.
std::vector<std::size_t> byError(const Summaries& summaries) {
  std::vector<std::size_t> order;
  for (std::size_t i = 0; i < summaries.size(); ++i)
    if (summaries[i].localized > 0) order.push_back(i);
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return summaries[a].figures.posMean.mean < summaries[b].figures.posMean.mean;
  });
  return order;
}

bool isNamed(const std::vector<std::size_t>& order, std::size_t configuration) {
  return order.size() <= mostNamed || configuration == order.front() ||
         configuration == order.back();
}

std::string errorSentence(const BatchResults& results, const Summaries& summaries,
                          const std::vector<std::size_t>& order) {
  std::vector<std::string> parts;
  for (std::size_t i : order) {
    const MetricSpreads& figures = summaries[i].figures;
    const std::string with = results.configurations.size() > 1
                                 ? " with " + emphasized(results.configurations[i])
                                 : std::string();
    parts.push_back(element("strong", lengthText(figures.posMean.mean)) + with + " (RMSE " +
                    lengthText(figures.posRmse.mean) + ", heading " +
                    headingText(figures.angMeanDeg.mean) + ", largest " +
                    lengthText(figures.posMax.largest) + ")");
  }
  if (parts.size() > mostNamed) parts = {"from " + parts.front() + " to " + parts.back()};
  std::size_t sessions = 0;
  for (std::size_t i : order) sessions = std::max(sessions, summaries[i].localized);
  return "The position error is " + listed(parts) + ", on average over " +
         plural(sessions, "session") + ".";
}

std::string changeSentence(const BatchResults& results, const Summaries& summaries,
                           const std::vector<std::size_t>& order) {
  std::vector<std::string> parts;
  for (std::size_t i : order)
    if (isNamed(order, i) && std::isfinite(summaries[i].lastOverFirst))
      parts.push_back(changeText(summaries[i].lastOverFirst) +
                      (results.configurations.size() > 1
                           ? " with " + emphasized(results.configurations[i])
                           : std::string()));
  if (parts.empty()) return "";
  return element("p",
                 "Its change from the first localized session to the last: " + listed(parts) + ".");
}

std::string fact(const std::string& name, const std::string& value) {
  return element("dt", name) + element("dd", value);
}

/// The number large, its unit small.
std::string bigLength(double metres) {
  const std::string text = lengthText(metres, " ");
  const std::size_t space = text.find(' ');
  return text.substr(0, space) + element("span", text.substr(space));
}

std::string shares(const ScoreMeans& means) {
  return "precision " + metricText(means.precision, 3) + ", recall " + metricText(means.recall, 3);
}

/// The F1 of each configuration's maps; empty when none was scored.
std::string scoreSentence(const BatchResults& results, const Summaries& summaries) {
  std::vector<std::string> parts;
  for (std::size_t i = 0; i < summaries.size(); ++i)
    if (summaries[i].scores.maps > 0)
      parts.push_back(element("strong", metricText(summaries[i].scores.near.f1, 3)) + " with " +
                      emphasized(results.configurations[i]) + " (" +
                      shares(summaries[i].scores.near) + ")");
  if (parts.empty()) return "";
  return "The F1 of the maps is " + listed(parts) + ", by the authors' count within 1\xC2\xA0m.";
}

RunCounts countsOf(const Summaries& summaries) {
  RunCounts counts;
  for (const ConfigurationSummary& summary : summaries) {
    counts.runs += summary.counts.runs;
    counts.lost += summary.counts.lost;
    counts.failed += summary.counts.failed;
  }
  return counts;
}

/// Sessions that no run of a configuration could follow.
std::string lostSessions(const BatchResults& results, const Summaries& summaries) {
  std::vector<std::string> names;
  for (std::size_t i = 0; i < summaries.size(); ++i)
    for (const SessionSummary& session : summaries[i].sessions)
      if (session.counts.runs > 0 &&
          session.counts.lost + session.counts.failed == session.counts.runs)
        names.push_back(escaped(results.sessions[session.session].name) + " (" +
                        emphasized(results.configurations[i]) + ")");
  if (names.empty()) return "";
  return (names.size() == 1 ? " No run got through session " : " No run got through sessions ") +
         listed(names) + ".";
}

std::string troubleSentence(const BatchResults& results, const Summaries& summaries) {
  const RunCounts counts = countsOf(summaries);
  if (counts.runs == 0 && results.failures.empty() && !scoreSentence(results, summaries).empty())
    return element("p", "Maps only: no session was to be localized.");
  if (counts.runs == 0) return element("p", "class=\"alarm\"", "No session was localized.");
  if (counts.lost + counts.failed == 0 && results.failures.empty())
    return element("p", (counts.runs == 1 ? "The only run" : "All " + plural(counts.runs, "run")) +
                            " kept " + (counts.runs == 1 ? "its" : "their") +
                            " pose; none failed.");
  std::string text = countText(counts.lost) + " of " + plural(counts.runs, "run") +
                     " had a wrong pose and " + countText(counts.failed) + " failed.";
  text += lostSessions(results, summaries);
  if (counts.lost > 0)
    text += " Means include wrong runs as far as they had a pose; failed runs have no figures.";
  if (!results.failures.empty())
    text += ' ' + plural(results.failures.size(), "task") + " of the batch failed.";
  return element("p", "class=\"alarm\"", text + " <a href=\"#troubles\">What went wrong</a>");
}

}  // namespace

std::string headlines(const BatchResults& results, const Summaries& summaries) {
  const std::vector<std::size_t> order = byError(summaries);
  std::string text;
  if (!order.empty()) text += element("p", errorSentence(results, summaries, order)) + '\n';
  text += changeSentence(results, summaries, order) + '\n';
  const std::string scores = scoreSentence(results, summaries);
  if (!scores.empty()) text += element("p", scores) + '\n';
  return element("div", "class=\"lead\"",
                 '\n' + text + troubleSentence(results, summaries) + '\n') +
         '\n';
}

namespace {

std::string big(const std::string& html, const std::string& what) {
  return element("p", "class=\"big\"", html) + element("p", "class=\"what\"", what);
}

std::string scoreFacts(const ScoreSummary& scores) {
  return fact("maps", countText(scores.maps)) + fact("authors' count", shares(scores.near)) +
         fact("one to one", shares(scores.oneToOne) + ", F1 " + metricText(scores.oneToOne.f1, 3));
}

std::string errorFacts(const ConfigurationSummary& summary) {
  const MetricSpreads& figures = summary.figures;
  const bool bad = summary.counts.lost + summary.counts.failed > 0;
  return fact("RMSE", lengthText(figures.posRmse.mean)) +
         fact("heading", headingText(figures.angMeanDeg.mean) + " mean, " +
                             headingText(figures.angRmseDeg.mean) + " RMSE") +
         fact("largest", lengthText(figures.posMax.largest)) +
         (std::isfinite(summary.lastOverFirst)
              ? fact("last / first", changeText(summary.lastOverFirst))
              : "") +
         (summary.scores.maps > 0 ? fact("F1 of its map", metricText(summary.scores.near.f1, 3))
                                  : "") +
         fact("runs", bad ? element("span", "class=\"bad\"", runsText(summary.counts))
                          : runsText(summary.counts));
}

/// Score of a configuration whose maps were scored and that localizes no session.
std::string cardOf(const ConfigurationSummary& summary) {
  if (summary.counts.runs == 0 && summary.scores.maps > 0)
    return big(metricText(summary.scores.near.f1, 3),
               "F1 of the maps, authors' count within 1\xC2\xA0m") +
           element("dl", "class=\"facts\"", scoreFacts(summary.scores));
  return big(bigLength(summary.figures.posMean.mean), "mean position error") +
         element("dl", "class=\"facts\"", errorFacts(summary));
}

}  // namespace

std::string configurationCards(const BatchResults& results, const Summaries& summaries) {
  std::string cards;
  for (std::size_t i = 0; i < summaries.size(); ++i)
    cards +=
        element("section", "class=\"card " + seriesClass(i) + '"',
                element("h2", escaped(results.configurations[i].name)) + cardOf(summaries[i])) +
        '\n';
  return element("div", "class=\"cards\"", '\n' + cards) + '\n';
}

std::string sessionLine(const BatchResults& results, const Summaries& summaries,
                        std::size_t session) {
  std::string line = element("strong", escaped(results.sessions[session].name));
  std::vector<std::string> parts;
  for (std::size_t i = 0; i < summaries.size(); ++i)
    for (const SessionSummary& one : summaries[i].sessions) {
      if (one.session != session || one.counts.runs == 0) continue;
      std::string part = escaped(results.configurations[i].name) + "\xC2\xA0" +
                         lengthText(one.figures.posMean.mean);
      if (one.counts.lost + one.counts.failed > 0)
        part += element("span", "class=\"bad\"", " (runs: " + runsText(one.counts) + ")");
      parts.push_back(part);
    }
  for (const std::string& part : parts) line += element("span", "class=\"figures\"", " · " + part);
  return line;
}

}  // namespace polemcl::report
