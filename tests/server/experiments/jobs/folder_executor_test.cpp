// What the controller of a job folder reports to those that supply it with workers.
#include "server/experiments/jobs/folder_executor.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <memory>
#include <thread>
#include <utility>

#include "tests/support/support.hpp"

namespace overfly::server::experiments {
namespace {

/// Starts no workers, and keeps what it was called with.
class CountingSupply : public WorkerSupply {
 public:
  explicit CountingSupply(FlightCounts* last) : last_(last) {}
  Status keep(const FlightCounts& flights, const RunMemory&) override {
    *last_ = flights;
    return {};
  }
  void stop() override {}

 private:
  FlightCounts* last_;
};

TEST(FolderExecutor, TellsTakenFlightsFromThoseThatWaitForAWorker) {
  const overfly::testing::TemporaryFolder folder;
  FlightCounts last;
  FolderExecutorOptions options;
  options.version = "0.1.0 test";
  options.lease_s = 0.3;
  options.poll_s = 0.0;
  options.supply = std::make_unique<CountingSupply>(&last);
  auto executor = FolderExecutor::open(folder.path(), std::move(options));
  ASSERT_TRUE(executor.ok()) << executor.error().message;
  const auto poll = [&] { ASSERT_TRUE((*executor)->ended().ok()); };
  for (const char* id : {"a", "b"}) {
    ASSERT_TRUE((*executor)->start({id, "", "", "", 60.0, {}, {}}).ok());
  }
  poll();
  EXPECT_EQ(last.open, 2U);
  EXPECT_EQ(last.untaken, 2U);
  const JobFolder jobs(folder.path());
  const std::string taken = jobs.open_jobs()->front();
  ASSERT_TRUE(jobs.take(taken, "worker").value());
  poll();
  EXPECT_EQ(last.open, 2U);
  EXPECT_EQ(last.untaken, 1U);
  // The worker is never heard of: its flight is free again after the lease.
  const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(30);
  while (last.untaken < 2 && std::chrono::steady_clock::now() < end) {
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
    poll();
  }
  EXPECT_EQ(last.open, 2U);
  EXPECT_EQ(last.untaken, 2U);
}

}  // namespace
}  // namespace overfly::server::experiments
