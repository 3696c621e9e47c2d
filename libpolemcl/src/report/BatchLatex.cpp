#include <polemcl/io/AtomicFile.h>
#include <polemcl/report/BatchFiles.h>

#include <cmath>
#include <ostream>

#include "ComparedFigures.h"
#include "FigureText.h"

namespace polemcl::report {
namespace {

/// "0.174", "--" for none.
std::string number(double value, int decimals = 3) {
  return figureText(value, decimals, "--");
}

std::string withSpread(const Spread& spread) {
  if (!std::isfinite(spread.deviation)) return number(spread.mean);
  return '$' + number(spread.mean) + " \\pm " + number(spread.deviation) + '$';
}

std::string percent(double share) {
  return figureText(100 * share, 1, "--");
}

void writeFigures(std::ostream& out, const FigureSpreads& figures, bool spreads) {
  for (const Spread* spread :
       {&figures.posMean, &figures.posRmse, &figures.angMeanDeg, &figures.angRmseDeg})
    out << " & " << (spreads ? withSpread(*spread) : number(spread->mean));
  out << " \\\\\n";
}

/// What went wrong, for the caption; figures without it would flatter.
std::string losses(const RunCounts& counts) {
  return std::to_string(counts.runs) + " runs, " + std::to_string(counts.lost) + " lost, " +
         std::to_string(counts.failed) + " failed.";
}

void beginTable(std::ostream& out, const std::string& caption, const std::string& columns) {
  out << "\\begin{table}\n  \\centering\n  \\caption{" << caption << "}\n  \\begin{tabular}{"
      << columns << "}\n    \\toprule\n";
}

void endTable(std::ostream& out) {
  out << "    \\bottomrule\n  \\end{tabular}\n\\end{table}\n";
}

void writeSetting(std::ostream& out, const BatchResults& results, std::size_t index,
                  const SettingSummary& summary) {
  const BatchSetting& setting = results.settings[index];
  std::string caption = latexText(results.title) + ", setting \\emph{" + latexText(setting.name) +
                        "}. Mean and standard deviation over the runs of each session. ";
  if (!setting.protocol.empty()) caption += latexText(sentence(setting.protocol)) + " ";
  beginTable(out, caption + losses(summary.counts), "lrrrrr");
  out << "    Session & $f_\\mathrm{map}$ [\\%] & $\\Delta_\\mathrm{pos}$ [m] & "
         "$\\mathrm{RMSE}_\\mathrm{pos}$ [m] & $\\Delta_\\mathrm{ang}$ [$^\\circ$] & "
         "$\\mathrm{RMSE}_\\mathrm{ang}$ [$^\\circ$] \\\\\n    \\midrule\n";
  for (const SessionSummary& session : summary.sessions) {
    out << "    " << latexText(results.sessions[session.session].name) << " & "
        << percent(session.mapShare);
    writeFigures(out, session.figures, true);
  }
  out << "    \\midrule\n    Mean & " << percent(summary.mapShare.mean);
  writeFigures(out, summary.figures, false);
  endTable(out);
}

void writeComparison(std::ostream& out, const BatchResults& results,
                     const PublishedDataset& dataset,
                     const std::vector<SettingSummary>& summaries) {
  const std::vector<ComparedColumn> columns = comparedColumns(dataset);
  beginTable(
      out,
      latexText(dataset.title) + ": published figures and ours. " + latexText(dataset.protocol),
      'l' + std::string(columns.size(), 'r'));
  out << "    System";
  for (const ComparedColumn& column : columns) out << " & " << column.latex;
  out << " \\\\\n    \\midrule\n";
  for (const PublishedFigure& system : dataset.figures) {
    out << "    " << latexText(system.system);
    for (const ComparedColumn& column : columns) out << " & " << number(system.*column.published);
    out << " \\\\\n";
  }
  out << "    \\midrule\n";
  for (std::size_t i = 0; i < summaries.size(); ++i) {
    out << "    polemcl, " << latexText(results.settings[i].name);
    for (const ComparedColumn& column : columns)
      out << " & " << number((summaries[i].figures.*column.ours).mean);
    out << " \\\\\n";
  }
  endTable(out);
}

/// What LaTeX reads as something else, as the letter it is; empty for all others.
std::string latexLetter(char c) {
  switch (c) {
    case '\\':
      return "\\textbackslash{}";
    case '~':
      return "\\textasciitilde{}";
    case '^':
      return "\\textasciicircum{}";
    case '<':
      return "\\textless{}";
    case '>':
      return "\\textgreater{}";
    case '|':
      return "\\textbar{}";
    case '\n':
    case '\r':
    case '\t':
      return " ";
    case '{':
    case '}':
    case '%':
    case '$':
    case '#':
    case '&':
    case '_':
      return std::string("\\") + c;
    default:
      return "";
  }
}

}  // namespace

std::string latexText(const std::string& text) {
  std::string escaped;
  char before = 0;
  for (char c : text) {
    // Two of these would join: -- to a dash, '' to a quotation mark.
    if (c == before && (c == '-' || c == '\'' || c == '`')) escaped += "{}";
    const std::string letter = latexLetter(c);
    escaped += letter.empty() ? std::string(1, c) : letter;
    before = c;
  }
  return escaped;
}

void writeLatexTable(const std::filesystem::path& file, const BatchResults& results) {
  results.validate();
  const std::vector<SettingSummary> summaries = summarize(results);
  io::AtomicFile out(file);
  out.stream() << "% Needs \\usepackage{booktabs}. Positions in metres, headings in degrees.\n";
  for (std::size_t i = 0; i < summaries.size(); ++i)
    writeSetting(out.stream(), results, i, summaries[i]);
  if (const PublishedDataset* dataset = publishedFigures(results.dataset))
    writeComparison(out.stream(), results, *dataset, summaries);
  out.commit();
}

}  // namespace polemcl::report
