// Runs an adapter, built against its stand-in, behind the process door.
#pragma once

#include <gtest/gtest.h>

#include <cstdint>
#include <cstdlib>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/time.hpp"
#include "tests/vo_bridges/standins/flown_path.hpp"
#include "vo_bridges/process/process_estimator.hpp"

namespace overfly::testing {

inline constexpr int kWidthPx = 320;
inline constexpr int kHeightPx = 240;
inline constexpr int kPlain = 100;  ///< first pixel of a frame without orders

/// An environment variable while it lives.
class Environment {
 public:
  explicit Environment(std::string name, const std::string& value = "1") : name_(std::move(name)) {
    if (const char* const before = std::getenv(name_.c_str())) before_ = before;
    ::setenv(name_.c_str(), value.c_str(), 1);
  }
  ~Environment() {
    if (before_) {
      ::setenv(name_.c_str(), before_->c_str(), 1);
    } else {
      ::unsetenv(name_.c_str());
    }
  }
  Environment(const Environment&) = delete;
  Environment& operator=(const Environment&) = delete;

 private:
  std::string name_;
  std::optional<std::string> before_;
};

inline Result<std::unique_ptr<VoPort>> start_adapter(const std::string& name,
                                                     VoParameters parameters = {},
                                                     bool lockstep = true) {
  ProcessEstimatorOptions options;
  options.command = {std::string(STANDIN_PROGRAMS) + "/standin-" + name};
  options.parameters = std::move(parameters);
  options.lockstep = lockstep;
  return create_process_estimator(options);
}

/// A frame whose first pixel gives an order to the stand-in.
inline VoFrame ordered_frame(std::int64_t index, int order = kPlain) {
  Image image(kWidthPx, kHeightPx, 1);
  for (std::size_t i = 0; i < image.data.size(); ++i) {
    image.data[i] = static_cast<std::uint8_t>((7 * i + static_cast<std::size_t>(index)) % 200);
  }
  image.at(0, 0) = static_cast<std::uint8_t>(order);
  VoFrame frame;
  frame.index = index;
  frame.t_ns = frame_time_ns(index, FrameRate{});
  frame.image = std::make_shared<const Image>(std::move(image));
  frame.intrinsics =
      PinholeCamera::from_fov(kWidthPx, kHeightPx, 1.48, FovAxis::kHorizontal).value();
  return frame;
}

/// Answers of one run; a frame for each order.
class AdapterRun {
 public:
  explicit AdapterRun(const std::string& name, VoParameters parameters = {}, bool lockstep = true) {
    auto started = start_adapter(name, std::move(parameters), lockstep);
    EXPECT_TRUE(started.ok()) << (started.ok() ? "" : started.error().message);
    if (started.ok()) port_ = std::move(started).value();
  }

  VoEstimate track(int order = kPlain) {
    Result<VoEstimate> answer = port_->track(ordered_frame(next_++, order));
    EXPECT_TRUE(answer.ok()) << (answer.ok() ? "" : answer.error().message);
    return answer.ok() ? std::move(answer).value() : VoEstimate{};
  }
  /// The last of so many plain frames.
  VoEstimate track_plain(int count) {
    VoEstimate last;
    for (int i = 0; i < count; ++i) last = track();
    return last;
  }
  Result<VoEstimate> try_track(int order) { return port_->track(ordered_frame(next_++, order)); }
  VoPort& port() { return *port_; }

 private:
  std::unique_ptr<VoPort> port_;
  std::int64_t next_ = 0;
};

/// What an adapter says before its first frame is answered: at the start, or with the camera.
inline std::string refusal(const std::string& name, VoParameters parameters) {
  auto started = start_adapter(name, std::move(parameters));
  if (!started.ok()) return started.error().message;
  const Result<VoEstimate> answer = started.value()->track(ordered_frame(0));
  if (answer.ok()) return "(it was taken)";
  std::string said = answer.error().message;
  for (const std::string& line : started.value()->take_log()) said += "\n" + line;
  return said;
}

}  // namespace overfly::testing
