// The main function of every test program: GoogleTest's, with one more option.
//
// `--skip-code=N`: exit with N, not 0, when a test was skipped and none failed. ctest runs a suite
// in one process, and shows it as "Skipped" then, so that a skipped test is seen.

#include <gtest/gtest.h>

#include <cstdlib>
#include <cstring>

int main(int argc, char** argv) {
  testing::InitGoogleTest(&argc, argv);
  int skipCode = 0;
  for (int i = 1; i < argc; ++i)
    if (std::strncmp(argv[i], "--skip-code=", 12) == 0) skipCode = std::atoi(argv[i] + 12);
  const int failed = RUN_ALL_TESTS();
  if (failed != 0) return failed;
  return testing::UnitTest::GetInstance()->skipped_test_count() > 0 ? skipCode : 0;
}
