// Shared work is done once, by all threads, and failures reach the one who asked.
#include "renderer/worker_pool.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

namespace overfly::renderer {
namespace {

using Clock = std::chrono::steady_clock;

TEST(WorkerPool, CallsEveryIndexOnce) {
  for (const int threads : {1, 2, 5}) {
    WorkerPool pool(threads);
    EXPECT_EQ(pool.threads(), threads);
    for (const int jobs : {0, 1, 2, 3, 7, 1000}) {
      std::vector<std::atomic<int>> calls(jobs);
      pool.run(jobs, [&](int i) { ++calls.at(i); });
      for (int i = 0; i < jobs; ++i) EXPECT_EQ(calls[i], 1) << i << " of " << jobs;
    }
  }
}

TEST(WorkerPool, ReturnsAfterTheLastJobInEveryRound) {
  // Rounds in quick succession, each of which reads what the one before has written.
  WorkerPool pool(3);
  std::vector<int> values(16, 0), next(16, 0);
  for (int round = 0; round < 2000; ++round) {
    pool.run(16, [&](int i) { next[i] = values[(i + 1) % 16] + 1; });
    std::swap(values, next);
  }
  EXPECT_EQ(values, std::vector<int>(16, 2000));
}

TEST(WorkerPool, WorksAtOnceOnItsThreads) {
  WorkerPool pool(3);
  std::atomic<int> met{0};
  std::atomic<bool> late{false};
  const auto deadline = Clock::now() + std::chrono::seconds(10);
  // Each job ends only when all three have begun.
  pool.run(3, [&](int) {
    ++met;
    while (met < 3 && !late) {
      if (Clock::now() > deadline) late = true;
      std::this_thread::yield();
    }
  });
  EXPECT_FALSE(late);
}

TEST(WorkerPool, WakesThreadsThatFellAsleep) {
  WorkerPool pool(3);
  std::atomic<int> sum{0};
  for (int round = 0; round < 5; ++round) {
    // Far longer than its threads poll.
    const auto idle_until = Clock::now() + std::chrono::milliseconds(3);
    while (Clock::now() < idle_until) std::this_thread::yield();
    pool.run(100, [&](int i) { sum += i; });
  }
  EXPECT_EQ(sum, 5 * 4950);
}

TEST(WorkerPool, PassesOnAJobsExceptionAndWorksOn) {
  for (const int threads : {1, 3}) {
    WorkerPool pool(threads);
    for (int round = 0; round < 50; ++round) {
      std::vector<std::atomic<int>> calls(40);
      const auto job = [&](int i) {
        ++calls.at(i);
        if (i == 20) throw std::runtime_error("job " + std::to_string(i));
      };
      try {
        pool.run(40, job);
        FAIL() << "nothing was thrown";
      } catch (const std::runtime_error& error) {
        EXPECT_STREQ(error.what(), "job 20");
      }
      for (int i = 0; i <= 20; ++i) EXPECT_EQ(calls[i], 1);
      for (int i = 21; i < 40; ++i) EXPECT_LE(calls[i], 1);
      std::atomic<int> sum{0};
      pool.run(40, [&](int i) { sum += i; });
      EXPECT_EQ(sum, 780);
    }
  }
}

TEST(WorkerPool, OfManyExceptionsOneArrives) {
  WorkerPool pool(4);
  for (int round = 0; round < 50; ++round) {
    EXPECT_THROW(pool.run(64, [](int i) { throw std::out_of_range(std::to_string(i)); }),
                 std::out_of_range);
  }
  int calls = 0;
  pool.run(1, [&](int) { ++calls; });
  EXPECT_EQ(calls, 1);
}

}  // namespace
}  // namespace overfly::renderer
