#include <cmath>
#include <limits>

#include "io/file/TextFile.h"
#include "support/IoFiles.h"

namespace polemcl::test_text_file {

using namespace polemcl::io;
using namespace polemcl::io::test;

using TextFileTest = FolderTest;

TEST_F(TextFileTest, LinesOfAnyEnd) {
  const auto lines = readLines(write("f",
                                     "\xEF\xBB\xBF"
                                     "a\r\n\n b \nlast"));
  EXPECT_EQ(lines, (std::vector<std::string>{"a", "", " b ", "last"}));
  EXPECT_TRUE(readLines(write("empty", "")).empty());
}

TEST_F(TextFileTest, LinesOfGzip) {
  std::string text;
  for (int i = 0; i < 20000; ++i) text += std::to_string(i) + "\n";
  writeGzip(path("f.gz"), text);
  const auto lines = readLines(path("f.gz"));
  ASSERT_EQ(lines.size(), 20000u);
  EXPECT_EQ(lines[19999], "19999");
}

// Blocks of the reader end inside lines, between the two bytes of a line end, and after it.
TEST_F(TextFileTest, LinesAcrossBlocks) {
  std::vector<std::string> lines;
  for (const std::size_t length : {65535u, 1u, 65533u, 0u, 65536u, 200000u, 7u})
    lines.emplace_back(length, static_cast<char>('a' + lines.size()));
  for (const std::string end : {"\n", "\r\n"}) {
    std::string text;
    for (const auto& line : lines) text += line + end;
    EXPECT_EQ(readLines(write("f", text)), lines);
    text.resize(text.size() - end.size());
    EXPECT_EQ(readLines(write("f", text)), lines);
  }
}

TEST_F(TextFileTest, RefusesGzipCutShort) {
  std::string text;
  for (int i = 0; i < 20000; ++i) text += std::to_string(i * 7919L) + "\n";
  writeGzip(path("f.gz"), text);
  fs::resize_file(path("f.gz"), fs::file_size(path("f.gz")) / 2);
  EXPECT_REFUSED(readLines(path("f.gz")), path("f.gz").string(), "cut short");
}

// 60 MB of one byte take 60 kB: no table shrinks like that.
TEST_F(TextFileTest, RefusesTextThatNoTableHolds) {
  writeGzip(path("bomb.gz"), std::string(60 << 20, 'a'));
  EXPECT_REFUSED(readLines(path("bomb.gz")), path("bomb.gz").string(), "more than 18 MB");
}

// Each line and field that is kept takes memory.
TEST_F(TextFileTest, RefusesMoreLinesThanAFileOfItsSizeCanHold) {
  writeGzip(path("lines.gz"), std::string(14 << 20, '\n'));
  EXPECT_REFUSED(readLines(path("lines.gz")), "lines.gz: it holds more than 47",
                 "lines and fields");
}

// A long table is no bomb: 130 MB of one line.
TEST_F(TextFileTest, PlainTextMayHaveAnyLength) {
  fs::resize_file(write("long", "1\n"), 130 << 20);
  LineReader reader(path("long"));
  std::string line;
  EXPECT_TRUE(reader.next(line) && reader.next(line));
  EXPECT_EQ(line.size(), (std::size_t{130} << 20) - 2);
}

TEST_F(TextFileTest, RefusesDamagedGzip) {
  writeGzip(path("f.gz"), std::string(1000, 'a') + std::string(1000, 'b'));
  std::string bytes = read(path("f.gz"));
  bytes[bytes.size() - 6] ^= 1;  // in the checksum
  write("f.gz", bytes);
  EXPECT_REFUSED(readLines(path("f.gz")), path("f.gz").string());
}

TEST_F(TextFileTest, RefusesMissingFilesAndFolders) {
  EXPECT_REFUSED(readLines(path("no")), path("no").string(), "No such file or directory");
  EXPECT_REFUSED(readLines(m_folder), m_folder.string(), "folder");
  EXPECT_REFUSED(readLines(path(std::string(300, 'x'))), "File name too long");
}

TEST_F(TextFileTest, RowsKeepTheirLineNumbers) {
  const auto rows =
      readNumberRows(write("f", "# head\n1 -2.5\n\n\t+3e2   .5 # tail\r\n"), 2, "a b");
  ASSERT_EQ(rows.size(), 2u);
  EXPECT_EQ(rows[0].line, 2u);
  EXPECT_EQ(rows[0].values, (std::vector<double>{1, -2.5}));
  EXPECT_EQ(rows[1].line, 4u);
  EXPECT_EQ(rows[1].values, (std::vector<double>{300, 0.5}));
}

TEST_F(TextFileTest, RefusesAnotherCountOfColumns) {
  const fs::path file = write("f", "1 2\n1 2 3\n");
  EXPECT_REFUSED(readNumberRows(file, 2, "a b"), file.string() + ":2: ", "3 numbers", "2 expected",
                 "a b");
}

TEST_F(TextFileTest, RefusesWhatIsNoNumber) {
  for (const char* word :
       {"x", "1,5", "0x10", "1.5m", "+-1", "--1", "nan", "inf", "-Infinity", "1e999"}) {
    const fs::path file = write("f", std::string("1\n") + word + "\n");
    EXPECT_REFUSED(readNumberRows(file, 1, "a b"), file.string() + ":2: ", word,
                   "is not a finite number; expected: a b");
  }
}

TEST_F(TextFileTest, RowsWithCommas) {
  const std::string text = "\xEF\xBB\xBF# t,x,y\n1326652795280148,-2.5, 3e2\r\n\n4,NaN,nan\n5,6,7";
  writeGzip(path("a.csv.gz"), text);
  for (const fs::path& file : {write("a.csv", text), path("a.csv.gz")}) {
    NumberRowReader rows(file, 3, "", Separator::commas);
    std::vector<double> row;
    ASSERT_TRUE(rows.next(row));
    EXPECT_EQ(row, (std::vector<double>{1326652795280148, -2.5, 300}));
    EXPECT_EQ(rows.at(), file.string() + ":2: ");
    ASSERT_TRUE(rows.next(row));
    EXPECT_TRUE(row[0] == 4 && std::isnan(row[1]) && std::isnan(row[2]));
    EXPECT_FALSE(allFinite(row));
    ASSERT_TRUE(rows.next(row));
    EXPECT_EQ(row, (std::vector<double>{5, 6, 7}));
    EXPECT_FALSE(rows.next(row));
  }
}

TEST_F(TextFileTest, RefusesRowsWithCommasThatAreShortOrNoNumbers) {
  const auto refusal = [&](const std::string& content) {
    NumberRowReader rows(write("a.csv", content), 3, "time, x, y", Separator::commas);
    return messageOf([&] {
      for (std::vector<double> row; rows.next(row);) {
      }
    });
  };
  expectIn(refusal("1,2,3\n1,2\n"), "a.csv:2: ", "2 numbers, 3 expected", "time, x, y");
  expectIn(refusal("1,2,3,4\n"), "a.csv:1: ", "4 numbers, 3 expected");
  expectIn(refusal("1,2,\n"), "a.csv:1: ", "'' is not a number");
  expectIn(refusal("time,x,y\n"), "a.csv:1: ", "'time' is not a number; expected: time, x, y");
}

TEST_F(TextFileTest, TellsHowMuchOfTheRowsIsRead) {
  std::string text;
  for (int i = 0; i < 300000; ++i) text += "1,2,3.5\n";  // 2.4 MB
  std::vector<std::size_t> done;
  NumberRowReader rows(write("a.csv", text), 3, "", Separator::commas,
                       [&](std::size_t now, std::size_t total) {
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

TEST_F(TextFileTest, ParseNumber) {
  EXPECT_EQ(parseNumber(" 1.5\t"), 1.5);
  EXPECT_EQ(parseNumber("+2"), 2.0);
  EXPECT_EQ(parseNumber("1e-3"), 1e-3);
  EXPECT_TRUE(std::isnan(*parseNumber("nan")));
  EXPECT_EQ(parseNumber("-inf"), -std::numeric_limits<double>::infinity());
  for (const char* text : {"", " ", "+", "1 2", "1.2.3", "e5"})
    EXPECT_FALSE(parseNumber(text)) << text;
}

TEST_F(TextFileTest, Trimmed) {
  EXPECT_EQ(trimmed(" \ta b\r "), "a b");
  EXPECT_EQ(trimmed(" \t\r"), "");
}

TEST_F(TextFileTest, WordsAndLists) {
  const auto words = wordsOf(" a\tbc  d\r");
  EXPECT_EQ(words, (std::vector<std::string>{"a", "bc", "d"}));
  EXPECT_TRUE(wordsOf(" \t").empty());
  EXPECT_EQ(joined(words), "a, bc, d");
  EXPECT_EQ(joined(words, " "), "a bc d");
}

TEST_F(TextFileTest, Formats) {
  EXPECT_EQ(fixed(1.5, 6), "1.500000");
  EXPECT_EQ(fixed(-0.0000004, 6), "-0.000000");
  EXPECT_EQ(fixed(1317042145.964389324, 6), "1317042145.964389");
  EXPECT_EQ(fixed(std::numeric_limits<double>::max(), 9).size(), 309u + 10u);
  EXPECT_EQ(significant(0.01, 9), "0.01");
  EXPECT_EQ(significant(1e-7, 9), "1e-07");
  EXPECT_EQ(significant(2.0 / 3, 4), "0.6667");
}

}  // namespace polemcl::test_text_file
