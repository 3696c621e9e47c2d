#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <regex>
#include <sstream>

#include <polemcl/core/common/Types.h>
#include "report/batch/BatchFiles.h"
#include "support/SampleBatches.h"
#include "support/TempFolder.h"
#include "support/Xml.h"

namespace polemcl::report::test_batch_report {
namespace {

using testing_xml::Element, testing_xml::parsePage;

BatchTimings someTimings(double factor) {
  BatchTimings timings{"2 cores & more", 100 * factor, 2, {}};
  timings.tasks = {{"extract", {2 * factor, 1 * factor, 3 * factor}}, {"map", {}}};
  return timings;
}

std::vector<std::string> pages() {
  std::vector<BatchResults> batches{smallBatch(), smallBatch(),  smallBatch(),
                                    smallBatch(), scoredBatch(), scoredBatch()};
  batches[1].dataset = "nclt";
  batches[2].results.clear();
  batches[2].failures.clear();
  batches[3].configurations.resize(1);
  batches[3].sessions.resize(1);
  batches[3].results.resize(1);
  batches[3].failures.clear();
  batches[3].dataset = "kitti-0009";
  batches[4].dataset = "nclt";
  batches[5].dataset = "semantickitti";
  for (SessionResult& result : batches[5].results) result.runs.clear();  // maps alone
  batches[5].failures.clear();
  std::vector<std::string> all;
  const BatchTimings timings = someTimings(1);
  for (const BatchResults& batch : batches) {
    all.push_back(batchReport(batch));
    all.push_back(batchReport(batch, &timings));
  }
  return all;
}

std::vector<Element> parsedPages() {
  std::vector<Element> all;
  for (const std::string& text : pages()) all.push_back(parsePage(text));
  return all;
}

std::size_t columnsOf(const Element& row) {
  std::size_t columns = 0;
  for (const Element& cell : row.children)
    columns += cell.at("colspan").empty() ? 1 : std::stoul(cell.at("colspan"));
  return columns;
}

/// The pixels of a path that has absolute moves and lines only.
std::vector<Eigen::Vector2d> pixelsOf(const Element& path) {
  std::string d = path.at("d");
  for (char& c : d)
    if (c == 'M' || c == 'L') c = ' ';
  std::istringstream numbers(d);
  std::vector<Eigen::Vector2d> pixels;
  for (Eigen::Vector2d point; numbers >> point.x() >> point.y();) pixels.push_back(point);
  return pixels;
}

const Element& only(const std::vector<const Element*>& found) {
  if (found.size() != 1) throw std::runtime_error(std::to_string(found.size()) + " elements");
  return *found.front();
}

const Element& sectionOf(const Element& page, const char* id) {
  return only(page.all([&](const Element& e) { return e.at("id") == id; }));
}

/// The cells of the row of the first table in the section whose header is that, as text.
std::vector<std::string> cellsOf(const Element& section, const std::string& header) {
  for (const Element* row : section.named("tr"))
    if (!row->children.empty() && row->children[0].allText() == header) {
      std::vector<std::string> cells;
      for (const Element& cell : row->children) cells.push_back(cell.allText());
      return cells;
    }
  return {};
}

}  // namespace

TEST(BatchReport, PagesAreWellFormedAndPointOnlyToThemselves) {
  for (const std::string& text : pages()) {
    const Element page = parsePage(text);
    EXPECT_EQ(page.at("lang"), "en");
    std::set<std::string> ids;
    page.each([&](const Element& one) {
      if (one.at("id").empty()) return;
      EXPECT_TRUE(ids.insert(one.at("id")).second) << one.at("id") << " twice";
    });
    for (const Element* link : page.named("a")) {
      ASSERT_EQ(link->at("href").substr(0, 1), "#");
      EXPECT_EQ(ids.count(link->at("href").substr(1)), 1u) << link->at("href");
    }
    page.each([&](const Element& one) {
      std::istringstream labels(one.at("aria-labelledby"));
      for (std::string id; labels >> id;) EXPECT_EQ(ids.count(id), 1u) << id;
    });
  }
}

TEST(BatchReport, NothingComesFromTheNetwork) {
  for (const std::string& text : pages())
    for (const char* way : {"http:", "https:", "src=", "url(", "@import", "<script", "<link",
                            "<img", "<iframe", "<object"})
      EXPECT_EQ(text.find(way), std::string::npos) << way;
}

TEST(BatchReport, HeadingsStepDownOneByOne) {
  for (const std::string& text : pages()) {
    int before = 0, tops = 0;
    parsePage(text).each([&](const Element& one) {
      if (one.name.size() != 2 || one.name[0] != 'h' || !std::isdigit(one.name[1])) return;
      const int level = one.name[1] - '0';
      tops += level == 1;
      EXPECT_LE(level, before + 1) << one.allText();
      before = level;
    });
    EXPECT_EQ(tops, 1);
  }
}

TEST(BatchReport, TablesHaveCaptionsScopesAndFullRows) {
  std::size_t tables = 0;
  for (const Element& page : parsedPages())
    for (const Element* table : page.named("table")) {
      ++tables;
      EXPECT_EQ(table->children.front().name, "caption");
      std::set<std::size_t> widths;
      for (const Element* row : table->named("tr")) widths.insert(columnsOf(*row));
      EXPECT_EQ(widths.size(), 1u) << table->children.front().allText();
      for (const Element* head : table->named("th")) EXPECT_FALSE(head->at("scope").empty());
    }
  EXPECT_GT(tables, 20u);
}

TEST(BatchReport, PlotsAreDescribedInWords) {
  std::size_t plots = 0;
  for (const Element& page : parsedPages())
    for (const Element* svg : page.named("svg")) {
      if (!svg->hasClass("plot")) continue;
      ++plots;
      EXPECT_EQ(svg->at("role"), "img");
      ASSERT_GE(svg->children.size(), 2u);
      EXPECT_EQ(svg->children[0].name, "title");
      EXPECT_EQ(svg->children[1].name, "desc");
      EXPECT_FALSE(svg->children[0].text.empty() || svg->children[1].text.empty());
    }
  EXPECT_GT(plots, 10u);
}

TEST(BatchReport, WhatDoesNotExistIsADash) {
  const std::regex notANumber("(^|[^a-z])(nan|-nan|inf|null)([^a-z]|$)", std::regex::icase);
  for (const std::string& text : pages()) {
    std::smatch match;
    EXPECT_FALSE(std::regex_search(text, match, notANumber)) << match.prefix().str().substr(0, 60);
  }
  const Element page = parsePage(batchReport(smallBatch()));
  const auto cells = cellsOf(sectionOf(page, "sessions"), "three");
  ASSERT_EQ(cells.size(), 7u);
  EXPECT_EQ(cells[1], "\xE2\x80\x93");
}

TEST(BatchReport, HostileNamesAreTextAndNothingElse) {
  BatchResults batch = smallBatch();
  const std::string evil = "<script>alert('x')</script>&\"]]>";
  batch.configurations[0].name = batch.configurations[0].description =
      batch.configurations[0].protocol = evil;
  batch.configurations[0].config = "[a]\nkey = " + evil + "\n";
  batch.sessions[0].name = batch.title = batch.command = batch.name = evil;
  batch.results[1].runs[1].failure = batch.failures[0].log = evil;
  const BatchTimings timings{evil, 1, 1, {{evil, {1}}}};
  const Element page = parsePage(batchReport(batch, &timings));
  EXPECT_TRUE(page.named("script").empty());
  EXPECT_EQ(only(page.named("h1")).text, evil);
}

TEST(BatchReport, BytesThatAreNoUtf8AreReplaced) {
  BatchResults batch = smallBatch();
  // Lone bytes, a form too long, half a pair, beyond Unicode, a control character; ü is left.
  batch.title = "a\xFF\x80z\xC0\xAF\xED\xA0\x80\xF4\x90\x80\x80\x01\xC3\xBC";
  const std::string r = "\xEF\xBF\xBD";
  const Element page = parsePage(batchReport(batch));
  EXPECT_EQ(only(page.named("h1")).text,
            "a" + r + r + "z" + r + r + r + r + r + r + r + r + r + r + "\xC3\xBC");
}

TEST(BatchReport, SessionsAreInThePapersLayout) {
  const Element page = parsePage(batchReport(smallBatch()));
  const Element& section = sectionOf(page, "sessions");
  EXPECT_EQ(cellsOf(section, "one<&\">"),
            (std::vector<std::string>{"one<&\">", "100.0", "0.200 ± 0.141", "0.400 ± 0.283",
                                      "0.300 ± 0.141", "0.600 ± 0.283", "2"}));
  EXPECT_EQ(cellsOf(section, "two_2"), (std::vector<std::string>{"two_2", "25.0", "0.400", "0.800",
                                                                 "0.800", "1.600", "2, 1 failed"}));
  EXPECT_EQ(cellsOf(section, "Mean of sessions"),
            (std::vector<std::string>{"Mean of sessions", "62.5", "1.533", "3.067", "0.700",
                                      "1.400", "6, 2 wrong, 1 failed in all"}));
}

TEST(BatchReport, HeadlinesTellWhatWasLost) {
  const Element page = parsePage(batchReport(smallBatch()));
  const Element lead = only(page.all([](const Element& e) { return e.hasClass("lead"); }));
  const std::string text = lead.allText();
  EXPECT_NE(text.find("2 of 7 runs had a wrong pose and 1 failed."), std::string::npos) << text;
  EXPECT_NE(text.find("No run got through session three"), std::string::npos) << text;
  EXPECT_NE(text.find("1.533"), std::string::npos) << text;
  EXPECT_NE(text.find("20 times"), std::string::npos) << text;
  const auto rows = sectionOf(page, "troubles").named("tr");
  EXPECT_EQ(rows.size(), 2 + 4u);  // two heads, one task, one failed run, two lost ones
  BatchResults fine = smallBatch();
  fine.results.resize(1);
  fine.failures.clear();
  const std::string page2 = batchReport(fine);
  EXPECT_NE(page2.find("All 2 runs kept their pose; none failed."), std::string::npos);
  EXPECT_EQ(page2.find("What went wrong"), std::string::npos);
}

TEST(BatchReport, OfManyConfigurationsTheBestAndTheWorstAreNamed) {
  BatchResults batch = smallBatch();
  const double errors[] = {0.3, 0.2, 0.5, 0.4};
  batch.configurations = {
      {"A", "", "", ""}, {"B", "", "", ""}, {"C", "", "", ""}, {"D", "", "", ""}};
  batch.results.clear();
  for (std::size_t i = 0; i < 4; ++i)
    for (std::size_t k = 0; k < 2; ++k) {
      SessionResult result;
      result.configuration = i, result.session = k;
      result.runs = {runWith(0, errors[i] * (k == 0 ? 0.9 : 1.1), 0.1)};
      batch.results.push_back(result);
    }
  const Element page = parsePage(batchReport(batch));
  const Element lead = only(page.all([](const Element& e) { return e.hasClass("lead"); }));
  std::set<std::string> named;
  for (const Element* name : lead.named("em")) named.insert(name->text);
  EXPECT_EQ(named, (std::set<std::string>{"B", "C"}));
}

TEST(BatchReport, PublishedFiguresStandBesideOursOnlyForTheirDataset) {
  BatchResults batch = smallBatch();
  EXPECT_EQ(batchReport(batch).find("Schaefer"), std::string::npos);
  batch.dataset = "nclt";
  const Element page = parsePage(batchReport(batch));
  const Element& section = sectionOf(page, "published");
  EXPECT_EQ(cellsOf(section, "Dong et al. 2021"),
            (std::vector<std::string>{"Dong et al. 2021", "0.174", "0.293", "0.761", "1.016"}));
  for (const char* row :
       {"Published: Means of 27 sessions", "plain: no upkeep. 3 sessions, 2 runs of each, 2 wrong"})
    EXPECT_NE(section.allText().find(row), std::string::npos) << row;
  EXPECT_EQ(
      cellsOf(section, "polemcl, up_keep 100 %"),
      (std::vector<std::string>{"polemcl, up_keep 100 %", "0.200", "0.400", "0.500", "1.000"}));
}

TEST(BatchReport, PublishedFiguresOfASessionStandBesideOurs) {
  const Element page = parsePage(batchReport(scoredBatch()));
  const Element& section = sectionOf(page, "sessions");
  const std::string dash = "\xE2\x80\x93";
  EXPECT_EQ(cellsOf(section, "two_2"),
            (std::vector<std::string>{"two_2", "25.0", "50.0", "0.400", "0.120", "0.130", "0.800",
                                      "0.146", "0.178", "0.800", "0.626", "0.663", "1.600", "0.810",
                                      "0.857", "2, 1 failed"}));
  EXPECT_EQ(cellsOf(section, "one<&\">")[4], dash);
  EXPECT_EQ(cellsOf(section, "Session")[1], "this run");  // also the name of settings: ours
  // Below, the means of theirs over the sessions that they have and we have figures of.
  const auto mean = cellsOf(section, "Mean of sessions");
  EXPECT_EQ(mean[2], "37.5");
  EXPECT_EQ(mean[4], "0.183");  // 0.120 and 0.246
  EXPECT_EQ(mean[5], "0.130");
}

TEST(BatchReport, ShortErrorsAreInCentimetres) {
  BatchResults batch = scoredBatch();
  batch.results[1].runs = {runWith(0, 0.006, 0.2), runWith(1, 0.0084, 0.2)};
  batch.results[1].score.reset();
  const std::string text = batchReport(batch);
  const Element page = parsePage(text);
  const Element& section = sectionOf(page, "sessions");
  EXPECT_EQ(cellsOf(section, "two_2")[3], "0.72 ± 0.17");  // 0.6 and 0.84 cm, 0.24/√2 cm
  EXPECT_EQ(cellsOf(section, "two_2")[4], "12.0");
  EXPECT_EQ(cellsOf(section, "three")[3], "400.0");
  EXPECT_NE(text.find("Δ<sub>pos</sub> (cm)"), std::string::npos);
  BatchResults one = batch;
  one.results = {batch.results[1]};
  one.failures.clear();
  const std::string alone = batchReport(one);
  EXPECT_NE(alone.find("The position error is <strong>0.72\xC2\xA0"
                       "cm</strong>"),
            std::string::npos);
  EXPECT_NE(alone.find("<p class=\"big\">0.72<span> cm</span></p>"), std::string::npos);
}

TEST(BatchReport, ScoresOfMapsStandBelowThosePublished) {
  BatchResults batch = scoredBatch();
  EXPECT_EQ(batchReport(smallBatch()).find("Map scores"), std::string::npos);
  batch.dataset = "semantickitti";
  const std::string dash = "\xE2\x80\x93";
  const Element page = parsePage(batchReport(batch));
  const Element& section = sectionOf(page, "scores");
  EXPECT_EQ(cellsOf(section, "Dong et al. 2021"),
            (std::vector<std::string>{"Dong et al. 2021", "0.687", "0.439", "0.515", dash, dash,
                                      dash, dash, dash, dash, dash}));
  EXPECT_EQ(cellsOf(section, "polemcl, plain"),
            (std::vector<std::string>{"polemcl, plain", "0.750", "0.600", "0.667", "0.625", "0.500",
                                      "0.556", "0.500", "0.400", "0.444", "1"}));
  EXPECT_TRUE(cellsOf(section, "three").empty());  // one map each: nothing more to tell
  batch.results[0].score = smallScores();
  const Element more = parsePage(batchReport(batch));
  EXPECT_EQ(cellsOf(sectionOf(more, "scores"), "three"),
            (std::vector<std::string>{"three", "plain", "0.750", "0.600", "0.667", "0.625", "0.500",
                                      "0.556", "0.500", "0.400", "0.444", "8", "10", "truth.csv"}));
}

TEST(BatchReport, MapsAloneAreNoTrouble) {
  BatchResults batch = scoredBatch();
  for (SessionResult& result : batch.results) result.runs.clear();
  batch.failures.clear();
  const std::string text = batchReport(batch);
  EXPECT_NE(text.find("The F1 of the maps is <strong>0.667</strong> with <em>plain</em>"),
            std::string::npos);
  EXPECT_NE(text.find("Maps only: no session was to be localized."), std::string::npos);
  EXPECT_NE(text.find("<p class=\"big\">0.667</p>"), std::string::npos);
  EXPECT_EQ(text.find("alarm\">"), std::string::npos);
  EXPECT_EQ(text.find("id=\"settings\""), std::string::npos);
  batch.failures = {{"map.plain.three", "no pole found", ""}};  // a failed map is reported
  EXPECT_NE(batchReport(batch).find("alarm\">"), std::string::npos);
}

TEST(BatchReport, OnlyTheTimingsChangeWithTheTime) {
  EXPECT_EQ(batchReport(smallBatch()), batchReport(smallBatch()));
  EXPECT_EQ(batchReport(smallBatch()).find("Timings"), std::string::npos);
  const auto withoutTimings = [](std::string text) {
    const auto begin = text.find("<section id=\"timings\">");
    EXPECT_NE(begin, std::string::npos);
    return text.erase(begin, text.find("</section>", begin) - begin);
  };
  const BatchTimings fast = someTimings(1), slow = someTimings(60);
  const std::string a = batchReport(smallBatch(), &fast), b = batchReport(smallBatch(), &slow);
  EXPECT_NE(a, b);
  EXPECT_EQ(withoutTimings(a), withoutTimings(b));
  const Element page = parsePage(a);
  EXPECT_EQ(cellsOf(sectionOf(page, "timings"), "extract"),
            (std::vector<std::string>{"extract", "3", "6.0 s", "2.0 s", "3.0 s"}));
}

TEST(BatchReport, TheOrderOfTheResultsDoesNotMatter) {
  BatchResults batch = smallBatch();
  const std::string before = batchReport(batch);
  std::reverse(batch.results.begin(), batch.results.end());
  EXPECT_EQ(batchReport(batch), before);
}

TEST(BatchReport, MapsKeepShapesWithNorthUp) {
  const Element page = parsePage(batchReport(smallBatch()));  // 40 m along x, then 30 m along y
  const Element& section = sectionOf(page, "paths");
  std::vector<std::vector<Eigen::Vector2d>> paths;
  for (const Element* svg : section.named("svg"))
    if (svg->hasClass("map"))
      for (const Element* path : svg->named("path"))
        if (path->hasClass("truth")) paths.push_back(pixelsOf(*path));
  ASSERT_EQ(paths.size(), 1u);
  ASSERT_EQ(paths[0].size(), 3u);
  const Eigen::Vector2d east = paths[0][1] - paths[0][0], north = paths[0][2] - paths[0][1];
  EXPECT_NEAR(east.y(), 0, 0.11);
  EXPECT_NEAR(north.x(), 0, 0.11);
  EXPECT_GT(east.x(), 50);
  EXPECT_NEAR(-north.y() / east.x(), 0.75, 0.005);
}

TEST(BatchReport, GapsInTheErrorAreGapsInItsLine) {
  const Element page = parsePage(batchReport(smallBatch()));
  const auto lines = sectionOf(page, "paths").all([](const Element& e) {
    return e.hasClass("fine") && e.at("d").size() > 40;
  });
  const std::string d = only(lines).at("d");
  EXPECT_EQ(std::count(d.begin(), d.end(), 'M'), 2) << d;
}

TEST(BatchReport, EverySessionWithFiguresHasItsMark) {
  const Element page = parsePage(batchReport(smallBatch()));
  std::vector<std::size_t> marks;
  for (const Element* svg : sectionOf(page, "settings").named("svg"))
    if (svg->hasClass("wide"))
      marks.push_back(
          svg->all([](const Element& e) { return e.hasClass("mark") || e.hasClass("arrow"); })
              .size());
  EXPECT_EQ(marks, (std::vector<std::size_t>{4, 4}));
}

TEST(BatchReport, LabelsOfAnAxisDoNotTouch) {
  BatchResults batch = smallBatch();
  for (auto* points : {&batch.results[0].plots.truth, &batch.results[0].plots.estimate,
                       &batch.results[0].plots.mapPoles})
    for (Eigen::Vector2d& point : *points) point += Eigen::Vector2d(353000, 4026000);  // UTM
  std::size_t pairs = 0;
  const Element page = parsePage(batchReport(batch));
  for (const Element* svg : page.named("svg")) {
    std::map<std::string, std::vector<std::pair<double, std::size_t>>> rows;
    for (const Element* text : svg->named("text"))
      if (text->at("text-anchor") == "middle" && text->at("transform").empty())
        rows[text->at("y")].push_back({std::stod(text->at("x")), text->text.size()});
    for (auto& [y, labels] : rows) {
      std::sort(labels.begin(), labels.end());
      for (std::size_t i = 1; i < labels.size(); ++i, ++pairs)
        // 13 px sans serif: digits are at most 8.3 px wide (DejaVu Sans).
        EXPECT_GT(labels[i].first - labels[i - 1].first,
                  8.3 * (labels[i].second + labels[i - 1].second) / 2)
            << "row " << y;
    }
  }
  EXPECT_GT(pairs, 10u);
}

TEST(BatchReport, LabelsStayInsideTheirPlotAndOffTheTitleOfTheAxis) {
  BatchResults batch = smallBatch();
  for (double shift : {0.0, 1.3, 7.7, 12.9})
    for (auto* points : {&batch.results[0].plots.truth, &batch.results[0].plots.estimate}) {
      for (Eigen::Vector2d& point : *points)
        point += Eigen::Vector2d(shift, shift == 0 ? 4026000 : shift);
      const Element page = parsePage(batchReport(batch));
      for (const Element* svg : page.named("svg")) {
        if (!svg->hasClass("plot")) continue;
        std::istringstream box(svg->at("viewBox"));
        double x = 0, y = 0, width = 0;
        box >> x >> y >> width;
        for (const Element* text : svg->named("text")) {
          if (!text->at("transform").empty()) continue;
          const double at = std::stod(text->at("x")), size = 8.3 * text->text.size();
          if (text->at("text-anchor") == "end") {
            EXPECT_GT(at - size, 19) << text->text;
          } else {
            EXPECT_LT(at + size / 2, width + 1) << text->text;
          }
        }
      }
    }
}

TEST(BatchReport, ChangedKeysAreShownSideBySide) {
  BatchResults batch = smallBatch();
  batch.configurations[0].config =
      "[map]\ncount = 6 ; detections\nsame = 1\n[filter]\ncount = 500\n";
  batch.configurations[1].config = "[map]\nsame = 1 # as there\ncount = 9\n";
  const Element page = parsePage(batchReport(batch));
  const Element& section = sectionOf(page, "configuration");
  EXPECT_EQ(cellsOf(section, "map.count"), (std::vector<std::string>{"map.count", "6", "9"}));
  EXPECT_EQ(cellsOf(section, "filter.count"),
            (std::vector<std::string>{"filter.count", "500", "\xE2\x80\x93"}));
  EXPECT_TRUE(cellsOf(section, "map.same").empty());
}

TEST(BatchReport, ALongBatchStaysBelowTenMegabytes) {
  BatchResults batch = smallBatch();
  batch.sessions.clear();
  batch.results.clear();
  for (std::size_t k = 0; k < 27; ++k) {
    batch.sessions.push_back({"session " + std::to_string(k), "", 5500, 20000, 5});
    for (std::size_t i = 0; i < 2; ++i) {
      SessionResult result;
      result.configuration = i, result.session = k;
      for (std::size_t run = 0; run < 10; ++run) result.runs.push_back(runWith(run, 0.1, 0.2));
      for (int j = 0; j < 3000; ++j)
        result.plots.mapPoles.emplace_back(400 * std::cos(j), 300 * std::sin(1.7 * j));
      for (int j = 0; j < 1500; ++j)
        result.plots.truth.emplace_back(400 * std::cos(0.01 * j), 300 * std::sin(0.017 * j));
      result.plots.estimate = result.plots.truth;
      result.plots.position = {10, std::vector<double>(500, 0.123)};
      batch.results.push_back(std::move(result));
    }
  }
  const std::string page = batchReport(batch);
  EXPECT_LT(page.size(), 10e6);
  EXPECT_GT(page.size(), 1e6);
}

TEST(BatchReport, IsWrittenAsItIs) {
  const testing_apps::TempFolder folder;
  writeBatchReport(smallBatch(), nullptr, folder / "report.html");
  EXPECT_EQ(testing_apps::readText(folder / "report.html"), batchReport(smallBatch()));
  EXPECT_THROW(writeBatchReport(smallBatch(), nullptr, folder / "missing" / "report.html"), Error);
  BatchResults broken = smallBatch();
  broken.results[0].mapShare = 2;
  EXPECT_THROW(writeBatchReport(broken, nullptr, folder / "other.html"), Error);
  EXPECT_EQ(testing_apps::names(folder.path()), (std::vector<std::string>{"report.html"}));
}

}  // namespace polemcl::report::test_batch_report
