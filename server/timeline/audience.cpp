#include "server/timeline/audience.hpp"

#include <algorithm>
#include <utility>

namespace overfly::server {
namespace {

using Clock = std::chrono::steady_clock;

double seconds_of(Clock::time_point time) {
  return std::chrono::duration<double>(time.time_since_epoch()).count();
}

}  // namespace

Audience::Seat::Seat(std::shared_ptr<Audience> audience)
    : audience_(std::move(audience)), since_(Clock::now()) {
  const std::lock_guard lock(audience_->mutex_);
  ++audience_->came_;
  ++audience_->seated_;
  audience_->most_ = std::max(audience_->most_, audience_->seated_);
  audience_->seated_since_sum_s_ += seconds_of(since_);
}

Audience::Seat::~Seat() {
  const std::lock_guard lock(audience_->mutex_);
  --audience_->seated_;
  audience_->seated_since_sum_s_ -= seconds_of(since_);
  audience_->left_viewer_s_ += seconds_of(Clock::now()) - seconds_of(since_);
}

void Audience::picture_made(Kind kind, double cpu_s) {
  const std::lock_guard lock(mutex_);
  ++pictures_[static_cast<std::size_t>(kind)];
  cpu_s_ += cpu_s;
}

nlohmann::json Audience::summary() const {
  const std::lock_guard lock(mutex_);
  const double staying_s = seated_ * seconds_of(Clock::now()) - seated_since_sum_s_;
  return {{"viewers", came_},
          {"most_at_once", most_},
          {"viewer_s", left_viewer_s_ + (seated_ > 0 ? staying_s : 0.0)},
          {"pictures",
           {{"camera", pictures_[0]},
            {"debug", pictures_[1]},
            {"scene", pictures_[2]},
            {"depth", pictures_[3]},
            {"error", pictures_[4]}}},
          {"cpu_s", cpu_s_}};
}

}  // namespace overfly::server
