#include "server/record/run_lock.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <thread>
#include <vector>

#include "tests/support/support.hpp"

namespace overfly::server {
namespace {

TEST(RunLock, OfARenamedFolderLeavesTheLockOfItsSuccessor) {
  const overfly::testing::TemporaryFolder folder;
  const std::filesystem::path place = folder.path() / "night";
  std::filesystem::create_directory(place);
  auto first = std::make_optional(RunLock::take(place).value());
  std::filesystem::rename(place, folder.path() / "aside");
  std::filesystem::create_directory(place);
  const auto second = RunLock::take(place);
  ASSERT_TRUE(second.ok());
  first.reset();
  EXPECT_TRUE(RunLock::held(place));
}

TEST(RunLock, OneAtATime) {
  const overfly::testing::TemporaryFolder folder;
  EXPECT_FALSE(RunLock::held(folder.path()));
  {
    const auto lock = RunLock::take(folder.path());
    ASSERT_TRUE(lock.ok());
    EXPECT_TRUE(RunLock::held(folder.path()));
    EXPECT_EQ(RunLock::take(folder.path()).error().code, ErrorCode::kConflict);
  }
  EXPECT_FALSE(RunLock::held(folder.path()));
  EXPECT_TRUE(RunLock::take(folder.path()).ok());
}

/// A folder that came from elsewhere may have a link in place of the file.
TEST(RunLock, FollowsNoLink) {
  const overfly::testing::TemporaryFolder folder;
  const auto elsewhere = folder.path() / "elsewhere";
  std::filesystem::create_directory(folder.path() / "run");
  std::filesystem::create_symlink(elsewhere, RunLock::file_of(folder.path() / "run"));
  EXPECT_FALSE(RunLock::held(folder.path() / "run"));
  EXPECT_EQ(RunLock::take(folder.path() / "run").error().code, ErrorCode::kIo);
  EXPECT_FALSE(std::filesystem::exists(elsewhere));
}

/// Those who only ask must not keep others from working.
TEST(RunLock, IsTakenWhileOthersAskForIt) {
  const overfly::testing::TemporaryFolder folder;
  std::atomic<bool> over = false;
  std::vector<std::thread> askers;
  for (int i = 0; i < 3; ++i) {
    askers.emplace_back([&] {
      while (!over) {
        (void)RunLock::held(folder.path());
        std::this_thread::sleep_for(std::chrono::microseconds(200));
      }
    });
  }
  for (int i = 0; i < 200; ++i) EXPECT_TRUE(RunLock::take(folder.path()).ok()) << i;
  over = true;
  for (std::thread& asker : askers) asker.join();
}

/// The holder removes the file when it lets go: who waited for it must not hold the removed file.
TEST(RunLock, NeverHasTwoHolders) {
  const overfly::testing::TemporaryFolder folder;
  std::atomic<int> holders = 0;
  std::atomic<int> taken = 0;
  std::atomic<bool> doubled = false;
  std::vector<std::thread> workers;
  for (int i = 0; i < 16; ++i) {
    workers.emplace_back([&] {
      for (int round = 0; round < 300; ++round) {
        const auto lock = RunLock::take(folder.path());
        if (!lock) continue;
        if (++holders > 1) doubled = true;
        ++taken;
        for (int i = 0; i < 3; ++i) std::this_thread::yield();
        --holders;
      }
    });
  }
  for (std::thread& worker : workers) worker.join();
  EXPECT_FALSE(doubled);
  EXPECT_GT(taken, 100);
}

}  // namespace
}  // namespace overfly::server
