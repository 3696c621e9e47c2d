#include <polemcl/io/data/Cloud.h>
#include "fuzz/Fuzz.h"
#include "io/data/PcdFile.h"
#include "io/dataset/LabelledScans.h"
#include "io/dataset/NcltScans.h"
#include "support/NcltSamples.h"

namespace polemcl::fuzz {
namespace {

void readPcd(std::string_view bytes) {
  io::readPcd(fileOf("a.pcd", bytes));
}

std::vector<std::string> pcdSeeds() {
  const auto head = [](const std::string& data, const std::string& fields, const char* size) {
    return "# .PCD v0.7\nVERSION 0.7\nFIELDS " + fields + "\nSIZE " + size +
           "\nTYPE F F F U\nCOUNT 1 1 1 1\nWIDTH 2\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS 2\n"
           "DATA " +
           data + "\n";
  };
  // Compressed: two lengths, then LZF of 28 bytes: a literal run of 28.
  const std::string lzf = std::string("\x1d\0\0\0\x1c\0\0\0\x1b", 9) + std::string(28, '\x3f');
  return {head("ascii", "x y z intensity", "4 4 4 1") + "1 2 3 4\n-5 nan 0.5 255\n",
          head("binary", "x y z intensity", "4 4 4 2") + std::string(28, '\x40'),
          head("binary_compressed", "x y z intensity", "4 4 4 2") + lzf};
}

void readHits(std::string_view bytes) {
  const auto file = fileOf("velodyne_hits.bin", bytes);
  std::vector<std::string> notes;
  for (const io::NcltTurn& turn : io::findNcltTurns(file, notes)) {
    io::readNcltTurn(file, turn, io::TurnMotion());
    io::readNcltTurn(file, turn, std::nullopt);
  }
}

void readScan(std::string_view bytes) {
  static const Readers readers{[](auto rest) { io::readKittiBin(fileOf("a.bin", rest)); },
                               [](auto rest) { io::readNcltSync(fileOf("a.bin", rest)); },
                               [](auto rest) {
                                 const auto parts = pieces(rest, 2);
                                 io::readLabelledCloud(fileOf("a.bin", parts.front()),
                                                       fileOf("a.label", parts.back()));
                               },
                               readHits};
  readWithOne(readers, bytes);
}

std::vector<std::string> scanSeeds() {
  using namespace testing_nclt;
  return {inputFor(0, std::string(32, '\x3f')), inputFor(1, point(1, 2, 3) + point(0, 0, 0)),
          inputFor(2, joined({std::string(32, '\x3f'), std::string(8, '\1')})),
          inputFor(3, turning(30, -15))};
}

}  // namespace

std::vector<Target> scanTargets() {
  return {{"pcd", readPcd, pcdSeeds}, {"scans", readScan, scanSeeds}};
}

}  // namespace polemcl::fuzz
