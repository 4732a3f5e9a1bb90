#include "core/text/pattern.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <string>
#include <thread>
#include <vector>

namespace overfly {
namespace {

TEST(Pattern, MatchesTheWholeText) {
  EXPECT_TRUE(matches_pattern("abc", "[a-c]+"));
  EXPECT_FALSE(matches_pattern("abcd", "[a-c]+"));
  EXPECT_TRUE(contains_pattern("abcd", "[a-c]+"));
  EXPECT_FALSE(contains_pattern("d", "[a-c]+"));
}

TEST(Pattern, DistinguishesLetterCaseUnlessAsked) {
  EXPECT_FALSE(matches_pattern("ABC", "[a-c]+"));
  EXPECT_TRUE(matches_pattern("ABC", "[a-c]+", LetterCase::kAny));
  EXPECT_FALSE(matches_pattern("ABC", "[a-c]+"));
}

/// ThreadSanitizer reports a race where threads compile by themselves.
TEST(Pattern, CanBeCompiledByThreads) {
  std::vector<std::thread> threads;
  std::atomic<int> matches = 0;
  for (int i = 0; i < 4; ++i) {
    threads.emplace_back([i, &matches] {
      for (int k = 0; k < 20; ++k) {
        const std::string pattern = std::to_string(k) + "{1," + std::to_string(1 + i % 2) + "}";
        matches += matches_pattern(std::to_string(k), pattern) ? 1 : 0;
      }
    });
  }
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(matches, 4 * 20);
}

}  // namespace
}  // namespace overfly
