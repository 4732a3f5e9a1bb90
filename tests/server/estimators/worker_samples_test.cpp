// Samples of sensors of frames that an estimator's worker drops.
#include <gtest/gtest.h>

#include <future>
#include <memory>

#include "server/estimators/estimator_worker.hpp"

namespace overfly::server {
namespace {

/// Works on its first frame until it is released; keeps the IMU times of each frame.
class Busy final : public VoPort {
 public:
  struct Shared {
    std::promise<void> begun;
    std::promise<void> release;
    std::vector<std::vector<std::int64_t>> imu_t_ns;
  };
  explicit Busy(Shared& shared) : shared_(shared) {}
  std::string type() const override { return "busy"; }
  std::map<std::string, std::string> effective_parameters() const override { return {}; }
  Result<VoEstimate> track(const VoFrame& frame) override {
    std::vector<std::int64_t>& times = shared_.imu_t_ns.emplace_back();
    for (const ImuSample& sample : frame.sensors.imu) times.push_back(sample.t_ns);
    if (shared_.imu_t_ns.size() == 1) {
      shared_.begun.set_value();
      shared_.release.get_future().wait();
    }
    VoEstimate estimate;
    estimate.sample.frame = frame.index;
    estimate.sample.t_ns = frame.t_ns;
    return estimate;
  }
  void set_debug(bool /*wanted*/) override {}

 private:
  Shared& shared_;
};

VoFrame frame_with_sample(std::int64_t index, std::int64_t t_ns) {
  VoFrame frame;
  frame.index = index;
  frame.t_ns = t_ns;
  frame.image = std::make_shared<const Image>(4, 4, 1);
  frame.intrinsics = PinholeCamera::from_fov(4, 4, 1.0, FovAxis::kHorizontal).value();
  frame.sensors.imu = {{t_ns, {}, {}}};
  return frame;
}

TEST(WorkerSamples, OfDroppedFramesComeWithTheNextUnlessTheyAreOld) {
  Busy::Shared shared;
  EstimatorWorker worker(std::make_unique<Busy>(shared), {}, machine_clock());
  worker.submit(frame_with_sample(0, 0));
  shared.begun.get_future().wait();
  // All but the last are dropped; the first is more than ten seconds older than the last.
  worker.submit(frame_with_sample(1, 1 * kNsPerS));
  worker.submit(frame_with_sample(2, 6 * kNsPerS));
  worker.submit(frame_with_sample(3, 12 * kNsPerS));
  shared.release.set_value();
  worker.wait_until_idle();
  const std::vector<std::vector<std::int64_t>> expected = {{0}, {6 * kNsPerS, 12 * kNsPerS}};
  EXPECT_EQ(shared.imu_t_ns, expected);
}

}  // namespace
}  // namespace overfly::server
