#include "core/measure/process_memory.hpp"

#include <gtest/gtest.h>

#include <vector>

namespace overfly {
namespace {

TEST(ProcessMemory, GrowsByTheBytesThatAreUsedAndItsPeakIsNotLess) {
#if defined(__SANITIZE_THREAD__)
  GTEST_SKIP() << "the sanitizer uses four bytes of its own for each";
#endif
  const double before_mb = resident_memory_mb();
  ASSERT_GT(before_mb, 1.0);
  const std::vector<char> bytes(64'000'000, 1);
  EXPECT_NEAR(resident_memory_mb() - before_mb, 64.0, 10.0) << bytes.back();
  EXPECT_GT(peak_memory_mb(), before_mb + 50.0);
}

}  // namespace
}  // namespace overfly
