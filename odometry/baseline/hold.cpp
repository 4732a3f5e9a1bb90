#include "odometry/baseline/baseline_odometry.hpp"
#include "odometry/baseline/baseline_port.hpp"

namespace overfly::odometry::baseline {
namespace {

class HoldOdometry final : public BaselinePort {
 public:
  [[nodiscard]] std::string type() const override { return "baseline_hold"; }

 private:
  void answer(const VoFrame& /*frame*/, VoEstimate& estimate) override {
    estimate.sample.state = TrackingState::kTracking;
    estimate.sample.scene_depth = 1.0;  // any scale is as good as another
  }
};

}  // namespace

std::unique_ptr<VoPort> create_hold() { return std::make_unique<HoldOdometry>(); }

}  // namespace overfly::odometry::baseline
