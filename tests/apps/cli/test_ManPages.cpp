/// \file test_ManPages.cpp
/// \brief The man pages that the build wrote.

#include <gtest/gtest.h>

#include <string>

#include "cli/CommandLine.h"
#include "cli/ManPage.h"
#include "cli/OptionText.h"
#include "cli/Programs.h"
#include "support/Shell.h"

namespace polemcl::test_man_pages {

using namespace polemcl::apps;
using namespace testing_apps;

namespace {

const fs::path pages = fs::path(POLEMCL_BIN_DIR).parent_path() / "share" / "man" / "man1";

}  // namespace

TEST(ManPages, AreThereForEveryCommand) {
  for (const Program& program : programs())
    visitOptions(program.main, program.name, [&](CLI::App& cli) {
      EXPECT_TRUE(fs::exists(pages / (program.name + std::string(".1")))) << program.name;
      for (const CLI::App* command : subcommandsOf(cli)) {
        const std::string page = manPageName(program.name + (" " + command->get_name())) + ".1";
        EXPECT_TRUE(fs::exists(pages / page)) << page;
      }
    });
}

TEST(ManPages, MandocHasNothingToSay) {
  const Outcome lint = shell("mandoc -Tlint -W warning " + pages.string() + "/*.1");
  EXPECT_EQ(lint.code, 0) << "is mandoc installed?";
  EXPECT_EQ(lint.out, "");
}

TEST(ManPages, SayWhatTheOptionsAre) {
  const Outcome shown = shell("mandoc -Tutf8 -O width=78 " +
                              (pages / "pole-eval-faults.1").string() + " | sed 's/.\\x08//g'");
  for (const std::string text : {"pole-eval-faults - Injects faults into a drive",
                                 "--fault none|kidnap|wrong-map|blind|stuck",
                                 "Time before the fault, s (above 0; default: 20)", "EXAMPLES",
                                 "NO_COLOR", "pole-localize(1)"})
    EXPECT_NE(shown.out.find(text), std::string::npos) << text << " is not in: " << shown.out;
}

TEST(ManPages, EscapeWhatTroffWouldRead) {
  CLI::App app(".Begins 'so' with a \\ and `this` ~ and ^.", "pole-test");
  TempFolder folder;
  writeText(folder / "pole-test.1", manPage(app, "pole-test", "2026-11-23"));
  const Outcome lint = shell("mandoc -Tlint -W warning " + (folder / "pole-test.1").string());
  EXPECT_EQ(lint.out, "");
  const Outcome shown = shell("mandoc -Tascii " + (folder / "pole-test.1").string());
  EXPECT_NE(shown.out.find(".Begins 'so' with a \\ and `this` ~ and ^"), std::string::npos)
      << shown.out;
}

}  // namespace polemcl::test_man_pages
