#include <gtest/gtest.h>

#include "config/Config.h"
#include "report/scene/ViewOptions.h"

namespace polemcl::report::test_view_options {

TEST(ViewOptions, RatesAreTimesOrMax) {
  EXPECT_EQ(parseRate("1x"), 1.0);
  EXPECT_EQ(parseRate("2.5x"), 2.5);
  EXPECT_EQ(parseRate("0.5"), 0.5);
  EXPECT_EQ(parseRate("max"), std::nullopt);
}

TEST(ViewOptions, RefusesOtherRates) {
  for (const char* wrong :
       {"", "x", "0x", "-1x", "fast", "1xx", "1 x", "nan", "inf", "maxx", "1e-300"})
    EXPECT_THROW(parseRate(wrong), Error) << wrong;
}

TEST(ViewOptions, RefusesWhatIsOutOfRange) {
  const auto refused = [](void (*spoil)(ViewOptions&)) {
    ViewOptions options;
    options.validate();
    spoil(options);
    EXPECT_THROW(options.validate(), Error);
  };
  refused([](ViewOptions& o) { o.rate = "soon"; });
  refused([](ViewOptions& o) { o.scenes = -1; });
}

TEST(ViewOptions, AreReadAndWritten) {
  ViewOptions options;
  options.live = true, options.rate = "3x", options.scenes = 7, options.frames = "pictures";
  options.hold = true;
  ConfigWriter writer;
  bind(writer, options);
  ViewOptions read;
  ConfigReader reader(ConfigFile::fromText(writer.text(), "a.ini"));
  bind(reader, read);
  reader.finish();
  EXPECT_TRUE(read.live && read.hold);
  EXPECT_EQ(read.rate, "3x");
  EXPECT_EQ(read.scenes, 7);
  EXPECT_EQ(read.frames, "pictures");
  ConfigReader bad(ConfigFile::fromText("[view]\nrate = soon\n", "a.ini"));
  EXPECT_THROW(bind(bad, read), Error);
}

}  // namespace polemcl::report::test_view_options
