#include <gtest/gtest.h>

#include "io/file/Date.h"

namespace polemcl::test_date {

using namespace polemcl::io;

TEST(Date, KnownDays) {
  // From `date -u -d DAY +%s`.
  EXPECT_EQ(secondsOfDate("1970-01-01"), 0);
  EXPECT_EQ(secondsOfDate("2000-02-29"), 951782400);
  EXPECT_EQ(secondsOfDate("2012-03-17"), 1331942400);
  EXPECT_EQ(secondsOfDate("2100-03-01"), 4107542400);
  EXPECT_EQ(dateText(951782400), "2000-02-29");
  EXPECT_EQ(dateText(951782400 + 86399.9), "2000-02-29");
  EXPECT_EQ(dateText(951782400 + 86400), "2000-03-01");
  EXPECT_EQ(dateText(4107542399), "2100-02-28");
  EXPECT_EQ(dateText(1356998399), "2012-12-31");
}

TEST(Date, ThereAndBack) {
  for (double day = 1; day < 60000; day += 17)
    EXPECT_EQ(secondsOfDate(dateText(day * 86400 + 5)), day * 86400);
}

TEST(Date, NotKnownIsEmpty) {
  EXPECT_EQ(dateText(0), "");
}

TEST(Date, RefusesWhatIsNone) {
  for (const char* text :
       {"", "2012", "2012-3-17", "2012-13-01", "2011-02-29", "2012-04-31", "1969-12-31",
        "2012-00-10", "2012-01-00", "2012-03-17T", "20120317", "17.03.2012", "2012--3-17"})
    EXPECT_THROW(secondsOfDate(text), Error) << text;
}

}  // namespace polemcl::test_date
