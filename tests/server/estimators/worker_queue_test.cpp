// Frames that are handed over ahead of the estimator: order, bound, answers by frame, latency.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <condition_variable>
#include <memory>
#include <mutex>
#include <stdexcept>
#include <string>
#include <vector>

#include "server/estimators/estimator_worker.hpp"

namespace overfly::server {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

/// Answers only the frames up to a released one, and logs a line for each.
class Gate final : public VoPort {
 public:
  class Shared {
   public:
    void release(std::int64_t frame) {
      const std::lock_guard lock(mutex_);
      released_ = frame;
      changed_.notify_all();
    }
    void wait_until_begun(std::int64_t frame) {
      std::unique_lock lock(mutex_);
      changed_.wait(lock, [&] { return begun_ >= frame; });
    }
    void pass(std::int64_t frame) {
      std::unique_lock lock(mutex_);
      begun_ = frame;
      changed_.notify_all();
      changed_.wait(lock, [&] { return released_ >= frame; });
    }
    std::int64_t throws_at = -1;

   private:
    std::mutex mutex_;
    std::condition_variable changed_;
    std::int64_t begun_ = -1, released_ = -1;
  };
  explicit Gate(Shared& shared) : shared_(shared) {}
  std::string type() const override { return "gate"; }
  std::map<std::string, std::string> effective_parameters() const override { return {}; }
  Status prepare(const VoFrame& /*first*/) override {
    said_ = {"ready"};
    return {};
  }
  Result<VoEstimate> track(const VoFrame& frame) override {
    shared_.pass(frame.index);
    if (frame.index == shared_.throws_at) throw std::runtime_error("broken");
    said_.push_back("frame " + std::to_string(frame.index));
    VoEstimate estimate;
    estimate.sample.state = TrackingState::kTracking;
    return estimate;
  }
  void set_debug(bool /*wanted*/) override {}
  std::vector<std::string> take_log() override { return std::exchange(said_, {}); }

 private:
  Shared& shared_;
  std::vector<std::string> said_;
};

VoFrame waiting_frame(std::int64_t index) {
  VoFrame frame;
  frame.index = index;
  frame.t_ns = index * 1'000'000;
  frame.image = std::make_shared<const Image>(4, 4, 1);
  return frame;
}

EstimatorWorkerOptions ahead(std::size_t frames) {
  EstimatorWorkerOptions options;
  options.frames_ahead = frames;
  return options;
}

std::vector<std::int64_t> frames_of(const std::vector<EstimatorEvent>& events, bool dropped) {
  std::vector<std::int64_t> frames;
  for (const EstimatorEvent& event : events) {
    if (event.record.dropped == dropped) frames.push_back(event.record.sample.frame);
  }
  return frames;
}

TEST(WorkerQueue, FramesAheadAreAnsweredInOrderAndNoneIsDropped) {
  Gate::Shared gate;
  EstimatorWorker worker(std::make_unique<Gate>(gate), ahead(3), machine_clock());
  worker.submit(waiting_frame(0));
  gate.wait_until_begun(0);
  for (int k = 1; k <= 4; ++k) worker.submit(waiting_frame(k));
  gate.release(4);
  worker.wait_until_idle();
  const std::vector<EstimatorEvent> events = worker.take_events();
  EXPECT_THAT(frames_of(events, false), ElementsAre(0, 1, 2, 3, 4));
  EXPECT_THAT(frames_of(events, true), IsEmpty());
}

TEST(WorkerQueue, BeyondItsPlacesTheNewestWaitingFrameIsDropped) {
  Gate::Shared gate;
  EstimatorWorker worker(std::make_unique<Gate>(gate), ahead(1), machine_clock());
  worker.submit(waiting_frame(0));
  gate.wait_until_begun(0);
  for (int k = 1; k <= 4; ++k) worker.submit(waiting_frame(k));
  gate.release(4);
  worker.wait_until_idle();
  const std::vector<EstimatorEvent> events = worker.take_events();
  EXPECT_THAT(frames_of(events, false), ElementsAre(0, 1, 4));
  EXPECT_THAT(frames_of(events, true), ElementsAre(2, 3));
}

TEST(WorkerQueue, AnswersAreTakenUpToAFrameHoweverFarTheEstimatorIs) {
  Gate::Shared gate;
  EstimatorWorker worker(std::make_unique<Gate>(gate), ahead(4), machine_clock());
  for (int k = 0; k <= 4; ++k) worker.submit(waiting_frame(k));
  gate.wait_until_begun(0);
  EXPECT_FALSE(worker.answered(0));
  EXPECT_THAT(worker.take_events(0), IsEmpty());
  gate.release(2);
  worker.wait_until_answered(1);
  EXPECT_TRUE(worker.answered(1));
  EXPECT_THAT(frames_of(worker.take_events(0), false), ElementsAre(0));
  gate.wait_until_begun(3);
  EXPECT_FALSE(worker.answered(3));
  EXPECT_THAT(frames_of(worker.take_events(1), false), ElementsAre(1));
  gate.release(4);
  worker.wait_until_idle();
  EXPECT_THAT(frames_of(worker.take_events(), false), ElementsAre(2, 3, 4));
}

TEST(WorkerQueue, LogLinesComeWithTheFrameTheyAreAbout) {
  Gate::Shared gate;
  EstimatorWorker worker(std::make_unique<Gate>(gate), ahead(3), machine_clock());
  worker.prepare(waiting_frame(0));
  worker.wait_until_idle();
  EXPECT_THAT(worker.take_log(), ElementsAre("ready"));
  gate.release(1);
  for (int k = 0; k <= 2; ++k) worker.submit(waiting_frame(k));
  gate.wait_until_begun(2);
  EXPECT_THAT(worker.take_log(), IsEmpty()) << "frame 2 is in progress";
  const std::vector<EstimatorEvent> events = worker.take_events(1);
  ASSERT_EQ(events.size(), 2U);
  EXPECT_THAT(events[0].log, ElementsAre("frame 0"));
  EXPECT_THAT(events[1].log, ElementsAre("frame 1"));
  gate.release(2);
  worker.wait_until_idle();
  EXPECT_THAT(worker.take_log(), IsEmpty());
  EXPECT_THAT(worker.take_events().at(0).log, ElementsAre("frame 2"));
}

TEST(WorkerQueue, ForgottenFramesAreNeitherTrackedNorReported) {
  Gate::Shared gate;
  EstimatorWorker worker(std::make_unique<Gate>(gate), ahead(4), machine_clock());
  for (int k = 0; k <= 4; ++k) worker.submit(waiting_frame(k));
  gate.wait_until_begun(0);
  worker.forget_after(1);
  gate.release(4);
  worker.wait_until_idle();
  EXPECT_THAT(frames_of(worker.take_events(), false), ElementsAre(0, 1));
  worker.forget_after(-1);
  worker.submit(waiting_frame(2));
  worker.wait_until_answered(2);
  EXPECT_THAT(frames_of(worker.take_events(), false), ElementsAre(2));
}

TEST(WorkerQueue, FramesBehindACrashAreLost) {
  Gate::Shared gate;
  gate.throws_at = 1;
  EstimatorWorker worker(std::make_unique<Gate>(gate), ahead(4), machine_clock());
  gate.release(1);
  for (int k = 0; k <= 3; ++k) worker.submit(waiting_frame(k));
  worker.wait_until_idle();
  const std::vector<EstimatorEvent> events = worker.take_events();
  ASSERT_THAT(frames_of(events, false), ElementsAre(0, 1, 2, 3));
  EXPECT_EQ(events[0].record.sample.state, TrackingState::kTracking);
  EXPECT_THAT(events[1].record.crash, ::testing::HasSubstr("broken"));
  for (int k = 2; k <= 3; ++k) EXPECT_EQ(events[k].record.sample.state, TrackingState::kLost);
}

/// Advances only while an estimator works.
class WorkClock final : public RunClock {
 public:
  std::int64_t now_ns() override {
    const std::lock_guard lock(mutex_);
    return now_ns_;
  }
  void sleep_until_ns(std::int64_t t_ns) override {
    const std::lock_guard lock(mutex_);
    now_ns_ = std::max(now_ns_, t_ns);
  }

 private:
  std::mutex mutex_;
  std::int64_t now_ns_ = 0;
};

/// Takes 10 ms for each frame.
class Tens final : public VoPort {
 public:
  Tens(RunClock& clock, Gate::Shared& gate) : clock_(clock), gate_(gate) {}
  std::string type() const override { return "tens"; }
  std::map<std::string, std::string> effective_parameters() const override { return {}; }
  Result<VoEstimate> track(const VoFrame& frame) override {
    gate_.pass(frame.index);
    clock_.sleep_until_ns(clock_.now_ns() + 10'000'000);
    return VoEstimate();
  }
  void set_debug(bool /*wanted*/) override {}

 private:
  RunClock& clock_;
  Gate::Shared& gate_;
};

std::vector<double> latencies(std::size_t frames_ahead, int frames) {
  WorkClock clock;
  Gate::Shared gate;
  EstimatorWorker worker(std::make_unique<Tens>(clock, gate), ahead(frames_ahead), clock);
  worker.submit(waiting_frame(0));
  gate.wait_until_begun(0);
  for (int k = 1; k < frames; ++k) worker.submit(waiting_frame(k));
  gate.release(frames);
  worker.wait_until_idle();
  std::vector<double> latencies_ms;
  for (const EstimatorEvent& event : worker.take_events()) latencies_ms.push_back(event.latency_ms);
  return latencies_ms;
}

TEST(WorkerQueue, LatencyCountsTheWaitingInRealTimeOnly) {
  EXPECT_THAT(latencies(3, 4), ElementsAre(10.0, 10.0, 10.0, 10.0));
  EXPECT_THAT(latencies(0, 2), ElementsAre(10.0, 20.0));
}

}  // namespace
}  // namespace overfly::server
