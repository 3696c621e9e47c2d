#include <algorithm>
#include <cmath>
#include <map>
#include <ostream>

#include "io/file/AtomicFile.h"
#include "report/batch/BatchFiles.h"
#include "report/batch/ComparedResults.h"
#include "report/batch/NumberFormat.h"

namespace polemcl::report {
namespace {

/// "0.174", "--" for none.
std::string number(const MetricColumn& column, double value) {
  return column.figure(value, "--");
}

std::string latexWithSpread(const MetricColumn& column, const Spread& spread) {
  if (!std::isfinite(spread.deviation)) return number(column, spread.mean);
  return '$' + number(column, spread.mean) + " \\pm " + number(column, spread.deviation) + '$';
}

/// What the rows of this batch are, for captions: the settings with their sessions, runs and maps.
template <typename Text>
std::string rowsOfThisBatch(const BatchResults& results, const Summaries& summaries,
                            const Text& textOf) {
  std::string text = " This batch:";
  for (std::size_t i = 0; i < summaries.size(); ++i) {
    const BatchConfiguration& configuration = results.configurations[i];
    const std::string row = textOf(configuration, summaries[i]);
    if (!row.empty()) text += " \\emph{" + latexText(configuration.name) + "}: " + latexText(row);
  }
  return text;
}

void beginTable(std::ostream& out, const std::string& caption, const std::string& columns) {
  out << "\\begin{table}\n  \\centering\n  \\caption{" << caption << "}\n  \\begin{tabular}{"
      << columns << "}\n    \\toprule\n";
}

void endTable(std::ostream& out) {
  out << "    \\bottomrule\n  \\end{tabular}\n\\end{table}\n";
}

/// The paper's table of sessions, with what was published for each beside.
void writeConfiguration(std::ostream& out, const BatchResults& results, std::size_t index,
                        const ConfigurationSummary& summary) {
  const BatchConfiguration& configuration = results.configurations[index];
  const PublishedRows published = publishedRows(results);
  const std::size_t systems = published.systems.size();
  std::string caption = latexText(results.title) + ", setting \\emph{" +
                        latexText(configuration.name) +
                        "}. Mean and standard deviation over the runs of each session. ";
  caption += latexText(rowText(configuration, summary));
  if (systems > 0)
    caption +=
        " Published means of each session beside them, and below over the sessions of this table "
        "alone.";
  beginTable(out, caption, "lr" + std::string(4 * (1 + systems), 'r'));
  out << "    Session & $f_\\mathrm{map}$ [\\%]";
  std::vector<MetricColumn> units;
  for (const SessionColumn& column : sessionColumns) {
    units.push_back(unitOf(column, summary, published));
    out << " & " << units.back().latexHead(column.latex);
    for (const std::string& system : published.systems) out << " & " << latexText(system);
  }
  out << " \\\\\n    \\midrule\n";
  for (const SessionSummary& session : summary.sessions) {
    out << "    " << latexText(results.sessions[session.session].name) << " & "
        << percentText(session.mapShare, "--");
    for (std::size_t i = 0; i < units.size(); ++i) {
      const SessionColumn& column = sessionColumns[i];
      out << " & " << latexWithSpread(units[i], session.figures.*column.ours);
      for (std::size_t k = 0; k < systems; ++k)
        out << " & " << number(units[i], published.figure(k, session, column.published));
    }
    out << " \\\\\n";
  }
  out << "    \\midrule\n    Mean & " << percentText(summary.mapShare.mean, "--");
  for (std::size_t i = 0; i < units.size(); ++i) {
    const SessionColumn& column = sessionColumns[i];
    out << " & " << number(units[i], (summary.figures.*column.ours).mean);
    for (std::size_t k = 0; k < systems; ++k)
      out << " & " << number(units[i], published.mean(k, summary, column.published));
  }
  out << " \\\\\n";
  endTable(out);
}

void writeShares(std::ostream& out, const PublishedMapScore& scores) {
  for (double value : {scores.precision, scores.recall, scores.f1})
    out << " & " << metricText(value, 3, "--");
}

/// The paper's first table: scores of maps.
void writeScores(std::ostream& out, const BatchResults& results, const PublishedDataset* dataset,
                 const Summaries& summaries) {
  if (std::none_of(summaries.begin(), summaries.end(),
                   [](const ConfigurationSummary& summary) { return summary.scores.maps > 0; }))
    return;
  std::string caption = latexText(results.title) +
                        ": precision, recall and F1 of the maps, by the authors' count (a true "
                        "pole within 1 m) and one to one within 1 m and 0.5 m.";
  if (dataset && !dataset->maps.empty())
    caption += " Published: " + latexText(dataset->mapProtocol);
  caption += rowsOfThisBatch(
      results, summaries,
      [](const BatchConfiguration& configuration, const ConfigurationSummary& summary) {
        return summary.scores.maps > 0 ? scoreRowText(configuration, summary) : std::string();
      });
  beginTable(out, caption, 'l' + std::string(9, 'r'));
  out << "    System & P & R & F1 & P & R & F1 & P & R & F1 \\\\\n    \\midrule\n";
  if (dataset)
    for (const PublishedMapScore& system : dataset->maps) {
      out << "    " << latexText(system.system);
      for (const PublishedMapScore& scores : {system, PublishedMapScore(), PublishedMapScore()})
        writeShares(out, scores);
      out << " \\\\\n";
    }
  for (std::size_t i = 0; i < summaries.size(); ++i) {
    const ScoreSummary& scores = summaries[i].scores;
    if (scores.maps == 0) continue;
    out << "    polemcl, " << latexText(results.configurations[i].name);
    for (const ScoreMeans& one : {scores.near, scores.oneToOne, scores.oneToOneHalf})
      writeShares(out, {"", one.precision, one.recall, one.f1});
    out << " \\\\\n";
  }
  endTable(out);
}

void writeComparison(std::ostream& out, const BatchResults& results,
                     const PublishedDataset& dataset, const Summaries& summaries) {
  const std::vector<ComparedColumn> columns = comparedColumns(dataset);
  beginTable(out,
             latexText(dataset.title) + ": published results and those of this batch. Published: " +
                 latexText(dataset.protocol) + rowsOfThisBatch(results, summaries, rowText),
             'l' + std::string(columns.size(), 'r'));
  out << "    System";
  std::vector<MetricColumn> units;
  for (const ComparedColumn& column : columns) {
    units.push_back(unitOf(column, dataset, summaries));
    out << " & " << units.back().latexHead(column.latex);
  }
  out << " \\\\\n    \\midrule\n";
  for (const PublishedResult& system : dataset.figures) {
    out << "    " << latexText(system.system);
    for (std::size_t k = 0; k < columns.size(); ++k)
      out << " & " << number(units[k], system.*columns[k].published);
    out << " \\\\\n";
  }
  out << "    \\midrule\n";
  for (std::size_t i = 0; i < summaries.size(); ++i) {
    out << "    polemcl, " << latexText(results.configurations[i].name);
    for (std::size_t k = 0; k < columns.size(); ++k)
      out << " & " << number(units[k], (summaries[i].figures.*columns[k].ours).mean);
    out << " \\\\\n";
  }
  endTable(out);
}

/// What LaTeX reads as something else, as the letter it is.
const std::map<char, const char*> latexLetters{{'\\', "\\textbackslash{}"},
                                               {'~', "\\textasciitilde{}"},
                                               {'^', "\\textasciicircum{}"},
                                               {'<', "\\textless{}"},
                                               {'>', "\\textgreater{}"},
                                               {'|', "\\textbar{}"},
                                               {'\n', " "},
                                               {'\r', " "},
                                               {'\t', " "},
                                               {'{', "\\{"},
                                               {'}', "\\}"},
                                               {'%', "\\%"},
                                               {'$', "\\$"},
                                               {'#', "\\#"},
                                               {'&', "\\&"},
                                               {'_', "\\_"}};

}  // namespace

std::string latexText(const std::string& text) {
  std::string escaped;
  char before = 0;
  for (char c : text) {
    // Two of these would join: -- to a dash, '' to a quotation mark.
    if (c == before && (c == '-' || c == '\'' || c == '`')) escaped += "{}";
    const auto letter = latexLetters.find(c);
    escaped += letter == latexLetters.end() ? std::string(1, c) : letter->second;
    before = c;
  }
  return escaped;
}

void writeLatexTable(const std::filesystem::path& file, const BatchResults& results) {
  results.validate();
  const Summaries summaries = summarize(results);
  io::AtomicFile out(file);
  out.stream() << "% Needs \\usepackage{booktabs}. A column of lengths is in centimetres\n"
                  "% if any of them is below 0.1 m; these have two significant digits.\n";
  for (std::size_t i = 0; i < summaries.size(); ++i)
    if (summaries[i].counts.runs > 0) writeConfiguration(out.stream(), results, i, summaries[i]);
  const PublishedDataset* dataset = publishedResults(results.dataset);
  writeScores(out.stream(), results, dataset, summaries);
  const bool localized =
      std::any_of(summaries.begin(), summaries.end(),
                  [](const ConfigurationSummary& summary) { return summary.counts.runs > 0; });
  if (dataset && !dataset->figures.empty() && localized)
    writeComparison(out.stream(), results, *dataset, summaries);
  out.commit();
}

}  // namespace polemcl::report
