// What every estimator behind VoPort must do. Include in one file of a test program and add
//   INSTANTIATE_TEST_SUITE_P(Feature, VoPortContract, ::testing::Values(VoPortCase{...}));
#pragma once

#include <gtest/gtest.h>

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <ostream>
#include <string>
#include <vector>

#include "core/time.hpp"
#include "vo_bridges/vo_port.hpp"

namespace overfly::testing {

struct VoPortCase {
  std::string name;
  /// A new estimator, the same each time.
  std::function<std::unique_ptr<VoPort>()> create;
  /// Frames in order, index and time as the estimator shall get them; all of one size.
  std::function<std::vector<VoFrame>()> frames;
  /// How many of them it must track at least.
  int tracked_at_least = 1;
};

inline void PrintTo(const VoPortCase& contract_case, std::ostream* out) {
  *out << contract_case.name;
}

/// Grey frames of a pattern that moves sideways, for estimators that do not look at them.
inline std::vector<VoFrame> plain_frames(int count, int width_px = 64, int height_px = 48) {
  std::vector<VoFrame> frames;
  const auto intrinsics =
      PinholeCamera::from_fov(width_px, height_px, 1.48, FovAxis::kHorizontal).value();
  for (int i = 0; i < count; ++i) {
    Image image(width_px, height_px, 1);
    for (int y = 0; y < height_px; ++y) {
      for (int x = 0; x < width_px; ++x) {
        image.at(x, y) = static_cast<std::uint8_t>((x * 7 + y * 13 + i * 5) % 256);
      }
    }
    VoFrame frame;
    frame.index = i;
    frame.t_ns = frame_time_ns(i, FrameRate{});
    frame.image = std::make_shared<const Image>(std::move(image));
    frame.intrinsics = intrinsics;
    frames.push_back(std::move(frame));
  }
  return frames;
}

class VoPortContract : public ::testing::TestWithParam<VoPortCase> {
 protected:
  void SetUp() override {
    estimator_ = GetParam().create();
    ASSERT_NE(estimator_, nullptr);
    frames_ = GetParam().frames();
    ASSERT_GE(frames_.size(), 4U) << "the contract needs at least four frames";
  }

  static VoEstimate answer(VoPort& estimator, const VoFrame& frame) {
    Result<VoEstimate> estimate = estimator.track(frame);
    EXPECT_TRUE(estimate.ok()) << (estimate.ok() ? "" : estimate.error().message);
    return estimate.ok() ? std::move(estimate).value() : VoEstimate{};
  }

  std::vector<VoEstimate> answers(VoPort& estimator) const {
    std::vector<VoEstimate> estimates;
    for (const VoFrame& frame : frames_) estimates.push_back(answer(estimator, frame));
    return estimates;
  }

  /// The frame of an index with another image of the same or another size.
  static VoFrame with_image(const VoFrame& frame, int width_px, int height_px, int channels) {
    VoFrame changed = frame;
    changed.image = std::make_shared<const Image>(width_px, height_px, channels);
    changed.intrinsics.width_px = width_px;
    changed.intrinsics.height_px = height_px;
    return changed;
  }

  void expect_refused(const VoFrame& frame) {
    const Result<VoEstimate> estimate = estimator_->track(frame);
    ASSERT_FALSE(estimate.ok());
    EXPECT_EQ(estimate.error().code, ErrorCode::kInvalidArgument);
    EXPECT_NE(estimate.error().message.find(std::to_string(frame.index)), std::string::npos)
        << "names the frame: " << estimate.error().message;
  }

  static void expect_same(const VoEstimate& a, const VoEstimate& b) {
    EXPECT_EQ(a.sample.frame, b.sample.frame);
    EXPECT_EQ(a.sample.t_ns, b.sample.t_ns);
    EXPECT_EQ(a.sample.state, b.sample.state);
    EXPECT_EQ(a.sample.map_id, b.sample.map_id);
    EXPECT_EQ(a.sample.scene_depth, b.sample.scene_depth);
    EXPECT_EQ(a.sample.T_vo_camera.translation, b.sample.T_vo_camera.translation);
    EXPECT_EQ(a.sample.T_vo_camera.rotation.coeffs(), b.sample.T_vo_camera.rotation.coeffs());
    EXPECT_EQ(a.map_points_vo, b.map_points_vo);
    EXPECT_EQ(a.counters, b.counters);
  }

  std::unique_ptr<VoPort> estimator_;
  std::vector<VoFrame> frames_;
};

TEST_P(VoPortContract, SaysWhatItIs) {
  EXPECT_FALSE(estimator_->type().empty());
  EXPECT_EQ(estimator_->type(), GetParam().create()->type());
  EXPECT_EQ(estimator_->effective_parameters(), GetParam().create()->effective_parameters());
}

TEST_P(VoPortContract, AnswersEachFrameWithItsIndexAndTime) {
  for (const VoFrame& frame : frames_) {
    const EstimateSample sample = answer(*estimator_, frame).sample;
    ASSERT_EQ(sample.frame, frame.index);
    ASSERT_EQ(sample.t_ns, frame.t_ns);
  }
}

TEST_P(VoPortContract, AnswersTheSameWhenItWasPrepared) {
  VoFrame first = frames_[0];
  first.image = nullptr;
  const Status ready = estimator_->prepare(first);
  ASSERT_TRUE(ready.ok()) << ready.error().message;
  const std::unique_ptr<VoPort> unprepared = GetParam().create();
  for (const VoFrame& frame : frames_) {
    expect_same(answer(*estimator_, frame), answer(*unprepared, frame));
  }
}

TEST_P(VoPortContract, TakesGapsOfDroppedFrames) {
  answer(*estimator_, frames_[0]);
  const EstimateSample sample = answer(*estimator_, frames_[3]).sample;
  EXPECT_EQ(sample.frame, frames_[3].index);
  EXPECT_EQ(sample.t_ns, frames_[3].t_ns);
}

TEST_P(VoPortContract, TracksWithSoundPoses) {
  int tracked = 0;
  int map_id = 0;
  for (const VoEstimate& estimate : answers(*estimator_)) {
    EXPECT_GE(estimate.sample.map_id, map_id);
    map_id = estimate.sample.map_id;
    if (estimate.sample.state != TrackingState::kTracking) continue;
    ++tracked;
    EXPECT_TRUE(estimate.sample.T_vo_camera.matrix().allFinite());
    EXPECT_NEAR(estimate.sample.T_vo_camera.rotation.norm(), 1.0, 1e-9);
    if (estimate.sample.scene_depth) {
      EXPECT_GT(*estimate.sample.scene_depth, 0.0);
    }
  }
  EXPECT_GE(tracked, GetParam().tracked_at_least);
}

TEST_P(VoPortContract, RefusesAnEmptyImage) {
  VoFrame frame = frames_[0];
  frame.image = nullptr;
  expect_refused(frame);
  frame.image = std::make_shared<const Image>();
  expect_refused(frame);
}

TEST_P(VoPortContract, RefusesAColourImage) {
  const Image& image = *frames_[0].image;
  expect_refused(with_image(frames_[0], image.width_px, image.height_px, 3));
}

TEST_P(VoPortContract, RefusesAnImageThatIsNotOfItsIntrinsics) {
  const Image& image = *frames_[0].image;
  VoFrame frame = with_image(frames_[0], image.width_px - 2, image.height_px, 1);
  frame.intrinsics = frames_[0].intrinsics;
  expect_refused(frame);
}

TEST_P(VoPortContract, RefusesAChangedSize) {
  answer(*estimator_, frames_[0]);
  const Image& image = *frames_[1].image;
  expect_refused(with_image(frames_[1], image.width_px / 2, image.height_px / 2, 1));
}

TEST_P(VoPortContract, RefusesChangedIntrinsics) {
  answer(*estimator_, frames_[0]);
  VoFrame zoomed = frames_[1];
  zoomed.intrinsics.fx_px *= 1.01;
  expect_refused(zoomed);
}

TEST_P(VoPortContract, RefusesFramesOutOfOrder) {
  answer(*estimator_, frames_[0]);
  answer(*estimator_, frames_[2]);
  expect_refused(frames_[2]);
  expect_refused(frames_[1]);
  VoFrame earlier = frames_[3];
  earlier.t_ns = frames_[2].t_ns;
  expect_refused(earlier);
}

TEST_P(VoPortContract, ForgetsARefusedFrame) {
  const std::vector<VoEstimate> undisturbed = answers(*GetParam().create());
  for (std::size_t i = 0; i < frames_.size(); ++i) {
    if (i == 2) {
      const Image& image = *frames_[i].image;
      expect_refused(with_image(frames_[i], image.width_px, image.height_px, 3));
      expect_refused(frames_[0]);
    }
    expect_same(answer(*estimator_, frames_[i]), undisturbed[i]);
  }
}

TEST_P(VoPortContract, AnswersTheSameEachTime) {
  const std::unique_ptr<VoPort> other = GetParam().create();
  for (const VoFrame& frame : frames_) {
    expect_same(answer(*estimator_, frame), answer(*other, frame));
  }
}

TEST_P(VoPortContract, MakesDebugImagesOnlyWhenAsked) {
  const VoEstimate quiet = answer(*estimator_, frames_[0]);
  EXPECT_FALSE(quiet.debug_image.has_value());
  EXPECT_TRUE(quiet.map_points_vo.empty());
  estimator_->set_debug(true);
  const VoEstimate debugged = answer(*estimator_, frames_[1]);
  ASSERT_TRUE(debugged.debug_image.has_value());
  EXPECT_EQ(debugged.debug_image->channels, 3);
  EXPECT_FALSE(debugged.debug_image->empty());
  EXPECT_LE(debugged.debug_image->width_px, frames_[1].image->width_px);
  EXPECT_LE(debugged.debug_image->height_px, frames_[1].image->height_px);
  estimator_->set_debug(false);
  EXPECT_FALSE(answer(*estimator_, frames_[2]).debug_image.has_value());
}

TEST_P(VoPortContract, EstimatesTheSameWithDebugAsWithout) {
  const std::unique_ptr<VoPort> debugged = GetParam().create();
  debugged->set_debug(true);
  for (const VoFrame& frame : frames_) {
    const EstimateSample a = answer(*estimator_, frame).sample;
    const EstimateSample b = answer(*debugged, frame).sample;
    EXPECT_EQ(a.state, b.state);
    EXPECT_EQ(a.T_vo_camera.matrix(), b.T_vo_camera.matrix());
  }
}

TEST_P(VoPortContract, LeavesTheImageAsItIs) {
  const Image before = *frames_[0].image;
  estimator_->set_debug(true);
  answer(*estimator_, frames_[0]);
  answer(*estimator_, frames_[1]);
  EXPECT_EQ(frames_[0].image->data, before.data);
}

}  // namespace overfly::testing
