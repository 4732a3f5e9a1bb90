#include "terrain/download/polite_fetcher.hpp"

#include <algorithm>
#include <cmath>
#include <thread>

namespace overfly::terrain::download {

Verdict PoliteFetcher::judged(const HttpReply& reply, const Judge& judge) const {
  if (!reply.error.empty()) return {Verdict::Kind::kTryAgain, reply.error};
  const int status = reply.status;
  if (status == 408 || status == 425 || status == 429 || status >= 500) {
    return {Verdict::Kind::kTryAgain, "HTTP status " + std::to_string(status)};
  }
  if (status == 200 || status == 204 || status == 404) return judge(reply);
  return {Verdict::Kind::kFailed, "HTTP status " + std::to_string(status)};
}

Result<PoliteFetcher::Outcome> PoliteFetcher::get(const std::string& url, const Judge& judge) {
  for (int attempt = 1;; ++attempt) {
    if (!wait_for_turn()) return Error{ErrorCode::kCancelled, "the download was cancelled"};
    HttpReply reply = http_get(url, options_.stall_s, stop_);
    if (stop_.load()) return Error{ErrorCode::kCancelled, "the download was cancelled"};
    Verdict verdict = judged(reply, judge);
    if (verdict.kind == Verdict::Kind::kGood || verdict.kind == Verdict::Kind::kAbsent) {
      return Outcome{std::move(reply), std::move(verdict)};
    }
    if (verdict.kind == Verdict::Kind::kFailed) {
      return Error{ErrorCode::kIo, url + ": " + verdict.reason};
    }
    if (attempt >= options_.attempts) {
      return Error{ErrorCode::kIo,
                   url + ": " + verdict.reason + " (attempt " + std::to_string(attempt) + " of " +
                       std::to_string(options_.attempts) + ")"};
    }
    const double asked_s = reply.retry_after_s.value_or(0.0);
    if (asked_s > options_.longest_wait_s) {
      return Error{ErrorCode::kIo,
                   url + ": " + verdict.reason + "; the service requests a wait of " +
                       std::to_string(std::lround(asked_s)) + " s, limit " +
                       std::to_string(std::lround(options_.longest_wait_s)) +
                       " s. Resume later; downloaded chunks are kept"};
    }
    ++repeated_;
    if (asked_s > 0.0) hold_back(asked_s);
    if (!pause(back_off_s(attempt))) {
      return Error{ErrorCode::kCancelled, "the download was cancelled"};
    }
  }
}

double PoliteFetcher::back_off_s(int attempt) {
  constexpr double kLongestS = 60.0;
  const std::lock_guard lock(mutex_);
  const double jitter = std::uniform_real_distribution<double>(0.5, 1.5)(jitter_);
  return std::min(kLongestS, options_.first_wait_s * std::ldexp(1.0, attempt - 1)) * jitter;
}

void PoliteFetcher::hold_back(double wait_s) {
  const auto until = Clock::now() + std::chrono::duration_cast<Clock::duration>(
                                        std::chrono::duration<double>(wait_s));
  const std::lock_guard lock(mutex_);
  not_before_ = std::max(not_before_, until);
}

bool PoliteFetcher::wait_for_turn() {
  for (;;) {
    Clock::time_point until;
    {
      const std::lock_guard lock(mutex_);
      until = not_before_;
    }
    const auto now = Clock::now();
    if (until <= now) return !stop_.load();
    if (!pause(std::chrono::duration<double>(until - now).count())) return false;
  }
}

bool PoliteFetcher::pause(double wait_s) {
  const auto until = Clock::now() + std::chrono::duration_cast<Clock::duration>(
                                        std::chrono::duration<double>(wait_s));
  constexpr auto kLook = std::chrono::milliseconds(100);
  while (!stop_.load()) {
    const auto now = Clock::now();
    if (now >= until) return true;
    std::this_thread::sleep_for(std::min<Clock::duration>(kLook, until - now));
  }
  return false;
}

}  // namespace overfly::terrain::download
