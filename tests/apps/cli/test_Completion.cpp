// The completion in bash, which asks the programs.

#include <gtest/gtest.h>

#include <string>

#include "support/Shell.h"

namespace polemcl::test_completion {
namespace {

using namespace testing_apps;

const fs::path bin = POLEMCL_BIN_DIR;

/// What bash offers for the last of these words, in a folder with some files.
std::string offered(const std::string& words) {
  static const TempFolder folder;
  for (const std::string name : {"drive.rawlog", "my own.ini", "out/a.rawlog"})
    writeText(folder / name, "");
  const std::string script = POLEMCL_SOURCE_DIR "/share/completion/polemcl.bash";
  writeText(folder / "try.sh", "PATH=" + bin.string() + ":$PATH\nsource " + script +
                                   "\nrm try.sh\nCOMP_WORDS=(" + words +
                                   ")\nCOMP_CWORD=$((${#COMP_WORDS[@]} - 1))\n"
                                   "complete -p \"${COMP_WORDS[0]##*/}\" >/dev/null || exit 1\n"
                                   "_polemcl\nIFS=,\necho -n \"${COMPREPLY[*]}\"\n");
  const Outcome outcome = shell("cd " + folder.path().string() + " && bash try.sh");
  EXPECT_EQ(outcome.code, 0) << words;
  return outcome.out;
}

TEST(Completion, OfSubcommandsAndOptions) {
  EXPECT_EQ(offered("pole-map b"), "build");
  EXPECT_EQ(offered("pole-map --quiet u"), "update");
  EXPECT_EQ(offered("pole-map build --in"), "--input,--inventory");
  EXPECT_EQ(offered("pole-map build --verb"), "--verbose");
  EXPECT_EQ(offered("pole-map update --png"), "");
  EXPECT_EQ(offered("pole-batch --dr"), "--dry-run");
  EXPECT_EQ(offered((bin / "pole-localize").string() + " --glo"), "--global");
}

TEST(Completion, OfWordsThatAnOptionAllows) {
  EXPECT_EQ(offered("pole-eval faults --fault ''"),
            "none,kidnap,wrong-map,blind,stuck,slip,jump,clock,moved,half-gone,snow,late");
  EXPECT_EQ(offered("pole-eval faults --fault s"), "stuck,slip,snow");
  EXPECT_EQ(offered("pole-eval trajectory --per = m"), "metre");
  EXPECT_EQ(offered("pole-eval trajectory --per ="), "pose,metre");
  EXPECT_EQ(offered("pole-simulate --sensor v"), "vlp16");
}

TEST(Completion, OfFilesFoldersAndSettings) {
  EXPECT_EQ(offered("pole-map build --input dr"), "drive.rawlog");
  EXPECT_EQ(offered("pole-map build --input drive.rawlog dr"), "drive.rawlog");
  EXPECT_EQ(offered("pole-map diff dr"), "drive.rawlog");
  EXPECT_EQ(offered("pole-localize --output ''"), "out");
  EXPECT_EQ(offered("pole-map build --config my"), "my own.ini");
  EXPECT_EQ(offered("pole-map build --config hdl"), "hdl32e.ini");
  EXPECT_EQ(offered("pole-batch batches/ye"), "batches/year.ini");
  EXPECT_EQ(offered("pole-eval map --radius ''"), "");
}

}  // namespace
}  // namespace polemcl::test_completion
