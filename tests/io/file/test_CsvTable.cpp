#include "io/file/CsvTable.h"
#include "support/IoFiles.h"

namespace polemcl::test_csv_table {

using namespace polemcl::io;
using namespace polemcl::io::test;

class CsvTableTest : public FolderTest {
 protected:
  /// The error message for reading column `name` of the first row as a number.
  std::string refusal(const std::string& content, const std::string& name = "x") const {
    const fs::path file = write("t.csv", content);
    return messageOf([&] {
      const CsvTable table(file);
      table.number(0, table.column(name));
    });
  }
};

TEST_F(CsvTableTest, ReadsColumnsByName) {
  const CsvTable table(write("t.csv",
                             "# made by hand\r\n\"y\" , name,x\n\n2,\"a, \"\"b\"\"\",1e1\n"
                             "# more\n-3, c ,4.5\n"));
  ASSERT_EQ(table.rows(), 2u);
  const auto x = table.column("x"), y = table.column("y");
  EXPECT_EQ(table.number(0, x), 10);
  EXPECT_EQ(table.number(0, y), 2);
  EXPECT_EQ(table.number(1, x), 4.5);
  EXPECT_EQ(table.number(1, y), -3);
  EXPECT_EQ(table.at(1), path("t.csv").string() + ":6: ");
}

TEST_F(CsvTableTest, FieldsBetweenTabsMayBeEmptyAtTheEndsOfALine) {
  const CsvTable table(write("t.csv", "name\tx\tnote\na\t1\t\n\t\t\n\t2\tb \n"), '\t');
  ASSERT_EQ(table.rows(), 2u);
  EXPECT_EQ(table.text(0, 2), "");
  EXPECT_EQ(table.text(1, 0), "");
  EXPECT_EQ(table.number(1, 1), 2);
  EXPECT_EQ(table.text(1, 2), "b");
}

TEST_F(CsvTableTest, AHeaderAloneIsATableWithoutRows) {
  EXPECT_EQ(CsvTable(write("t.csv", "x,y\n")).rows(), 0u);
}

TEST_F(CsvTableTest, KeepsNoBlankLinesAndNotMoreFieldsThanItsSizeAllows) {
  writeGzip(path("blank.csv.gz"), "x,y\n" + std::string(14 << 20, '\n') + "1,2\n");
  EXPECT_EQ(CsvTable(path("blank.csv.gz")).rows(), 1u);
  writeGzip(path("fields.csv.gz"), "x,y\n" + std::string(14 << 20, ','));
  EXPECT_REFUSED(CsvTable(path("fields.csv.gz")),
                 "fields.csv.gz: it holds more than 3 lines and fields");
}

TEST_F(CsvTableTest, RefusesWhatIsNoTable) {
  expectIn(refusal(""), path("t.csv").string(), "empty");
  expectIn(refusal("x,y\n1\n"), ":2: ", "1 fields", "2 expected");
  expectIn(refusal("x,y\n1,\"2\n"), ":2: ", "quote");
  expectIn(refusal("x,y\nq,2\n"), ":2: ", "'q'");
  expectIn(refusal("x,y\ninf,2\n"), ":2: ", "finite");
  expectIn(refusal("a,y\n1,2\n"), ":1: ", "column named x");
  expectIn(refusal("x,x\n1,2\n"), ":1: ", "column named x");
}

}  // namespace polemcl::test_csv_table
