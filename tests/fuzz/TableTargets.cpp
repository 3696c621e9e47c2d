#include "cli/RunRecords.h"
#include "fuzz/Fuzz.h"
#include "io/data/Trajectory.h"
#include "io/dataset/LabelledScans.h"
#include "io/file/CsvTable.h"
#include "io/file/Date.h"
#include "io/file/TextFile.h"
#include "io/map/Datum.h"
#include "io/map/PoleTables.h"
#include "map/DriveFixFiles.h"
#include "map/Inventory.h"
#include "map/MappingSession.h"
#include "report/batch/PublishedResults.h"

namespace polemcl::fuzz {
namespace {

/// What programs ask of a table.
void readTable(std::string_view bytes) {
  const io::CsvTable table(fileOf("a.csv", bytes));
  for (std::size_t row = 0; row < table.rows(); ++row)
    for (std::size_t column = 0; column < table.names().size(); ++column) {
      table.find(table.names()[column]);
      table.text(row, column);
      table.number(row, column);
      table.count(row, column);
    }
}

void readRows(std::string_view bytes) {
  io::NumberRowReader rows(fileOf("a.csv", bytes), 3, "utime, x, y", io::Separator::commas);
  for (std::vector<double> row; rows.next(row);) io::allFinite(row);
}

const Readers& tables() {
  static const Readers readers{
      readTable,
      readRows,
      [](auto bytes) { io::readPoleCsv(fileOf("a.csv", bytes)); },
      [](auto bytes) { io::readPolePositions(fileOf("a.csv", bytes)); },
      [](auto bytes) { io::readWorldPoles(fileOf("a.csv", bytes)); },
      [](auto bytes) { apps::readGnssCsv(fileOf("a.csv", bytes)); },
      [](auto bytes) { apps::readEstimates(fileOf("a.csv", bytes)); },
      [](auto bytes) { apps::HealthRecords(fileOf("a.csv", bytes)).isOk(0); },
      [](auto bytes) { report::readPublishedSessions(fileOf("a.csv", bytes)); },
      [](auto bytes) { apps::readCsvInventory(fileOf("a.csv", bytes), {}, ';'); }};
  return readers;
}

std::vector<std::string> tableSeeds() {
  return {inputFor(0, "a,b,\"c, d\"\r\n# comment\n1,2.5,\"3\"\n-0,1e300,4294967295\n"),
          inputFor(1, "1326652795000000,1.5,nan\n1326652795100000,inf,-2\n"),
          inputFor(2, made("street.csv")),
          inputFor(2, made("session.csv")),
          inputFor(3, "x,y\n1,2\n-3.5,4e2\n"),
          inputFor(3, "id,x,y,radius,top\n1,2,3,0.1,4\n"),
          inputFor(4, made("drive/poles_gt.csv")),
          inputFor(5,
                   "time,latitude,longitude,sigma,antenna_x,antenna_y\n1,50.5,7.25,0.5,1,0\n"
                   "2,50.5001,7.25,0.5,1,0\n"),
          inputFor(6, apps::kEstimateColumns + apps::estimateRow(0, 1.5, {})),
          inputFor(7, "scan,time,state\n0,1.5,ok\n1,1.6,lost\n"),
          inputFor(8,
                   "system,session,f_map,pos_mean,pos_rmse,ang_mean_deg,ang_rmse_deg\n"
                   "authors,2012-01-08,0.5,0.1,0.2,,1\n"),
          inputFor(9, "id;lon;lat;kind\n1;7.25;50.5;\"lamp; old\"\n"),
          inputFor(9, "x;y;height\n364000;5620000;4,5\n")};
}

void readTrajectory(std::string_view bytes) {
  static const Readers readers{[](auto rest) { io::readTum(fileOf("a.tum", rest)); },
                               [](auto rest) {
                                 const apps::SessionPoses poses(apps::PoseKind::truth,
                                                                fileOf("a.tum", rest));
                                 poses.at(0, 1.5);
                                 poses.velocityAt(1.5);
                               },
                               [](auto rest) { io::readKittiPoses(fileOf("a.txt", rest)); },
                               [](auto rest) { io::parseDatum(std::string(rest), "datum: "); },
                               [](auto rest) { io::secondsOfDate(std::string(rest)); }};
  readWithOne(readers, bytes);
}

std::vector<std::string> trajectorySeeds() {
  const std::string tum = "# time x y z qx qy qz qw\n1.5 1 2 0 0 0 0.6 0.8\n1.6 1.1 2 0 0 0 0 1\n";
  return {inputFor(0, tum),
          inputFor(1, tum),
          inputFor(0, made("drive.tum")),
          inputFor(1, made("drive.tum")),
          inputFor(2, "1 0 0 5 0 1 0 6 0 0 1 7\n0 -1 0 5.5 1 0 0 6 0 0 1 7\n"),
          inputFor(3, "50.5 7.25 -12.5"),
          inputFor(4, "2012-02-29")};
}

}  // namespace

std::vector<Target> tableTargets() {
  return {{"tables", [](auto bytes) { readWithOne(tables(), bytes); }, tableSeeds},
          {"trajectories", readTrajectory, trajectorySeeds}};
}

}  // namespace polemcl::fuzz
