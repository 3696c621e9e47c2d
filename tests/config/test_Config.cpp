#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <filesystem>
#include <random>

#include "config/Config.h"
#include "core/common/Binder.h"
#include "io/file/AtomicFile.h"
#include "support/ExpectHas.h"
#include "support/Refusal.h"

namespace polemcl::test_config {
namespace {

using tests::messageOf;

enum class Colour { red, green };

struct Sample {
  double length = 1.5;
  int count = 3;
  std::uint32_t seed = 7;
  double angle = 0.5;
  bool on = false;
  Colour colour = Colour::red;
  std::string word = "kasa";
  std::string path = "map file.polemap";
  std::vector<double> list = {0.1, -2};
  double x = 1, y = 2, z = 3;
  std::vector<double> beams = {0.1, -0.2};
};

void bind(Binder& b, Sample& s) {
  b.section("sample", "A sample");
  b.number("length_m", s.length, Range::above(0), "m", "how long");
  b.integer("count", s.count, Range::between(1, 10), "", "how many");
  b.integer("seed", s.seed, Range::any(), "", "of the generator");
  b.angleDeg("angle_deg", s.angle, Range::between(-180, 180), "how far turned");
  b.flag("on", s.on, "whether");
  b.choice<Colour>("colour", s.colour, {{Colour::red, "red"}, {Colour::green, "green"}}, "which");
  b.choice("word", s.word, {"kasa", "taubin"}, "which");
  b.text("path", s.path, "where");
  b.numbers("list", s.list, Range::any(), "m", "some");
  b.numbers("origin", {&s.x, &s.y, &s.z}, Range::any(), "m", "three");
  b.anglesDeg("beams_deg", s.beams, Range::between(-90, 90), "some");
  b.require(s.length <= 100, "length_m", s.length, "at most 100 here");
}

Sample load(const std::string& text) {
  ConfigReader reader(ConfigFile::fromText(text, "test.ini"));
  Sample sample;
  bind(reader, sample);
  reader.finish();
  return sample;
}

std::string refusal(const std::string& text) {
  return messageOf([&] { load(text); });
}

TEST(Config, ReadsEveryType) {
  const Sample s = load(
      "# a comment\n"
      "[Sample]   // names ignore case\n"
      "LENGTH_M = 2.5e1   # m\n"
      "count=10 ; most\n"
      "  seed = 4294967295\n"
      "angle_deg = -90 // left\n"
      "on = true\n"
      "colour = green\n"
      "word = taubin\n"
      "path = /a b/c#d.polemap\n"
      "list = 1 \t 2 3\n"
      "origin = 0 -0.5 +0.957\n"
      "beams_deg = 90 -45\n");
  EXPECT_EQ(s.length, 25);
  EXPECT_EQ(s.count, 10);
  EXPECT_EQ(s.seed, 4294967295u);
  EXPECT_DOUBLE_EQ(s.angle, -M_PI / 2);
  EXPECT_TRUE(s.on);
  EXPECT_EQ(s.colour, Colour::green);
  EXPECT_EQ(s.word, "taubin");
  EXPECT_EQ(s.path, "/a b/c#d.polemap");
  EXPECT_EQ(s.list, (std::vector<double>{1, 2, 3}));
  EXPECT_EQ(s.x, 0);
  EXPECT_EQ(s.y, -0.5);
  EXPECT_EQ(s.z, 0.957);
  ASSERT_EQ(s.beams.size(), 2u);
  EXPECT_DOUBLE_EQ(s.beams[0], M_PI / 2);
  EXPECT_DOUBLE_EQ(s.beams[1], -M_PI / 4);
}

Sample loadWith(const std::string& text, const std::vector<std::string>& assignments) {
  ConfigFile file = ConfigFile::fromText(text, "test.ini");
  for (const auto& assignment : assignments) file.set(assignment);
  ConfigReader reader(file);
  Sample sample;
  bind(reader, sample);
  reader.finish();
  return sample;
}

TEST(Config, AssignmentsReplaceAndAddValues) {
  const Sample s = loadWith("[sample]\ncount = 4\nlength_m = 3\n",
                            {"sample.count=5", "Sample.path = a=b.c ", "sample.count=6"});
  EXPECT_EQ(s.count, 6);
  EXPECT_EQ(s.path, "a=b.c");
  EXPECT_EQ(s.length, 3);
  EXPECT_EQ(loadWith("", {"sample.count=5"}).count, 5);
}

TEST(Config, AssignmentsAreAsStrictAsFiles) {
  for (const char* wrong : {"count=5", "sample.count", ".count=5", "sample.=5", "=", "a=b.c"})
    EXPECT_HAS(messageOf([&] { loadWith("", {wrong}); }), "write section.key=value");
  EXPECT_HAS(messageOf([&] { loadWith("", {"sample.cuont=5"}); }), "key is not known");
  EXPECT_HAS(messageOf([&] { loadWith("", {"simple.count=5"}); }), "section [simple] is not known");
  EXPECT_HAS(messageOf([&] { loadWith("", {"sample.count=many"}); }),
             "test.ini, changed with --set: [sample] count = many");
}

TEST(Config, KeepsDefaultsOfMissingKeys) {
  const Sample s = load("[sample]\ncount = 4\nlist =\n");
  EXPECT_EQ(s.count, 4);
  EXPECT_TRUE(s.list.empty());
  EXPECT_EQ(s.length, Sample().length);
  EXPECT_EQ(s.angle, Sample().angle);
  EXPECT_EQ(load("").path, Sample().path);
}

TEST(Config, UnderstandsVariables) {
  EXPECT_EQ(load("@define N 4\n[sample]\ncount = ${N}\n").count, 4);
  EXPECT_HAS(refusal("[sample]\ncount = ${N}\n"), "test.ini");
}

TEST(Config, RefusesWrongTypes) {
  for (const char* bad : {"3x", "1,5", "", "nan", "inf", "1 2", "0x10", "++1", "+-1", "1e999"})
    EXPECT_HAS(refusal(std::string("[sample]\nlength_m = ") + bad + "\n"),
               "test.ini: [sample] length_m = " + std::string(bad) + ": allowed is a number > 0 m");
  EXPECT_HAS(refusal("[sample]\ncount = 1.5\n"), "allowed is a whole number 1 to 10");
  EXPECT_HAS(refusal("[sample]\nangle_deg = north\n"), "allowed is a number -180 to 180 deg");
  EXPECT_HAS(refusal("[sample]\non = yes\n"), "allowed is true or false");
  EXPECT_HAS(refusal("[sample]\ncolour = blue\n"), "colour = blue: allowed is one of red | green");
  EXPECT_HAS(refusal("[sample]\nword = Kasa\n"), "allowed is one of kasa | taubin");
  EXPECT_HAS(refusal("[sample]\nlist = 1, 2\n"), "list = 1, 2");
  EXPECT_HAS(refusal("[sample]\norigin = 1 2\n"), "allowed is 3 numbers between blanks");
  EXPECT_HAS(refusal("[sample]\norigin = 1 2 3 4\n"), "allowed is 3 numbers between blanks");
  EXPECT_HAS(refusal("[sample]\nbeams_deg = 1 2x\n"), "beams_deg = 1 2x");
}

TEST(Config, RefusesValuesOutOfRange) {
  EXPECT_HAS(refusal("[sample]\nlength_m = 0\n"), "length_m = 0");
  EXPECT_HAS(refusal("[sample]\ncount = 0\n"), "count = 0");
  EXPECT_HAS(refusal("[sample]\ncount = 11\n"), "count = 11");
  EXPECT_HAS(refusal("[sample]\nseed = -1\n"), "seed = -1");
  EXPECT_HAS(refusal("[sample]\nseed = 4294967296\n"), "seed = 4294967296");
  EXPECT_HAS(refusal("[sample]\nangle_deg = 180.1\n"), "angle_deg = 180.1");
  EXPECT_HAS(refusal("[sample]\nbeams_deg = 1 91\n"), "beams_deg = 1 91");
}

TEST(Config, HoldsRulesBetweenFields) {
  EXPECT_EQ(refusal("[sample]\nlength_m = 101\n"),
            "test.ini: [sample] length_m = 101: allowed is at most 100 here");
}

TEST(Config, RefusesUnknownNames) {
  const std::string key = refusal("[sample]\nlenght_m = 3 # m\n");
  EXPECT_HAS(key, "test.ini: [sample] lenght_m = 3: key is not known; known are: angle_deg");
  EXPECT_HAS(key, "; is length_m meant?");
  const std::string section = refusal("[sample]\n[smaple]\ncount = 3\n");
  EXPECT_HAS(section,
             "test.ini: section [smaple] is not known; known are: sample; is sample meant?");
  EXPECT_EQ(refusal("[sample]\nwheels = 3\n").find("meant?"), std::string::npos);
}

TEST(Config, PassesOverTheSectionsThatAreNamed) {
  const std::set<std::string> others{"world", "simulation"};
  const auto load = [&](const std::string& text) {
    const ConfigFile file = ConfigFile::fromText(text, "test.ini");
    ConfigReader reader(file);
    Sample sample;
    bind(reader, sample);
    reader.finish(others);
    return sample.count;
  };
  EXPECT_EQ(load("[sample]\ncount = 3\n[World]\nseed = 1\n"), 3);
  const auto refused = [&](const std::string& text) { return messageOf([&] { load(text); }); };
  EXPECT_HAS(refused("[simulaton]\nspacing_m = 1\n"),
             "test.ini: section [simulaton] is not known; known are: sample; is simulation meant?");
  EXPECT_HAS(refused("[sample]\nseeds = 1\n"), "key is not known");
  EXPECT_HAS(refused("[map:left]\nmodel = vlp16\n"), "section [map:left] is not known");
}

// Files of version 1 hold all its settings, many of which are constants now.
TEST(Config, SettingsOfVersionOneMayStateTheValueThatIsFixedNow) {
  EXPECT_NO_THROW(load("[health]\nwindow_m = 8.0\n"));
  EXPECT_NO_THROW(load("[range_image]\ncircle_fit = kasa\nwrap_around = True\n"));
  EXPECT_EQ(refusal("[health]\nwindow_m = 9 # m\n"),
            "test.ini: [health] window_m = 9: is no setting since version 2; it is always 8. "
            "Remove the line");
  EXPECT_HAS(refusal("[health]\nwindow = 8\n"), "section [health] is not known");
}

TEST(Config, RefusesWhatIsGivenTwice) {
  const std::string key = refusal("[sample]\ncount = 3\n\nCount = 3\n");
  EXPECT_HAS(key, "test.ini:4: key 'Count' of [sample] is given twice, first in line 2");
  const std::string section = refusal("[sample]\n[other]\n[Sample]\n");
  EXPECT_HAS(section, "test.ini:3: section [Sample] is given twice, first in line 1");
}

TEST(Config, RefusesLinesThatAreNothing) {
  EXPECT_HAS(refusal("[sample]\ncount 3\n"), "test.ini:2: 'count 3' is neither");
  EXPECT_HAS(refusal("[sample]\n= 3\n"), "test.ini:2: '= 3' is neither");
  EXPECT_HAS(refusal("[sample\n"), "test.ini:1: '[sample' is not a section");
  EXPECT_HAS(refusal("[]\n"), "test.ini:1: '[]' is not a section");
  EXPECT_HAS(refusal("count = 3\n[sample]\n"), "test.ini:1: key 'count' stands before");
}

TEST(Config, RefusesAMissingFile) {
  EXPECT_HAS(messageOf([] { ConfigFile::read("/nowhere/c.ini"); }), "/nowhere/c.ini");
}

TEST(Config, ReadsOneSectionOfAnothersSource) {
  const ConfigFile file = ConfigFile::fromText(
      "[Map_00_opts]\ncount = 5 // five\ncommon = 1\n[whatever]\nkey = 1\n", "map.ini");
  ConfigReader reader(file.source(), file.name(), "Map_00_opts");
  Sample sample;
  bind(reader, sample);
  EXPECT_EQ(sample.count, 5);
  EXPECT_HAS(messageOf([&] { reader.finish(); }), "map.ini: [Map_00_opts] common = 1: key is not");
  reader.knownElsewhere({"common"});
  EXPECT_NO_THROW(reader.finish());
}

std::string written(Sample sample) {
  ConfigWriter writer;
  bind(writer, sample);
  return writer.text();
}

TEST(Config, WritesWhatItReads) {
  Sample s;
  s.length = 0.1;
  s.count = 9;
  s.seed = 4294967295u;
  s.angle = -2.0 / 3;
  s.on = true;
  s.colour = Colour::green;
  s.word = "taubin";
  s.path = "";
  s.list = {1.0 / 3, 1e-300, -12345678.9};
  s.x = 1e22;
  s.y = -0.1;
  s.z = 5e-324;
  s.beams = {M_PI / 2, 0, 1e-9};
  const Sample r = load(written(s));
  EXPECT_EQ(r.length, s.length);
  EXPECT_EQ(r.count, s.count);
  EXPECT_EQ(r.seed, s.seed);
  EXPECT_EQ(r.angle, s.angle);
  EXPECT_EQ(r.on, s.on);
  EXPECT_EQ(r.colour, s.colour);
  EXPECT_EQ(r.word, s.word);
  EXPECT_EQ(r.path, s.path);
  EXPECT_EQ(r.list, s.list);
  EXPECT_EQ(r.x, s.x);
  EXPECT_EQ(r.y, s.y);
  EXPECT_EQ(r.z, s.z);
  EXPECT_EQ(r.beams, s.beams);
  EXPECT_EQ(written(r), written(s));
}

TEST(Config, AnglesSurviveBitForBit) {
  std::mt19937_64 generator(1);
  for (int i = 0; i < 2000; ++i) {
    Sample s;
    s.angle = (static_cast<double>(generator() >> 11) / 9007199254740992.0 - 0.5) * 2 * M_PI;
    ASSERT_EQ(load(written(s)).angle, s.angle);
  }
}

TEST(Config, DegreesAreWrittenAsTheyWereGiven) {
  for (const char* degrees : {"2", "-24.9", "30.67", "-10.67", "0.08"})
    EXPECT_HAS(written(load(std::string("[sample]\nangle_deg = ") + degrees + "\n")),
               "angle_deg = " + std::string(degrees) + " ");
}

TEST(Config, WritesUnitAndRangeOfEveryKey) {
  const std::string text = written(Sample());
  EXPECT_HAS(text, "# A sample\n[sample]\n");
  EXPECT_HAS(text, "length_m = 1.5");
  EXPECT_HAS(text, "// how long [m; > 0]");
  EXPECT_HAS(text, "// how far turned [deg; -180 to 180]");
  EXPECT_HAS(text, "// which [red | green]");
}

TEST(Config, OpensASectionAgain) {
  ConfigWriter writer;
  double a = 1, b = 2, c = 3;
  writer.section("one", "first");
  writer.number("a", a, Range::any(), "", "a");
  writer.section("two", "second");
  writer.number("b", b, Range::any(), "", "b");
  writer.section("one", "first");
  writer.number("c", c, Range::any(), "", "c");
  const std::string text = writer.text();
  EXPECT_LT(text.find("c = 3"), text.find("[two]"));
  EXPECT_NO_THROW(ConfigFile::fromText(text, "again"));
}

TEST(Config, RefusesToWriteWhatWouldReadDifferently) {
  for (const char* bad : {"a # b", "a\nb", " a", "a ", "x // y", "$env{HOME}", "a\\"}) {
    Sample s;
    s.path = bad;
    EXPECT_HAS(messageOf([&] { written(s); }), "cannot be written") << bad;
  }
}

TEST(Config, RefusesToWriteWhatIsOutOfRange) {
  Sample word, number;
  word.word = "other";
  EXPECT_REFUSED(written(word), "word = other: allowed is one of kasa | taubin");
  number.count = 11;
  EXPECT_REFUSED(written(number), "[sample] count = 11: allowed is a whole number 1 to 10");
}

TEST(Config, WritesTheTiersAskedFor) {
  const auto text = [](Tier most) {
    double a = 1, b = 2, c = 3, d = 4;
    ConfigWriter writer(most);
    writer.section("one", "first", Tier::sensor);
    writer.number("a", a, Range::any(), "", "a");
    writer.tier(Tier::tuning);
    writer.number("b", b, Range::any(), "", "b");
    writer.section("two", "second", Tier::expert);
    writer.number("c", c, Range::any(), "", "c");
    writer.section("one", "first");  // the tier begins anew
    writer.number("d", d, Range::any(), "", "d");
    std::string keys;
    for (const char* key : {"a = 1", "b = 2", "c = 3", "d = 4", "[two]"})
      if (writer.text().find(key) != std::string::npos) keys += key[0];
    return keys;
  };
  EXPECT_EQ(text(Tier::sensor), "a");
  EXPECT_EQ(text(Tier::tuning), "abd");
  EXPECT_EQ(text(Tier::expert), "abcd[");
}

TEST(Config, ChecksStructsWithoutAFile) {
  const auto refusal = [](const std::function<void(Sample&)>& change) {
    Sample sample;
    change(sample);
    return messageOf([&] { checkOptions(sample); });
  };
  EXPECT_EQ(refusal([](Sample&) {}), "no error");
  EXPECT_HAS(refusal([](auto& s) { s.angle = 200 * M_PI / 180; }),
             "deg = 200: allowed is a number -180 to 180 deg");
  EXPECT_HAS(refusal([](auto& s) { s.angle = NAN; }), "[sample] angle_deg = nan");
  EXPECT_HAS(refusal([](auto& s) { s.beams = {0, 2}; }), "[sample] beams_deg = 0 114.59");
  EXPECT_HAS(refusal([](auto& s) { s.list = {1, INFINITY}; }), "[sample] list = 1 inf");
  EXPECT_HAS(refusal([](auto& s) { s.y = NAN; }), "[sample] origin = 1 nan 3");
  EXPECT_HAS(refusal([](auto& s) { s.word = "pratt"; }), "[sample] word = pratt");
  EXPECT_HAS(refusal([](auto& s) { s.length = 101; }),
             "[sample] length_m = 101: allowed is at most 100");
}

// The way from degrees to radians and back must not refuse a limit itself.
TEST(Config, AllowsAnglesAtTheirLimits) {
  for (const double limit : {0.001, 57.0, 85.0, 89.0, 90.0, 180.0, 360.0}) {
    double angle = 0;
    const auto bindLimit = [&](Binder& b) {
      b.section("a", "a");
      b.angleDeg("limit_deg", angle, Range::between(-limit, limit), "a");
    };
    char text[64];
    std::snprintf(text, sizeof text, "[a]\nlimit_deg = %.17g\n", limit);
    ConfigReader reader(ConfigFile::fromText(text, "t.ini"));
    bindLimit(reader);
    CheckingBinder checker;
    EXPECT_NO_THROW(bindLimit(checker)) << limit;
    angle *= -1;
    EXPECT_NO_THROW(bindLimit(checker)) << limit;
    angle *= 1.001;
    EXPECT_THROW(bindLimit(checker), Error) << limit;
  }
}

TEST(Config, SavesAFile) {
  const auto path = std::filesystem::temp_directory_path() / "polemcl_test_Config.ini";
  ConfigWriter writer;
  Sample s;
  s.count = 8;
  bind(writer, s);
  writer.save(path);
  ConfigReader reader(ConfigFile::read(path));
  Sample r;
  bind(reader, r);
  reader.finish();
  EXPECT_EQ(r.count, 8);
  std::filesystem::remove(path);
}

/// MRPT would run them: a loop without end, or what the environment holds in a report.
TEST(Config, RefusesProgramsAndTheEnvironment) {
  for (const char* value : {"$eval{ var x:=0; repeat x+=1; until(x<0) }", "$env{HOME}",
                            "a$$env{HOME}", "$e\\\nnv{HOME}", "$\\\nenv{HOME}"}) {
    const std::string text = std::string("[sample]\ncount = ") + value + "\n";
    EXPECT_REFUSED(ConfigFile::fromText(text, "t.ini"), "t.ini:2: $",
                   "neither $eval{} nor $env{} is allowed");
  }
  // MRPT expands once more what its first pass, which ends at a zero byte, did not see.
  const std::string zero = std::string("[scan_timing]\nturn") + '\0' + "a = 1" + '\0' + "t$eval{x";
  EXPECT_REFUSED(ConfigFile::fromText(zero, "t.ini"), "t.ini:2: $e");
  EXPECT_NO_THROW(ConfigFile::fromText("[a]\ntitle = 5 $ or $10\n", "t.ini"));
}

TEST(Config, RefusesDefinesThatGrow) {
  EXPECT_REFUSED(ConfigFile::fromText("@define A 1\n@define B ${A}${A}\n[a]\nb = ${B}\n", "t.ini"),
                 "t.ini:2: @define may not use another");
  EXPECT_REFUSED(ConfigFile::fromText("@define A @define B 1\n[a]\nb = ${A}\n", "t.ini"),
                 "@define stands for another");
  std::string text = "@define A " + std::string(50000, 'x') + "\n[a]\n";
  for (int i = 0; i < 1000; ++i) text += "b" + std::to_string(i) + " = ${A}\n";
  EXPECT_REFUSED(ConfigFile::fromText(text, "t.ini"), "what @define stands for is too long");
}

TEST(Range, SaysWhatItAllows) {
  EXPECT_EQ(Range::any().text(), "any number");
  EXPECT_EQ(Range::atLeast(0).text(), ">= 0");
  EXPECT_EQ(Range::above(0.5).text(), "> 0.5");
  EXPECT_EQ(Range::between(-1, 1).text(), "-1 to 1");
  EXPECT_EQ(Range::inside(0, 1).text(), "> 0 and < 1");
  EXPECT_FALSE(Range::inside(0, 1).contains(0));
  EXPECT_FALSE(Range::inside(0, 1).contains(1));
  EXPECT_TRUE(Range::between(0, 1).contains(1));
  EXPECT_FALSE(Range::any().contains(NAN));
  EXPECT_FALSE(Range::any().contains(INFINITY));
}

}  // namespace
}  // namespace polemcl::test_config
