// Calls that wait, and the wish to stop.
#pragma once

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <future>

#include "core/result.hpp"

namespace overfly::testing {

/// The doors promise to end within 50 ms; a busy machine needs more.
inline constexpr double kCancelledSoonS = 1.5;
/// An answer may still come for a second.
inline constexpr double kAnswerCancelledSoonS = 1.0 + kCancelledSoonS;

template <typename Outcome>
struct Cancelled {
  Outcome outcome;
  double after_s;  ///< since it was asked to stop
};

/// Asks a call to stop a moment after it began to wait. @param call  returns a Result or a Status
template <typename Call>
auto cancelled(std::atomic<bool>& cancel, Call call) {
  using Clock = std::chrono::steady_clock;
  auto waiting = std::async(std::launch::async, call);
  EXPECT_EQ(waiting.wait_for(std::chrono::milliseconds(300)), std::future_status::timeout)
      << "it did not wait";
  const auto asked = Clock::now();
  cancel = true;
  auto outcome = waiting.get();
  return Cancelled<decltype(outcome)>{std::move(outcome),
                                      std::chrono::duration<double>(Clock::now() - asked).count()};
}

/// As above of a call that then ends with kCancelled, and how.
template <typename Call>
Error expect_cancelled_within(double limit_s, std::atomic<bool>& cancel, Call call) {
  const auto ended = cancelled(cancel, call);
  EXPECT_LT(ended.after_s, limit_s);
  EXPECT_FALSE(ended.outcome.ok());
  if (ended.outcome.ok()) return {};
  EXPECT_EQ(ended.outcome.error().code, ErrorCode::kCancelled) << ended.outcome.error().message;
  return ended.outcome.error();
}

}  // namespace overfly::testing
