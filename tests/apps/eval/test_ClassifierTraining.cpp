#include <algorithm>
#include <map>
#include <random>
#include <regex>
#include <sstream>

#include "eval/ClassifierTraining.h"
#include "eval/EvalApp.h"
#include "io/file/CsvTable.h"
#include "sim/drive/Simulation.h"
#include "support/StreetTest.h"

namespace polemcl::test_classifier_training {

using namespace polemcl;
using namespace polemcl::apps;
using namespace testing_apps;

namespace {

const std::string columns =
    "scan,x,y,pole,squared_error,segments,points,extent,passed,wide,not_whole,scatter,width_spread,"
    "tilt,top,missing_top,bottom,rough_radius,range,column_width,hidden_edges,clutter,residual,"
    "radius\n";

class ClassifierTraining : public StreetTest {
 protected:
  /// A drive in which poles have little clutter and small residuals, with noise.
  fs::path writeTable(const std::string& name, unsigned seed) {
    std::mt19937 random(seed);
    std::normal_distribution<double> normal;
    std::string text = "# sensor hdl32e\n# labels true_poles\n# column_angle 0.003\n" + columns;
    for (int i = 0; i < 400; ++i) {
      const bool pole = i % 3 == 0;
      const double clutter = (pole ? 0.2 : 0.7) + 0.2 * normal(random);
      const double residual = 0.03 + (pole ? 0 : 0.02) + 0.01 * std::abs(normal(random));
      text += "0,1,2," + std::to_string(pole) + "," + (pole ? "2.5" : "") +
              ",8,30,2,0.1,0.1,0.5,0.05,0.05,0.05,4,0,0.5,0.1,15,0.05,0.2," +
              std::to_string(clutter) + "," + std::to_string(residual) + "," +
              std::to_string(0.1 + 0.01 * normal(random)) + "\n";
    }
    writeText(folder / name, text);
    return folder / name;
  }
  TrainOptions options() {
    TrainOptions options;
    options.candidates = {writeTable("a.csv", 1), writeTable("b.csv", 2)};
    options.test = {writeTable("c.csv", 3)};
    options.products = 2;
    options.ridge = 1;
    options.classifier = folder / "classifier.csv";
    options.covariance = folder / "covariance.csv";
    options.json = folder / "report.json";
    return options;
  }
};

}  // namespace

TEST_F(ClassifierTraining, LearnsWhatTellsPolesApart) {
  const auto scores = trainClassifier(options());
  ASSERT_EQ(scores.size(), 3u);  // two left out, one test
  for (const DriveScore& score : scores) {
    EXPECT_EQ(score.poles, 134u);
    EXPECT_LT(score.loss, 0.2) << score.drive;
    EXPECT_LT(score.loss, score.builtInLoss);
    EXPECT_GT(score.precision, 0.95);
  }
  EXPECT_TRUE(scores[0].leftOut);
  EXPECT_FALSE(scores[2].leftOut);
  const std::string weights = readText(folder / "classifier.csv");
  EXPECT_EQ(std::count(weights.begin(), weights.end(), '\n'), 4 + kClassifierTerms + 2);
}

TEST_F(ClassifierTraining, WritesTablesThatTheBuildReads) {
  trainClassifier(options());
  const std::string text = readText(folder / "classifier.csv");
  EXPECT_NE(text.find("\nclutter,0.5"), std::string::npos) << text;  // the mean of the table above
  EXPECT_NE(text.find("*"), std::string::npos);                      // products
  EXPECT_EQ(text.find("range*"), std::string::npos) << text;         // constant in this table
  const std::regex row("[A-Za-z]+([*][A-Za-z]+)?(,[-+.0-9e]+)+");    // see Weights.cmake
  std::istringstream lines(text.substr(text.find("\none,") + 1));
  for (std::string line; std::getline(lines, line);)
    EXPECT_TRUE(std::regex_match(line, row)) << line;
  const std::string scale = readText(folder / "covariance.csv");
  EXPECT_NE(scale.find("term,weight\none,"), std::string::npos);
}

TEST_F(ClassifierTraining, TheSameTablesGiveTheSameBytes) {
  trainClassifier(options());
  const std::string first = readText(folder / "classifier.csv");
  trainClassifier(options());
  EXPECT_EQ(readText(folder / "classifier.csv"), first);
}

TEST_F(ClassifierTraining, ASingleTableIsFittedAndNotScored) {
  auto single = options();
  single.candidates.resize(1);
  EXPECT_EQ(trainClassifier(single).size(), single.test.size());
  EXPECT_TRUE(fs::exists(folder / "classifier.csv"));
}

TEST_F(ClassifierTraining, WithoutKnownErrorsNothingIsWritten) {
  auto wrong = options();
  for (auto& table : wrong.candidates) {
    const std::string text = readText(table);
    writeText(table, std::regex_replace(text, std::regex(",2\\.5,"), ",,"));
    ASSERT_NE(readText(table), text);
  }
  EXPECT_THROW(trainClassifier(wrong), Error);
  EXPECT_FALSE(fs::exists(folder / "classifier.csv"));
}

TEST_F(ClassifierTraining, RefusesOtherTables) {
  writeText(folder / "x.csv", "a,b\n1,2\n");
  auto wrong = options();
  wrong.candidates = {folder / "x.csv"};
  EXPECT_THROW(trainClassifier(wrong), Error);
}

TEST_F(ClassifierTraining, CandidatesOfASimulatedStreetAreLabelledByItsPoles) {
  AllSettings settings = this->settings();
  settings.simulation.sensor = "hdl32e";
  settings.simulation.world.length = 80;
  settings.simulation.spacing = 8;
  fs::create_directories(folder / "street");
  sim::simulate(settings.simulation, folder / "street", {}, settings.sensor);
  CandidatesOptions options;
  options.scans = folder / "street";
  options.poles = folder / "street" / "poles_gt.csv";
  options.output = folder / "true.csv";
  const CandidatesSummary byPoles = writeCandidates(options, settings);
  EXPECT_EQ(byPoles.scans, 10u);
  EXPECT_GT(byPoles.poles, 40u);
  EXPECT_GT(byPoles.others, 40u);
  const LabelledDrive drive = readCandidates(folder / "true.csv");
  EXPECT_EQ(drive.candidates.size(), byPoles.poles + byPoles.others);
  EXPECT_FALSE(drive.real);
  // The built-in weights tell them apart, so features and labels belong together.
  double right = 0;
  for (const LabelledCandidate& each : drive.candidates)
    right += (poleOdds(each.features) > 0) == each.pole;
  EXPECT_GT(right / static_cast<double>(drive.candidates.size()), 0.85);

  // Labels by consistency agree with the truth, where they say anything.
  options.poles = std::nullopt;
  options.output = folder / "seen.csv";
  const CandidatesSummary bySight = writeCandidates(options, settings);
  EXPECT_GT(bySight.poles, 10u);
  EXPECT_TRUE(readCandidates(folder / "seen.csv").real);
  std::map<std::string, bool> truth;
  const io::CsvTable a(folder / "true.csv"), b(folder / "seen.csv");
  const auto key = [](const io::CsvTable& t, std::size_t i) {
    return t.text(i, 0) + " " + t.text(i, 1) + " " + t.text(i, 2);
  };
  for (std::size_t i = 0; i < a.rows(); ++i) truth[key(a, i)] = a.count(i, a.column("pole")) == 1;
  double polesRight = 0, poles = 0, othersRight = 0, others = 0;
  for (std::size_t i = 0; i < b.rows(); ++i) {
    const auto known = truth.find(key(b, i));
    if (known == truth.end()) continue;
    const bool pole = b.count(i, b.column("pole")) == 1;
    (pole ? poles : others) += 1;
    (pole ? polesRight : othersRight) += known->second == pole;
  }
  EXPECT_GT(polesRight / poles, 0.95) << polesRight << " of " << poles;
  EXPECT_GT(othersRight / others, 0.9) << othersRight << " of " << others;
}

TEST_F(ClassifierTraining, CandidatesNeedPosesAndTheLidarsOwnFrame) {
  CandidatesOptions options;
  options.scans = folder / "nothing";
  options.output = folder / "out.csv";
  EXPECT_THROW(writeCandidates(options, settings()), Error);
  AllSettings hanging = settings();
  hanging.sensor.upsideDown = true;
  EXPECT_THROW(writeCandidates(options, hanging), Error);
}

TEST_F(ClassifierTraining, TheProgramPrintsScores) {
  const auto o = options();
  const auto done = runProgram(evalMain, {"train", "--candidates", o.candidates[0].string(),
                                          o.candidates[1].string(), "--test", o.test[0].string(),
                                          "--classifier", at("w.csv"), "--json", at("r.json")});
  EXPECT_EQ(done.code, 0) << done.err;
  EXPECT_NE(done.out.find("c "), std::string::npos);
  EXPECT_NE(done.out.find("test"), std::string::npos);
}

}  // namespace polemcl::test_classifier_training
