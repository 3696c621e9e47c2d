#include <gtest/gtest.h>

#include <algorithm>

#include <polemcl/core/common/Types.h>
#include "report/batch/PublishedResults.h"
#include "support/Refusal.h"
#include "support/TempFolder.h"

namespace polemcl::report::test_published_results {
TEST(PublishedResults, DatasetsAreThoseOfTheInstalledTables) {
  EXPECT_EQ(publishedDatasets(),
            (std::vector<std::string>{"nclt", "semantickitti", "kitti-0009", "mulran-kaist"}));
}

TEST(PublishedResults, SessionsOfNclt) {
  const auto published =
      readPublishedSessions(std::string(POLEMCL_SOURCE_DIR) + "/share/published/nclt-table3.csv");
  ASSERT_EQ(published.size(), 54u);
  const auto last = std::find_if(published.begin(), published.end(), [](const auto& one) {
    return one.system == "Dong et al. 2021" && one.session == "2013-02-23";
  });
  ASSERT_NE(last, published.end());
  EXPECT_EQ(last->posRmse, 0.567);
  EXPECT_EQ(last->mapShare, 0);
}

TEST(PublishedResults, RefusesTablesThatAreDamaged) {
  const testing_apps::TempFolder folder;
  const auto refusal = [&](const std::string& text) {
    testing_apps::writeText(folder / "a.csv", text);
    return tests::messageOf([&] { readPublishedSessions(folder / "a.csv"); });
  };
  const std::string head = "system,session,f_map,pos_mean,pos_rmse,ang_mean_deg,ang_rmse_deg\n";
  EXPECT_EQ(refusal(head + "A,s,,1,2,3,4\n"), "no error");
  EXPECT_HAS(refusal("system,session,f_map,pos_mean\nA,s,1,2\n"),
             "a.csv: columns are missing: pos_rmse,ang_mean_deg,ang_rmse_deg; the first line must "
             "name system,session,f_map,");
  EXPECT_NE(refusal(head + "A,s,,x,2,3,4\n").find("a.csv:2: "), std::string::npos);
  EXPECT_HAS(refusal(head + "A,s,,1,2,3,4\nA,s,,1,2,3,4\n"), "a.csv:3: session s of A");
}

}  // namespace polemcl::report::test_published_results
