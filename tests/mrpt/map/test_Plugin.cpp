// The library inside MRPT's own programs (Debian package mrpt-apps), which do not know it.
#include <gtest/gtest.h>
#include <mrpt/maps/CSimpleMap.h>
#include <mrpt/obs/CActionRobotMovement2D.h>
#include <mrpt/obs/CSensoryFrame.h>
#include <mrpt/poses/CPose3DPDFGaussian.h>
#include <mrpt/poses/CPosePDFGaussian.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <sstream>

#include <polemcl/mrpt/map/CPoleMap.h>
#include "core/common/PoleIndex.h"
#include "core/common/PoseEstimate.h"
#include "mrpt/rawlog/RawlogReader.h"
#include "mrpt/rawlog/RawlogWriter.h"
#include "support/ExpectHas.h"
#include "support/Samples.h"

namespace polemcl::test_plugin {
namespace {

using namespace mrpt::obs;

constexpr int scans = 20;

/// A street of poles with a drive along its middle, one scan per metre.
struct Street {
  testing_apps::TempFolder folder;
  Street() {
    std::vector<MapPole> poles;
    for (int i = 0; i < 8; ++i) poles.push_back(tests::mapPoleAt(5 * i, i % 2 ? 4 : -4));
    CPoleMap map;
    map.setPoles(poles);
    map.saveToPoleMapFile(folder / "m.polemap");
    RawlogWriter rawlog(folder / "p.rawlog");
    mrpt::maps::CSimpleMap simple;
    for (int x = 0; x < scans; ++x) drive(x, poles, rawlog, simple);
    rawlog.commit();
    simple.saveToFile(folder / "p.simplemap");
  }

  void drive(int x, const std::vector<MapPole>& poles, RawlogWriter& rawlog,
             mrpt::maps::CSimpleMap& simple) const {
    auto scan = std::make_shared<CObservationPoles>();
    scan->sensorLabel = "LIDAR";
    scan->timestamp = mrpt::Clock::fromDouble(1000.5 + x);
    for (const auto& pole : poles)
      if (std::abs(pole.x - x) < 12) scan->poles.push_back(samples::pole(pole.x - x, pole.y));
    CActionRobotMovement2D move;
    move.estimationMethod = CActionRobotMovement2D::emScan2DMatching;
    mrpt::math::CMatrixDouble33 C;
    C.setDiagonal(std::vector<double>{0.0025, 0.0025, 0.0002});
    // Errors of 4 cm, 2 cm and 0.4 degrees per metre, consistent with the covariance.
    const mrpt::poses::CPose2D motion(0.96, 0.02, 0.007);
    move.poseChange =
        mrpt::poses::CPosePDFGaussian::Create(x > 0 ? motion : mrpt::poses::CPose2D(), C);
    move.timestamp = scan->timestamp;
    CActionCollection actions;
    actions.insert(move);
    rawlog.write(actions, scan);
    auto frame = CSensoryFrame::Create();
    frame->insert(scan);
    simple.insert(mrpt::poses::CPose3DPDFGaussian::Create(mrpt::poses::CPose3D(x, 0, 0, 0, 0, 0)),
                  frame);
  }

  /// Output of a command, both streams; run in the folder of the street.
  std::string run(const std::string& command) const {
    const std::string line =
        "cd '" + folder.path().string() + "' && " + command + " </dev/null 2>&1";
    FILE* pipe = popen(line.c_str(), "r");
    std::string text;
    char buffer[4096];
    while (const std::size_t n = fread(buffer, 1, sizeof buffer, pipe)) text.append(buffer, n);
    const int status = pclose(pipe);
    EXPECT_EQ(status, 0) << command << "\n" << text;
    return text;
  }
  void write(const std::string& name, const std::string& text) const {
    std::ofstream(folder / name) << text;
  }
};

bool has(const char* program) {
  return std::system((std::string("command -v ") + program + " >/dev/null 2>&1").c_str()) == 0;
}

#define NEEDS(program) \
  if (!has(program)) GTEST_SKIP() << program << " is not installed: share/setup/install.sh"

/// MRPT's programs cannot load a library that was built for the address sanitizer.
#ifdef __SANITIZE_ADDRESS__
#define NEEDS_OF_MRPT(program) GTEST_SKIP() << program << " was built without the sanitizer"
#else
#define NEEDS_OF_MRPT(program) NEEDS(program)
#endif
const std::string kPlugin = std::string(" -p '") + POLEMCL_LIB + "' ";
const std::string kPreload = std::string("LD_PRELOAD='") + POLEMCL_LIB + "' ";

long objects(const std::string& info) {
  const auto at = info.find("Overall number of objects");
  return at == std::string::npos ? -1 : std::stol(info.substr(info.find(':', at) + 1));
}

/// What the library exports, demangled.
std::vector<std::string> exportedSymbols() {
  const std::string command = std::string("nm -DC --defined-only '") + POLEMCL_LIB + "'";
  FILE* pipe = popen(command.c_str(), "r");
  std::vector<std::string> names;
  char line[65536];
  while (fgets(line, sizeof line, pipe)) {
    const std::string text = line;  // address, letter, name
    if (text.size() > 19) names.push_back(text.substr(19, text.size() - 20));
  }
  EXPECT_EQ(pclose(pipe), 0) << command;
  return names;
}

/// True for what is in the namespace of this project, and for its tables of types.
bool isOwn(std::string symbol) {
  for (const std::string prefix : {"typeinfo for ", "typeinfo name for ", "vtable for ", "VTT for ",
                                   "non-virtual thunk to ", "virtual thunk to "})
    if (symbol.rfind(prefix, 0) == 0) symbol.erase(0, prefix.size());
  return symbol.rfind("polemcl::", 0) == 0;
}

TEST(Plugin, ExportsSymbolsOfThisProjectOnly) {
  NEEDS("nm");
  const std::vector<std::string> symbols = exportedSymbols();
  for (const std::string& symbol : symbols) EXPECT_TRUE(isOwn(symbol)) << symbol;
  EXPECT_LT(symbols.size(), 1000u);
}

TEST(Plugin, ExportsWhatPublicHeadersDeclare) {
  NEEDS("nm");
  const std::vector<std::string> symbols = exportedSymbols();
  for (const std::string wanted : {"typeinfo for polemcl::Error", "vtable for polemcl::CPoleMap",
                                   "polemcl::CPoleMap::TInsertionOptions::validate() const",
                                   "polemcl::LocalizationPipeline::step(polemcl::PoleScan const&)",
                                   "polemcl::PoleExtractor::report() const",
                                   "polemcl::compose(polemcl::Pose2D const&, "
                                   "polemcl::Pose2D const&)"})
    EXPECT_EQ(std::count(symbols.begin(), symbols.end(), wanted), 1) << wanted;
  // Nothing from private headers is visible.
  for (const std::string& symbol : symbols)
    EXPECT_EQ(symbol.find("polemcl::KdTree2D::"), std::string::npos) << symbol;
}

TEST(Plugin, RawlogEditReadsPoles) {
  NEEDS_OF_MRPT("rawlog-edit");
  const Street street;
  const std::string info = street.run("rawlog-edit" + kPlugin + "--info -i p.rawlog");
  EXPECT_EQ(objects(info), 2 * scans) << info;
  EXPECT_HAS(info, "LIDAR");
  // Reason for the library: without it, the program stops silently at the first pole observation.
  EXPECT_EQ(objects(street.run("rawlog-edit --info -i p.rawlog")), 1);
}

TEST(Plugin, RawlogEditDescribesAndExportsPoles) {
  NEEDS_OF_MRPT("rawlog-edit");
  const Street street;
  EXPECT_HAS(street.run("rawlog-edit" + kPlugin + "--describe -i p.rawlog"),
             "Poles: 3 (planar sensor frame, m)");
  street.run("rawlog-edit" + kPlugin + "--export-txt -i p.rawlog");
  std::ifstream file(street.folder / "p_LIDAR.txt");
  int rows = 0;
  for (std::string line; std::getline(file, line);) rows += line.find('%') == std::string::npos;
  EXPECT_EQ(rows, scans);
}

TEST(Plugin, RawlogEditCutsRawlogsOfPoles) {
  NEEDS_OF_MRPT("rawlog-edit");
  const Street street;
  street.run("rawlog-edit" + kPlugin + "--cut --to-index 9 -i p.rawlog -o cut.rawlog");
  RawlogReader reader(street.folder / "cut.rawlog");
  RawlogEntry entry;
  int frames = 0;
  while (reader.next(entry))
    frames += entry.frame && entry.frame->getObservationByClass<CObservationPoles>();
  EXPECT_GE(frames, 4);  // entries 0 to 9 are five pairs; MRPT may count one less
  EXPECT_LE(frames, 6);
}

TEST(Plugin, Observations2mapBuildsAPoleMap) {
  NEEDS_OF_MRPT("observations2map");
  const Street street;
  street.write("c.ini",
               "[Maps]\npoleMap_count = 1\n"
               "[Maps_poleMap_00_insertOpts]\nmerge_distance = 0.4\n");
  street.run(kPreload + "observations2map c.ini p.simplemap out -s Maps");
  CPoleMap built, truth;
  built.loadFromPoleMapFile(street.folder / "out_polemcl__CPoleMap_00.polemap");
  truth.loadFromPoleMapFile(street.folder / "m.polemap");
  ASSERT_EQ(built.poles().size(), 7u);     // the eighth is never nearer than 12 m
  EXPECT_EQ(built.poles()[0].count, 12u);  // the first is within reach from x = 0 to 11
  for (const auto& pole : built.poles()) {
    EXPECT_TRUE(truth.index().nearest(pole.x, pole.y, 1e-6));
    EXPECT_GE(pole.count, 1u);
    EXPECT_LE(pole.count, 20u);
  }
}

/// Results that pf-localization writes about a run.
struct Outcome {
  double error = 0;              ///< error of the weighted mean after the last scan, m
  double nees = 0;               ///< NEES of that mean in x, y and heading, with its covariance
  double spread = 0;             ///< root of the determinant of that covariance, m² rad
  std::vector<double> distance;  ///< mean error of the particles after each scan, m
};

/// All numbers of a file, row by row, without its header.
std::vector<double> numbersIn(const std::string& file) {
  std::ifstream in(file);
  std::vector<double> values;
  for (std::string line; std::getline(in, line);) {
    std::istringstream row(line[0] == '%' ? "" : line);
    for (double value = 0; row >> value;) values.push_back(value);
  }
  return values;
}

/// MRPT's own filter. The middle of the start is 1.2 m from the truth; the odometry ends with an
/// error of 3.5 m.
Outcome localize(const Street& street, const std::string& likelihood) {
  std::string truth;
  for (int x = 0; x < scans; ++x)
    truth += std::to_string(1000.5 + x) + " " + std::to_string(x) + " 0 0\n";
  street.write("truth.txt", truth);
  street.write("c.ini",
               "[PF_options]\nPF_algorithm = 0\nadaptiveSampleSize = false\nsampleSize = 1\n"
               "resamplingMethod = 3\nBETA = 0.5\n"
               "[LocalizationExperiment]\nlogOutput_dir = LOG\nrawlog_file = p.rawlog\n"
               "ground_truth_path_file = truth.txt\n"
               "particles_count = 2000\n3DSceneFrequency = " +
                   std::to_string(scans) +
                   "\n"
                   "init_PDF_mode = 1\ninit_PDF_min_x = -2.2\ninit_PDF_max_x = 0.4\n"
                   "init_PDF_min_y = -0.5\ninit_PDF_max_y = 2.1\n"
                   "init_PDF_min_yaw_deg = -3\ninit_PDF_max_yaw_deg = 7\n"
                   "[MetricMap]\npoleMap_count = 1\n"
                   "[MetricMap_poleMap_00_creationOpts]\nmap_file = m.polemap\n"
                   "[MetricMap_poleMap_00_likelihoodOpts]\nsigma_m = 0.2\nweighted = false\n" +
                   likelihood);
  street.run(kPreload + "pf-localization c.ini");
  const std::string log = street.folder / "LOG_000_0002000/";
  Outcome run;
  run.distance = numbersIn(log + "GT_error.txt");
  run.spread = numbersIn(log + "cov_est.txt").back();
  const std::vector<double> numbers = numbersIn(log + "particles/particles_00019.txt");
  std::vector<Pose2D> poses;
  std::vector<double> logWeights;
  for (std::size_t i = 0; i + 3 < numbers.size(); i += 4) {
    poses.push_back({numbers[i], numbers[i + 1], numbers[i + 2]});
    logWeights.push_back(numbers[i + 3]);
  }
  const PoseWithCovariance estimate = weightedMean(poses, logWeights);
  const Eigen::Vector3d error(estimate.mean.x - (scans - 1), estimate.mean.y, estimate.mean.yaw);
  run.error = error.head<2>().norm();
  run.nees = error.dot(estimate.covariance.inverse() * error);
  return run;
}

TEST(Plugin, PfLocalizationFindsItsWayOnAPoleMap) {
  NEEDS_OF_MRPT("pf-localization");
  const Street street;
  constexpr double nearby = 0.1, sure = 5e-5;  // m, m² rad
  const Outcome found = localize(street, "");
  ASSERT_EQ(found.distance.size(), scans - 1u);  // the first scan is not filtered
  EXPECT_LT(found.error, nearby);
  EXPECT_LT(found.spread, sure);
  EXPECT_LT(found.nees, 11.3);  // 99 % of chi-square with 3 degrees of freedom
  EXPECT_LT(*std::max_element(found.distance.begin() + 3, found.distance.end()), 2 * nearby);
  // With a likelihood that matches nothing, the same run misses these bounds by far.
  const Outcome dead = localize(street, "gate_m = 1e-6\n");
  ASSERT_EQ(dead.distance.size(), scans - 1u);
  EXPECT_GT(dead.error, 20 * nearby);
  EXPECT_GT(dead.spread, 500 * sure);
  EXPECT_GT(dead.distance.back(), 20 * nearby);
}

}  // namespace
}  // namespace polemcl::test_plugin
