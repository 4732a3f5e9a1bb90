// Inside download only: HTTP requests with retries that respect the service's limits.
#pragma once

#include <atomic>
#include <chrono>
#include <functional>
#include <mutex>
#include <random>
#include <string>

#include "core/result.hpp"
#include "terrain/download.hpp"
#include "terrain/download/http_get.hpp"

namespace overfly::terrain::download {

/// The caller's verdict on an answer.
struct Verdict {
  enum class Kind { kGood, kAbsent, kTryAgain, kFailed };
  Kind kind = Kind::kGood;
  std::string reason;
};

/// Shared by all threads of a download. Temporary failures (no answer, 408, 429, 5xx, damaged
/// answers) are retried after a wait that doubles, with jitter. A wait requested by the service
/// delays all requests to it.
class PoliteFetcher {
 public:
  PoliteFetcher(const DownloadOptions& options, const std::atomic<bool>& stop)
      : options_(options), stop_(stop) {}

  using Judge = std::function<Verdict(const HttpReply&)>;
  /// The last answer and the verdict on it, kGood or kAbsent.
  struct Outcome {
    HttpReply reply;
    Verdict verdict;
  };
  /// @param judge  judges answers with status 200; also gets 204 and 404, which it may accept as
  ///               absent
  /// Errors: kIo naming the address, the last reason and the number of attempts; kCancelled.
  [[nodiscard]] Result<Outcome> get(const std::string& url, const Judge& judge);

  [[nodiscard]] int repeated() const { return repeated_.load(); }

 private:
  using Clock = std::chrono::steady_clock;
  [[nodiscard]] Verdict judged(const HttpReply& reply, const Judge& judge) const;
  /// Waits until the service accepts requests again. False if stopped.
  [[nodiscard]] bool wait_for_turn();
  [[nodiscard]] bool pause(double wait_s);
  [[nodiscard]] double back_off_s(int attempt);
  void hold_back(double wait_s);

  const DownloadOptions& options_;
  const std::atomic<bool>& stop_;
  std::atomic<int> repeated_{0};
  std::mutex mutex_;
  Clock::time_point not_before_{};
  // Spreads clients in time; does not affect the result
  std::minstd_rand jitter_{std::random_device{}()};
};

}  // namespace overfly::terrain::download
