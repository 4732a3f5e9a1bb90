// What the tests of the process door share.
#pragma once

#include <gtest/gtest.h>
#include <sys/wait.h>

#include <cerrno>
#include <chrono>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "vo_bridges/process/process_estimator.hpp"

namespace overfly::testing {

/// The scripted estimator, with timeouts for a test.
inline ProcessEstimatorOptions scripted(const std::string& behaviour,
                                        const std::string& argument = "") {
  ProcessEstimatorOptions options;
  options.command = {OVERFLY_SCRIPTED_ESTIMATOR, behaviour, argument};
  options.start_timeout_s = 20.0;
  options.answer_timeout_s = 20.0;
  return options;
}

/// An estimator in Python: a class of the client library with these methods.
/// @param methods  lines, indented by four blanks
/// @param folder   where its file is written
[[nodiscard]] ProcessEstimatorOptions python_estimator(const std::string& methods,
                                                       const std::filesystem::path& folder);

/// The estimator, which must start.
inline std::unique_ptr<VoPort> started(const ProcessEstimatorOptions& options) {
  Result<std::unique_ptr<VoPort>> estimator = create_process_estimator(options);
  EXPECT_TRUE(estimator.ok()) << (estimator.ok() ? "" : estimator.error().message);
  return estimator.ok() ? std::move(estimator).value() : nullptr;
}

/// A picture of smooth spots without a period, as a flat ground shows them to a camera that looks
/// straight down, `moved` pixels to the right and down of where it began.
Image ground_image(int width_px, int height_px, double moved_x_px, double moved_y_px);

/// Frames over that ground, each `step_px` on.
std::vector<VoFrame> ground_frames(
    int count, double step_x_px, double step_y_px, int width_px = 160, int height_px = 120);

/// Whether a process is there and not a zombie.
[[nodiscard]] bool alive(int pid);
/// Waits until it is not, 5 s at most.
[[nodiscard]] bool gone_soon(int pid);

/// A processor that this process may use.
[[nodiscard]] int first_cpu();

/// No child is left: neither running nor waiting to be reaped.
class ChildrenTest : public ::testing::Test {
 protected:
  void TearDown() override {
    EXPECT_EQ(::waitpid(-1, nullptr, WNOHANG), -1) << "a child is left";
    EXPECT_EQ(errno, ECHILD);
  }

  static Error start_error(const ProcessEstimatorOptions& options) {
    const auto estimator = create_process_estimator(options);
    EXPECT_FALSE(estimator.ok());
    return estimator.ok() ? Error{} : estimator.error();
  }

  static double seconds_of(const std::function<void()>& work) {
    const auto begin = std::chrono::steady_clock::now();
    work();
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  }

  /// The lines of its log since the last call that contain `part`.
  static std::vector<std::string> lines_with(VoPort& estimator, const std::string& part) {
    std::vector<std::string> lines;
    for (const std::string& line : estimator.take_log()) {
      if (line.find(part) != std::string::npos) lines.push_back(line);
    }
    return lines;
  }
};

}  // namespace overfly::testing
