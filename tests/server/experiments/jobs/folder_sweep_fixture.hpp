// A sweep that a thread controls, and workers of its job folder that the test steps.
#pragma once

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <filesystem>
#include <memory>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "server/experiments/jobs/folder_executor.hpp"
#include "server/experiments/jobs/job_worker.hpp"
#include "server/experiments/sweep_summary.hpp"
#include "tests/server/experiments/fly_sweep_fixture.hpp"

namespace overfly::server::experiments {

inline constexpr const char* kVersion = "0.1.0 test";
/// Where nothing is lost: longer than any pause of a busy machine.
inline constexpr double kLongLease_s = 60.0;
inline constexpr double kShortLease_s = 0.6;
inline constexpr std::chrono::milliseconds kStep{5};

class FolderSweep : public FlySweep {
 protected:
  void TearDown() override {
    cancel_ = true;
    if (controller_.joinable()) controller_.join();
  }
  /// Controls the sweep in a thread until all flights are over.
  void control(const Sweep& sweep, double lease_s = kLongLease_s) {
    over_ = false;
    flown_.reset();
    controller_ = std::thread([this, &sweep, lease_s] {
      SweepOptions sweep_options = options(100);
      sweep_options.open_executor = [&, this]() -> Result<std::unique_ptr<FlightExecutor>> {
        FolderExecutorOptions executor;
        executor.version = kVersion;
        executor.lease_s = lease_s;
        executor.poll_s = 0.02;
        executor.warn = sweep_options.warn;
        auto opened = FolderExecutor::open(folder(), std::move(executor));
        if (!opened) return opened.error();
        return std::unique_ptr<FlightExecutor>(std::move(*opened));
      };
      flown_ = std::make_unique<Result<FlownSweep>>(fly_sweep(sweep, sweep_options));
      over_ = true;
    });
    // Until the executor has read what an earlier one left.
    const JobFolder jobs(folder());
    const auto has_jobs = [&jobs] {
      const auto open = jobs.open_jobs();
      return open && !open->empty();
    };
    while (!over_ && (std::filesystem::exists(folder() / "jobs/closed") || !has_jobs())) {
      std::this_thread::sleep_for(kStep);
    }
  }
  const FlownSweep& finished() {
    controller_.join();
    EXPECT_TRUE(flown_->ok()) << (flown_->ok() ? "" : flown_->error().message);
    return **flown_;
  }
  JobWorker worker(std::size_t jobs = 1) {
    WorkerOptions worker_options;
    worker_options.sweep = folder();
    worker_options.program = program();
    worker_options.version = kVersion;
    worker_options.jobs = jobs;
    worker_options.idle_s = 5.0;
    worker_options.beat_s = 0.05;
    worker_options.silence_s = 0.5;
    worker_options.warn = [this](const std::string& text) { worker_warnings_.push_back(text); };
    Result<JobWorker> started = JobWorker::start(std::move(worker_options));
    EXPECT_TRUE(started.ok()) << (started.ok() ? "" : started.error().message);
    return std::move(*started);
  }
  /// Steps a worker until a condition holds; false if that takes too long.
  template <typename Condition>
  static bool step_until(JobWorker& worker, const Condition& condition) {
    const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(30);
    while (!condition()) {
      const Result<bool> more = worker.step();
      if (!more || std::chrono::steady_clock::now() > end) return false;
      std::this_thread::sleep_for(kStep);
    }
    return true;
  }
  bool step_until_over(JobWorker& worker) {
    return step_until(worker, [this] { return over_.load(); });
  }
  static int flights_of(const FlownSweep& flown, const std::filesystem::path& folder) {
    int flights = 0;
    for (const auto& row : summary_of(flown, folder, evaluation::AlignmentMode::kSim3)) {
      flights += row.flights;
      EXPECT_EQ(row.successes, row.flights);
    }
    return flights;
  }

  std::atomic<bool> over_{false};
  std::thread controller_;
  std::unique_ptr<Result<FlownSweep>> flown_;
  std::vector<std::string> worker_warnings_;
};

}  // namespace overfly::server::experiments
