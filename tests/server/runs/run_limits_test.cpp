// Many clients or several servers on one folder of runs: ids, queue, deletion, idempotency keys.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <set>
#include <thread>

#include "server/record/run_folder.hpp"
#include "server/record/run_id.hpp"
#include "server/record/run_info.hpp"
#include "server/record/run_lock.hpp"
#include "server/runs/idempotency_keys.hpp"
#include "tests/server/support/manager_fixture.hpp"

namespace overfly::server {
namespace {

namespace fs = std::filesystem;
using overfly::testing::TemporaryFolder;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::MatchesRegex;

class RunLimitsTest : public testing::ManagerTest {};

TEST_F(RunLimitsTest, TwoServersOnOneFolderGiveNoIdTwice) {
  const auto one = manager();
  const auto two = manager();
  std::set<std::string> ids;
  std::size_t started = 0;
  for (RunManager* runs : {one.get(), two.get()}) {
    for (int i = 0; i < 20; ++i, ++started) {
      ids.insert(runs->start("small", i == 0 ? endless() : std::vector<Override>()).value().id);
    }
  }
  EXPECT_EQ(ids.size(), started);
  for (const std::string& id : ids) {
    EXPECT_THAT(id, MatchesRegex("[0-9]{8}-[0-9]{6}-small-[a-z2-9]{6}"));
  }
}

TEST_F(RunLimitsTest, FolderThatIsThereIsNeverARunsOwn) {
  const TemporaryFolder folder;
  std::set<std::string> ids;
  for (int i = 0; i < 200; ++i) ids.insert(reserve_run(folder.path(), "s", 0).value());
  EXPECT_EQ(ids.size(), 200U);
  for (const std::string& id : ids) EXPECT_TRUE(fs::is_directory(folder.path() / id)) << id;
  EXPECT_EQ(reserve_run(folder.path() / "none", "s", 0).error().code, ErrorCode::kIo);
}

TEST_F(RunLimitsTest, RunsThatWaitHaveALimit) {
  RunManagerOptions few = options();
  few.max_waiting_runs = 3;
  const auto runs = std::move(RunManager::create(few).value());
  const std::string first = runs->start("small", endless()).value().id;
  wait_for_first_frame(*runs->timeline(first).value());
  StartReport report;
  for (int i = 0; i < 3; ++i) ASSERT_TRUE(runs->start("small", {}, {}, &report).ok());
  EXPECT_EQ(report.refusal, StartReport::Refusal::kNone);
  const auto refused = runs->start("small", {}, {}, &report);
  ASSERT_FALSE(refused.ok());
  EXPECT_EQ(report.refusal, StartReport::Refusal::kQueueFull);
  EXPECT_THAT(refused.error().message, HasSubstr("waiting runs = 3: must be below 3"));
  EXPECT_TRUE(runs->cancel(first).ok());
}

TEST_F(RunLimitsTest, OfManyWhoDeleteARunOneSucceeds) {
  const auto runs = manager();
  for (int round = 0; round < 5; ++round) {
    const std::string id = fly(*runs);
    for (int i = 0; i < 300; ++i)
      overfly::testing::write_text(folder_of(id) / std::to_string(i), "");
    std::atomic<int> deleted = 0;
    std::atomic<int> refused = 0;
    std::vector<std::thread> clients;
    for (int i = 0; i < 6; ++i) {
      clients.emplace_back([&] {
        const Status status = runs->remove(id);
        if (status) {
          ++deleted;
        } else if (status.error().code == ErrorCode::kNotFound ||
                   status.error().code == ErrorCode::kConflict) {
          ++refused;
        }
      });
    }
    for (std::thread& client : clients) client.join();
    EXPECT_EQ(deleted, 1);
    EXPECT_EQ(refused, 5);
    EXPECT_TRUE(fs::is_empty(root() / "runs")) << "nothing is left, nothing stands aside";
  }
}

TEST_F(RunLimitsTest, DeletingFollowsNoLink) {
  const auto runs = manager();
  const fs::path outside = root() / "outside";
  fs::create_directories(outside);
  overfly::testing::write_text(outside / "kept.txt", "kept");
  const std::string id = fly(*runs);
  fs::create_directory_symlink(outside, folder_of(id) / "link");
  fs::copy(folder_of(id),
           root() / "elsewhere",
           fs::copy_options::recursive | fs::copy_options::copy_symlinks);
  fs::create_directory_symlink(root() / "elsewhere", folder_of("linked"));
  EXPECT_TRUE(runs->remove(id).ok());
  EXPECT_TRUE(runs->remove("linked").ok());
  EXPECT_TRUE(fs::exists(outside / "kept.txt"));
  EXPECT_TRUE(fs::exists(manifest_file(root() / "elsewhere")));
  EXPECT_FALSE(fs::exists(root() / "elsewhere" / ".running"));
  EXPECT_THAT(runs->runs(), IsEmpty());
}

TEST_F(RunLimitsTest, RunThatIsWorkedOnIsNotDeleted) {
  const auto runs = manager();
  const std::string id = fly(*runs);
  {
    const RunLock lock = std::move(RunLock::take(folder_of(id))).value();
    EXPECT_EQ(runs->remove(id).error().code, ErrorCode::kConflict);
  }
  EXPECT_TRUE(runs->remove(id).ok());
}

TEST_F(RunLimitsTest, LeftoversOfAKilledServerAreRemoved) {
  const fs::path place = root() / "runs";
  fs::create_directories(place / ".deleted-20200101-000000-small-abcdef-1" / "frames");
  fs::create_directories(place / "20200101-000000-small-abcdef");
  fs::create_directories(place / "notes");
  (void)manager();
  EXPECT_FALSE(fs::exists(place / ".deleted-20200101-000000-small-abcdef-1"));
  EXPECT_TRUE(fs::exists(place / "20200101-000000-small-abcdef"))
      << "made just now: another server's run may wait for its turn";
  EXPECT_TRUE(fs::exists(place / "notes"));
}

TEST_F(RunLimitsTest, RunsCancelledWhileTheyWaitedLeaveTheList) {
  const auto runs = manager();
  const std::string first = runs->start("small", endless()).value().id;
  wait_for_first_frame(*runs->timeline(first).value());
  std::string last;
  for (int i = 0; i < 30; ++i) {
    last = runs->start("small", {}).value().id;
    EXPECT_TRUE(fs::exists(folder_of(last)));
    EXPECT_TRUE(runs->cancel(last).ok());
    EXPECT_FALSE(fs::exists(folder_of(last)));
  }
  EXPECT_EQ(runs->runs().size(), 9U) << "the one that flies, and the last eight";
  EXPECT_EQ(runs->run(last).value().status, RunStatus::kCancelled);
  EXPECT_TRUE(runs->remove(last).ok());
  EXPECT_EQ(runs->remove(last).error().code, ErrorCode::kNotFound);
  EXPECT_EQ(runs->runs().size(), 8U);
  EXPECT_TRUE(runs->cancel(first).ok());
}

TEST_F(RunLimitsTest, RunsThatWaitLeaveNoFolderWhenTheServerStops) {
  {
    const auto runs = manager();
    (void)runs->start("small", endless());
    for (int i = 0; i < 3; ++i) (void)runs->start("small", {});
  }
  for (const auto& entry : fs::directory_iterator(root() / "runs")) {
    EXPECT_TRUE(fs::exists(manifest_file(entry.path()))) << entry.path();
  }
}

TEST_F(RunLimitsTest, ServerThatStopsCancelsAllFlightsBeforeItEnds) {
  const auto runs = manager();
  const std::string flying = runs->start("small", endless()).value().id;
  wait_for_first_frame(*runs->timeline(flying).value());
  const std::string waiting = runs->start("small", {}).value().id;
  runs->cancel_all();
  EXPECT_EQ(wait_for_end(*runs, flying).status, RunStatus::kCancelled);
  EXPECT_EQ(runs->run(waiting).value().status, RunStatus::kQueued);
  const auto refused = runs->start("small", {});
  ASSERT_FALSE(refused.ok());
  EXPECT_EQ(refused.error().message, "the server is stopping");
}

std::optional<std::string> run_of(IdempotencyKeys& keys,
                                  const std::string& key,
                                  IdempotencyKeys::Time now) {
  const auto start = keys.start_of(key, now);
  return start ? std::optional(start->run_id) : std::nullopt;
}

TEST(IdempotencyKeys, LeaveByNumberAndAge) {
  using namespace std::chrono_literals;
  IdempotencyKeys keys;
  const IdempotencyKeys::Time start{};
  for (std::size_t i = 0; i < IdempotencyKeys::kMostKeys; ++i) {
    keys.keep({std::to_string(i)}, "run" + std::to_string(i), start);
  }
  EXPECT_EQ(run_of(keys, "0", start), "run0") << "asked for: it stays";
  keys.keep({"one more"}, "run", start + 1h);
  EXPECT_EQ(keys.size(), IdempotencyKeys::kMostKeys);
  EXPECT_EQ(run_of(keys, "1", start), std::nullopt) << "the one asked for least lately";
  EXPECT_EQ(run_of(keys, "0", start), "run0");
  EXPECT_EQ(run_of(keys, "0", start + IdempotencyKeys::kOldest), std::nullopt);
  EXPECT_EQ(run_of(keys, "one more", start + IdempotencyKeys::kOldest), "run");
  EXPECT_EQ(keys.size(), 1U);
  keys.forget_run("run");
  EXPECT_EQ(run_of(keys, "one more", start), std::nullopt);
  keys.keep({""}, "run", start);
  EXPECT_EQ(keys.size(), 0U) << "an empty key is none";
  keys.keep({"k"}, "a", start);
  keys.keep({"k"}, "b", start);
  EXPECT_EQ(run_of(keys, "k", start), "b");
  EXPECT_EQ(keys.size(), 1U);
}

TEST_F(RunLimitsTest, KeyOfADeletedRunGivesAnother) {
  const auto runs = manager();
  StartReport report;
  const std::string id = runs->start("small", {}, {"k"}, &report).value().id;
  EXPECT_FALSE(report.repeated);
  wait_for_end(*runs, id);
  EXPECT_EQ(runs->start("small", {}, {"k"}, &report).value().id, id);
  EXPECT_TRUE(report.repeated);
  ASSERT_TRUE(runs->remove(id).ok());
  report = {};
  const std::string other = runs->start("small", {}, {"k"}, &report).value().id;
  EXPECT_NE(other, id);
  EXPECT_FALSE(report.repeated);
  wait_for_end(*runs, other);
}

}  // namespace
}  // namespace overfly::server
