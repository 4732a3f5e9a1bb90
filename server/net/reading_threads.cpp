#include "server/net/reading_threads.hpp"

#include <boost/asio/post.hpp>
#include <utility>

namespace overfly::net {

bool ReadingThreads::take(std::function<void()> work, const Cancel& cancel) {
  if (waiting_.fetch_add(1) >= kMaxWaiting) {
    --waiting_;
    return false;
  }
  // Counts also where the work throws or is dropped.
  const std::shared_ptr<void> place(nullptr, [this](void*) { --waiting_; });
  {
    const std::lock_guard lock(mutex_);
    std::erase_if(cancels_, [](const auto& known) { return known.expired(); });
    cancels_.push_back(cancel);
  }
  boost::asio::post(threads_.loop(), [work = std::move(work), place] { work(); });
  return true;
}

void ReadingThreads::stop() {
  {
    const std::lock_guard lock(mutex_);
    for (const auto& known : cancels_) {
      if (const Cancel cancel = known.lock()) *cancel = true;
    }
  }
  threads_.stop();
}

}  // namespace overfly::net
