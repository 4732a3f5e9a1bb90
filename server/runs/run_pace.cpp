#include "server/runs/run_pace.hpp"

#include <algorithm>

namespace overfly::server {
namespace {

/// Frames come in bursts: a shorter time says little.
constexpr std::chrono::seconds kLeastTime{2};

}  // namespace

void RunPace::add(Time now, std::int64_t frames) {
  if (frames <= 0) return;  // worlds and flights are opened before the first frame
  marks_.push_back({now, frames});
  while (marks_.size() > 2 && marks_[1].at <= now - kWindow) marks_.pop_front();
}

std::optional<double> RunPace::left_s(std::int64_t frames_total) const {
  if (marks_.size() < 2 || frames_total <= 0) return std::nullopt;
  const Mark& first = marks_.front();
  const Mark& last = marks_.back();
  const double time_s = std::chrono::duration<double>(last.at - first.at).count();
  if (last.frames <= first.frames || last.at - first.at < kLeastTime) return std::nullopt;
  const auto left = static_cast<double>(std::max<std::int64_t>(frames_total - last.frames, 0));
  return left * time_s / static_cast<double>(last.frames - first.frames);
}

}  // namespace overfly::server
