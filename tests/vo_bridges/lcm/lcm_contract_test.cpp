// The contract of VoPort, kept over LCM: in memory, and by UDP multicast where that works.
#include <atomic>

#include "tests/vo_bridges/lcm/lcm_test_estimator.hpp"
#include "tests/vo_bridges/vo_port_contract.hpp"

namespace overfly {
namespace {

using testing::LcmPair;
using testing::plain_frames;
using testing::VoPortCase;
using testing::VoPortContract;

/// Keeps the estimator as long as its door.
class PairPort final : public VoPort {
 public:
  explicit PairPort(LcmPair pair) : pair_(std::move(pair)) {}
  [[nodiscard]] std::string type() const override { return pair_.door->type(); }
  [[nodiscard]] std::map<std::string, std::string> effective_parameters() const override {
    return pair_.door->effective_parameters();
  }
  [[nodiscard]] Status prepare(const VoFrame& first) override { return pair_.door->prepare(first); }
  [[nodiscard]] Result<VoEstimate> track(const VoFrame& frame) override {
    return pair_.door->track(frame);
  }
  void set_debug(bool wanted) override { pair_.door->set_debug(wanted); }

 private:
  LcmPair pair_;
};

std::unique_ptr<VoPort> over_memq() {
  return std::make_unique<PairPort>(testing::make_memq_pair());
}

/// Each pair on channels of its own.
std::unique_ptr<VoPort> over_udp() {
  static std::atomic<int> pairs = 0;
  LcmEstimatorOptions options;
  options.url = testing::private_udp_url();
  options.channel_prefix = "TEST" + std::to_string(++pairs) + "_";
  return std::make_unique<PairPort>(testing::make_udp_pair({}, options, options.url));
}

INSTANTIATE_TEST_SUITE_P(Lcm,
                         VoPortContract,
                         ::testing::Values(VoPortCase{
                             "memq", over_memq, [] { return plain_frames(6); }, 5}),
                         [](const auto& instance) { return instance.param.name; });

std::vector<VoPortCase> udp_cases() {
  if (!testing::multicast_missing().empty()) return {};
  return {{"udpm", over_udp, [] { return plain_frames(6, 640, 480); }, 5}};
}

INSTANTIATE_TEST_SUITE_P(LcmUdp,
                         VoPortContract,
                         ::testing::ValuesIn(udp_cases()),
                         [](const auto& i) { return i.param.name; });
GTEST_ALLOW_UNINSTANTIATED_PARAMETERIZED_TEST(VoPortContract);

TEST(LcmContract, IsCheckedByMulticastToo) {
  const std::string reason = testing::multicast_missing();
  if (!reason.empty()) GTEST_SKIP() << reason;
  EXPECT_EQ(udp_cases().size(), 1U);
}

}  // namespace
}  // namespace overfly
