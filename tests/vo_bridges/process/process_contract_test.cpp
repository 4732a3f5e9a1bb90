// The two examples behind the process door do what every estimator must, and find the way.
#include <gmock/gmock.h>

#include "core/measure/crc32.hpp"
#include "tests/support/support.hpp"
#include "tests/vo_bridges/process/process_fixture.hpp"
#include "tests/vo_bridges/vo_port_contract.hpp"

namespace overfly {
namespace {

using testing::ground_frames;
using testing::started;
using testing::VoPortCase;
using testing::VoPortContract;

ProcessEstimatorOptions cpp_example() {
  ProcessEstimatorOptions options;
  options.command = {OVERFLY_NADIR_EXAMPLE};
  return options;
}

ProcessEstimatorOptions python_example() {
  ProcessEstimatorOptions options;
  options.command = {testing::source_file("vo_bridges/examples/shift_odometry.py").string()};
  return options;
}

INSTANTIATE_TEST_SUITE_P(Process,
                         VoPortContract,
                         ::testing::Values(VoPortCase{"Cpp",
                                                      [] { return started(cpp_example()); },
                                                      [] { return ground_frames(6, 1.3, -0.7); },
                                                      6},
                                           VoPortCase{
                                               "Python",
                                               [] { return started(python_example()); },
                                               [] { return ground_frames(6, 1.3, -0.7, 64, 48); },
                                               6}),
                         [](const auto& instance) { return instance.param.name; });

/// The pose after the last frame, in pixels at the focal length of the frames.
Eigen::Vector3d last_position_px(const ProcessEstimatorOptions& options,
                                 const std::vector<VoFrame>& frames) {
  const auto estimator = started(options);
  if (!estimator) return Eigen::Vector3d::Zero();
  EstimateSample sample;
  for (const VoFrame& frame : frames) sample = estimator->track(frame).value().sample;
  EXPECT_EQ(sample.state, TrackingState::kTracking);
  return sample.T_vo_camera.translation * frames[0].intrinsics.fx_px;
}

TEST(ProcessExamples, FindTheWayOverFlatGround) {
  const std::vector<VoFrame> frames = ground_frames(11, 2.3, -1.1, 320, 240);
  const Eigen::Vector3d way_px(23.0, -11.0, 0.0);
  // Grey values are whole numbers: a tenth of a pixel over ten frames is what that leaves.
  EXPECT_LT((last_position_px(cpp_example(), frames) - way_px).norm(), 0.3);
  EXPECT_LT((last_position_px(python_example(), frames) - way_px).norm(), 1.0);
}

TEST(ProcessExamples, SeeEachImageWholeByEachTransport) {
  for (const char* const listen : {"", "tcp:127.0.0.1:0"}) {
    for (ProcessEstimatorOptions options : {cpp_example(), python_example()}) {
      options.listen = listen;
      const auto estimator = started(options);
      ASSERT_NE(estimator, nullptr);
      for (const VoFrame& frame : ground_frames(3, 1.0, 1.0)) {
        EXPECT_EQ(estimator->track(frame)->image_crc32, crc32_of(*frame.image))
            << options.command[0] << " " << listen;
      }
    }
  }
}

TEST(ProcessExamples, RefuseAParameterThatTheyDoNotKnow) {
  for (ProcessEstimatorOptions options : {cpp_example(), python_example()}) {
    options.parameters["nonsense"] = 3.0;
    const auto estimator = create_process_estimator(options);
    ASSERT_FALSE(estimator.ok());
    EXPECT_THAT(estimator.error().message, ::testing::HasSubstr("unknown parameter nonsense"));
  }
}

}  // namespace
}  // namespace overfly
