// What is thrown on the worker's thread, by the estimator or for want of memory, reaches the run.
#include "server/estimators/estimator_worker.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <new>
#include <stdexcept>

#include "tests/support/allocation_failure.hpp"

namespace overfly::server {
namespace {

using overfly::testing::AllocationFailure;
using ::testing::HasSubstr;
using ::testing::SizeIs;

/// Throws where it is told to.
class Thrower final : public VoPort {
 public:
  explicit Thrower(std::string where) : where_(std::move(where)) {}
  std::string type() const override { return "thrower"; }
  std::map<std::string, std::string> effective_parameters() const override { return {}; }
  Status prepare(const VoFrame& /*first*/) override {
    AllocationFailure::may_fail_here();
    return {};
  }
  Result<VoEstimate> track(const VoFrame& /*frame*/) override {
    throw_at("track");
    VoEstimate estimate;
    estimate.sample.state = TrackingState::kTracking;
    estimate.counters["a counter with a long enough name to be allocated"] = 1.0;
    return estimate;
  }
  void set_debug(bool /*wanted*/) override { throw_at("set_debug"); }
  std::optional<ResourceUse> resource_use() const override {
    throw_at("resource_use");
    return std::nullopt;
  }

 private:
  void throw_at(const std::string& place) const {
    if (place == where_) throw std::runtime_error("thrown in " + place);
  }
  std::string where_;
};

VoFrame frame_of(std::int64_t index) {
  VoFrame frame;
  frame.index = index;
  frame.t_ns = index * 1'000'000;
  frame.image = std::make_shared<const Image>(4, 4, 1);
  return frame;
}

/// The answer to one frame.
EstimatorEvent answered(EstimatorWorker& worker, std::int64_t index) {
  worker.submit(frame_of(index));
  worker.wait_until_idle();
  std::vector<EstimatorEvent> events = worker.take_events();
  EXPECT_THAT(events, SizeIs(1));
  return events.empty() ? EstimatorEvent() : std::move(events.front());
}

TEST(EstimatorWorker, WhateverAnEstimatorThrowsIsItsCrash) {
  for (const char* where : {"track", "set_debug", "resource_use"}) {
    EstimatorWorkerOptions options;
    options.debug_hz = 1.0;
    EstimatorWorker worker(std::make_unique<Thrower>(where), options, machine_clock());
    worker.prepare(frame_of(0));
    worker.wait_until_idle();
    const EstimatorEvent event = answered(worker, 1);
    EXPECT_THAT(event.record.crash, HasSubstr(std::string("thrown in ") + where));
    EXPECT_EQ(answered(worker, 2).record.sample.state, TrackingState::kLost);
  }
}

TEST(EstimatorWorker, ARunThatIsStoppedDoesNotWaitForAThrottledEstimator) {
  std::atomic<bool> cancel = false;
  EstimatorWorkerOptions options;
  options.throttle_hz = 1e-6;
  options.cancel = &cancel;
  EstimatorWorker worker(std::make_unique<Thrower>(""), options, machine_clock());
  worker.submit(frame_of(0));
  cancel = true;
  worker.wait_until_idle();
  const std::vector<EstimatorEvent> events = worker.take_events();
  ASSERT_THAT(events, SizeIs(1));
  EXPECT_TRUE(events.front().record.dropped);
  cancel = false;
  worker.submit(frame_of(1));  // whose wait ends with the worker
}

/// One allocation after the other fails; after each the worker answers on.
TEST(EstimatorWorker, TooLittleMemoryForAnAnswerIsToldToTheRunAndTheWorkerGoesOn) {
  int told = 0;
  for (int before = 0;; ++before) {
    EstimatorWorker worker(std::make_unique<Thrower>(""), {}, machine_clock());
    worker.prepare(frame_of(0));
    worker.wait_until_idle();
    AllocationFailure::arm(before);
    worker.submit(frame_of(1));
    std::vector<EstimatorEvent> events;
    try {
      worker.wait_until_idle();
      events = worker.take_events();
    } catch (const std::bad_alloc&) {
      ++told;
    }
    const bool failed = AllocationFailure::disarm();
    if (events.empty()) events.push_back(answered(worker, 2));
    ASSERT_THAT(events, SizeIs(1));
    if (failed) continue;
    EXPECT_EQ(events.front().record.sample.state, TrackingState::kTracking);
    break;
  }
  EXPECT_GT(told, 0);
}

}  // namespace
}  // namespace overfly::server
