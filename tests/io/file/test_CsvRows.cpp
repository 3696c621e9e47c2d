#include <cmath>

#include "io/file/CsvRows.h"
#include "support/IoFiles.h"

namespace polemcl::test_csv_rows {

using namespace polemcl::io;
using namespace polemcl::io::test;

namespace {

class CsvRowsTest : public FolderTest {
 protected:
  std::string refusal(const std::string& content) const {
    const fs::path file = write("a.csv", content);
    return messageOf([&] {
      CsvRows rows(file, 3, "time, x, y");
      for (std::vector<double> row; rows.next(row);) {
      }
    });
  }
};

}  // namespace

TEST_F(CsvRowsTest, ReadsRowAfterRow) {
  CsvRows rows(write("a.csv", "# t,x,y\n1326652795280148,-2.5, 3e2\r\n\n4,NaN,nan\n5,6,7"), 3, "");
  std::vector<double> row;
  ASSERT_TRUE(rows.next(row));
  EXPECT_EQ(row, (std::vector<double>{1326652795280148, -2.5, 300}));
  EXPECT_HAS(rows.at(), "a.csv:2: ");
  ASSERT_TRUE(rows.next(row));
  EXPECT_TRUE(row[0] == 4 && std::isnan(row[1]) && std::isnan(row[2]));
  ASSERT_TRUE(rows.next(row));
  EXPECT_EQ(row, (std::vector<double>{5, 6, 7}));
  EXPECT_FALSE(rows.next(row));
}

TEST_F(CsvRowsTest, RefusesRowsThatAreShortOrNoNumbers) {
  expectIn(refusal("1,2,3\n1,2\n"), "a.csv:2: ", "2 numbers, 3 expected", "time, x, y");
  expectIn(refusal("1,2,3,4\n"), "a.csv:1: ", "4 numbers, 3 expected");
  expectIn(refusal("1,2,\n"), "a.csv:1: ", "'' is not a number");
  expectIn(refusal("time,x,y\n"), "a.csv:1: ", "'time' is not a number");
}

TEST_F(CsvRowsTest, TellsHowFarItIs) {
  std::string text;
  for (int i = 0; i < 300000; ++i) text += "1,2,3.5\n";  // 2.4 MB
  std::vector<std::size_t> done;
  CsvRows rows(write("a.csv", text), 3, "", [&](std::size_t now, std::size_t total) {
    EXPECT_EQ(total, 2u);
    done.push_back(now);
  });
  for (std::vector<double> row; rows.next(row);) {
  }
  ASSERT_EQ(done.size(), 30u);
  EXPECT_EQ(done.front(), 0u);
  EXPECT_EQ(done[14], 1u);  // 150,000 rows are 1.2 MB
  EXPECT_EQ(done.back(), 2u);
}

TEST_F(CsvRowsTest, RefusesFilesThatCannotBeRead) {
  EXPECT_REFUSED(CsvRows(path("no.csv"), 3, ""), "no.csv", "No such file");
  EXPECT_REFUSED(CsvRows(m_folder, 3, ""), "it is a folder");
}

}  // namespace polemcl::test_csv_rows
