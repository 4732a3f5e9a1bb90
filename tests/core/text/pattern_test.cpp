#include "core/text/pattern.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <string>
#include <thread>
#include <vector>

namespace overfly {
namespace {

TEST(Pattern, IsCompiledOnce) {
  const std::regex& letters = compiled_pattern("[a-c]+");
  EXPECT_TRUE(std::regex_match("abc", letters));
  EXPECT_FALSE(std::regex_match("ABC", letters));
  EXPECT_EQ(&compiled_pattern("[a-c]+"), &letters);
  const std::regex& any_case = compiled_pattern("[a-c]+", std::regex::icase);
  EXPECT_NE(&any_case, &letters);
  EXPECT_TRUE(std::regex_match("ABC", any_case));
}

/// ThreadSanitizer reports a race where threads compile by themselves.
TEST(Pattern, CanBeCompiledByThreads) {
  std::vector<std::thread> threads;
  std::atomic<int> matches = 0;
  for (int i = 0; i < 4; ++i) {
    threads.emplace_back([i, &matches] {
      for (int k = 0; k < 20; ++k) {
        const std::string pattern = std::to_string(k) + "{1," + std::to_string(1 + i % 2) + "}";
        matches += std::regex_match(std::to_string(k), compiled_pattern(pattern)) ? 1 : 0;
      }
    });
  }
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(matches, 4 * 20);
}

}  // namespace
}  // namespace overfly
