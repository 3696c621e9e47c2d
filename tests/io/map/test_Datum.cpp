#include "io/map/Datum.h"
#include "support/IoFiles.h"

namespace polemcl::test_datum {

using namespace polemcl::io;

TEST(Datum, ReadsAndWritesTheSameNumbers) {
  const Datum datum = parseDatum("42.293227, -83.709657,-0.1", "x: ");
  EXPECT_EQ(datum.latitude, 42.293227);
  EXPECT_EQ(datum.longitude, -83.709657);
  EXPECT_EQ(datum.yawDeg, -0.1);
  EXPECT_EQ(datumText(datum), "42.293227,-83.709657,-0.1");
  EXPECT_EQ(parseDatum("1,2", "").yawDeg, 0);
  const Datum odd{1.0 / 3, -2.0 / 3, 1e-7};
  EXPECT_TRUE(parseDatum(datumText(odd), "") == odd);
}

TEST(Datum, RefusesWhatIsNone) {
  for (const char* text :
       {"", "1", "1,2,3,4", "91,0", "0,181", "0,0,361", "a,b", "1;2", "nan,0", "1,2,", "1,,2"})
    EXPECT_THROW(parseDatum(text, "--datum: "), Error) << text;
}

TEST(Datum, AMapHasOneDatum) {
  std::map<std::string, std::string> info;
  EXPECT_FALSE(datumOf(info, ""));
  setDatum(info, {50, 8, 0}, "m.polemap: ");
  EXPECT_EQ(info.at("datum"), "50,8,0");
  setDatum(info, {50, 8, 0}, "m.polemap: ");  // the same
  EXPECT_REFUSED(setDatum(info, {50, 8, 1}, "m.polemap: "),
                 "m.polemap: its datum is 50,8,0, not 50,8,1");
  EXPECT_EQ(info.at("datum"), "50,8,0");
}

}  // namespace polemcl::test_datum
