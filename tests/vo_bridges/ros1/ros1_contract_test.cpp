#include <gtest/gtest.h>

#include <utility>

#include "tests/vo_bridges/ros1/ros_world.hpp"
#include "tests/vo_bridges/vo_port_contract.hpp"

namespace overfly::testing {
namespace {

/// An estimator with a node of its own behind it.
class WithNode final : public VoPort {
 public:
  explicit WithNode(Ros1PoseType type) {
    RosMaster::instance().start();
    Ros1EstimatorOptions options = fresh_options();
    options.pose_type = type;
    options.vo_frame = options.image_topic.substr(1, 3);
    options.answer_timeout_s = 20.0;  // of a busy machine
    node_ = std::make_unique<TestNode>(options);
    auto port = create_ros1_estimator(options);
    EXPECT_TRUE(port.ok()) << port.error().message;
    port_ = std::move(port).value();
  }

  [[nodiscard]] std::string type() const override { return port_->type(); }
  [[nodiscard]] std::map<std::string, std::string> effective_parameters() const override {
    return port_->effective_parameters();
  }
  [[nodiscard]] Status prepare(const VoFrame& first) override { return port_->prepare(first); }
  [[nodiscard]] Result<VoEstimate> track(const VoFrame& frame) override {
    return port_->track(frame);
  }
  void set_debug(bool wanted) override { port_->set_debug(wanted); }

 private:
  std::unique_ptr<TestNode> node_;
  std::unique_ptr<VoPort> port_;
};

VoPortCase case_of(const std::string& name, Ros1PoseType type) {
  return {
      name, [type] { return std::make_unique<WithNode>(type); }, [] { return plain_frames(6); }, 6};
}

/// None where there is no master to be had.
std::vector<VoPortCase> cases() {
  if (!has_rosmaster()) return {};
  return {case_of("PoseStamped", Ros1PoseType::kPoseStamped)};
}

TEST(Ros1Contract, IsHeldWhereThereIsAMaster) {
  ROS_MASTER_OR_SKIP();
  EXPECT_FALSE(cases().empty());
}

GTEST_ALLOW_UNINSTANTIATED_PARAMETERIZED_TEST(VoPortContract);
INSTANTIATE_TEST_SUITE_P(Ros1,
                         VoPortContract,
                         ::testing::ValuesIn(cases()),
                         [](const auto& tested) { return tested.param.name; });

}  // namespace
}  // namespace overfly::testing
