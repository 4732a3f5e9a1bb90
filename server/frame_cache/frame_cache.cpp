#include "server/frame_cache/frame_cache.hpp"

#include <exception>
#include <new>
#include <system_error>
#include <utility>

#include "server/timing/thread_priority.hpp"

namespace overfly::server {
namespace {

/// Limit of the memory of pictures that wait to be written; a larger picture is not added.
constexpr std::size_t kQueueBytes = std::size_t{32} << 20U;

std::size_t picture_bytes(const renderer::CameraFrame& frame) {
  return frame.image.data.size() + frame.radiance.data.size() * sizeof(float);
}

std::size_t largest_file_bytes(const renderer::CameraRequest& request) {
  const PinholeCamera& pinhole = request.camera.pinhole();
  const std::size_t samples = static_cast<std::size_t>(pinhole.width_px) * pinhole.height_px *
                              renderer::channel_count(request.format);
  return largest_encoded_bytes(samples, renderer::is_linear(request.format) ? sizeof(float) : 1);
}

}  // namespace

nlohmann::json json_from(const FrameCacheUse& use) {
  nlohmann::json document = {{"read", use.read},
                             {"rendered", use.rendered},
                             {"added", use.added},
                             {"passed_over", use.passed_over},
                             {"damaged", use.damaged}};
  if (!use.problem.empty()) document["problem"] = use.problem;
  return document;
}

FrameCache::FrameCache(FrameFolderOptions options, std::function<void(const std::string&)> warn)
    : folder_(options), warn_(std::move(warn)), adds_(options.budget_bytes > 0) {
  if (!adds_) return;
  if (const Status created = folder_.create(); !created) {
    end_adding(created.error());
    report();
    return;
  }
  try {
    thread_ = std::thread([this] { write_pictures(); });
  } catch (const std::system_error& refused) {
    end_adding({ErrorCode::kInternal, std::string("no thread: ") + refused.what()});
    report();
  }
}

FrameCache::~FrameCache() { finish(); }

void FrameCache::finish() {
  {
    const std::lock_guard lock(mutex_);
    finished_ = true;
  }
  changed_.notify_all();
  if (thread_.joinable()) thread_.join();
  report();
}

FrameCacheUse FrameCache::use() const {
  const std::lock_guard lock(mutex_);
  return use_;
}

std::optional<renderer::CameraFrame> FrameCache::find(const std::string& key,
                                                      const renderer::CameraRequest& request) {
  const auto bytes = folder_.read(key, largest_file_bytes(request));
  Result<renderer::CameraFrame> frame = Error{};
  Status fault;
  if (!bytes) {
    fault = bytes.error();
  } else if (*bytes) {
    frame = reading_.decode(**bytes, request);
    if (!frame) fault = frame.error().in(folder_.file_of(key).string());
  }
  if (!fault && fault.error().code == ErrorCode::kUnreadable) folder_.remove(key);
  {
    const std::lock_guard lock(mutex_);
    ++(frame ? use_.read : use_.rendered);
    if (!fault && use_.damaged++ == 0) {
      note_problem(fault.error().message, "such pictures are rendered again");
    }
  }
  report();
  if (!frame) return std::nullopt;
  return std::move(*frame);
}

void FrameCache::add(const std::string& key, const renderer::CameraFrame& frame) {
  const std::size_t bytes = picture_bytes(frame);
  {
    const std::lock_guard lock(mutex_);
    if (!adds_) return;
    if (queued_bytes_ + bytes > kQueueBytes) {
      ++use_.passed_over;
      return;
    }
    queued_bytes_ += bytes;
  }
  try {
    Waiting waiting{key, frame, bytes};
    const std::lock_guard lock(mutex_);
    queue_.push_back(std::move(waiting));
  } catch (const std::bad_alloc&) {
    const std::lock_guard lock(mutex_);
    queued_bytes_ -= bytes;
    ++use_.passed_over;
  }
  changed_.notify_all();
}

void FrameCache::note_problem(const std::string& text, const std::string& consequence) {
  if (use_.problem.empty()) use_.problem = text;
  unreported_.push_back("frame cache: " + text + "; " + consequence);
}

void FrameCache::end_adding(const Error& error) {
  adds_ = false;
  note_problem(error.message, "no more pictures are added");
}

void FrameCache::report() {
  std::deque<std::string> lines;
  {
    const std::lock_guard lock(mutex_);
    lines = std::exchange(unreported_, {});
  }
  if (!warn_) return;
  for (const std::string& line : lines) warn_(line);
}

void FrameCache::write_pictures() {
  lower_thread(ThreadPriority::kBelowFlights);
  FrameCodec codec;
  std::unique_lock lock(mutex_);
  for (;;) {
    changed_.wait(lock, [&] { return finished_ || !queue_.empty(); });
    if (queue_.empty()) return;
    const Waiting waiting = std::move(queue_.front());
    queue_.pop_front();
    if (!adds_) continue;
    lock.unlock();
    Result<FrameFolder::Added> added = FrameFolder::Added::kKnown;
    try {
      if (!folder_.is_known(waiting.key)) {
        added = folder_.add(waiting.key, codec.encode(waiting.frame));
      }
    } catch (const std::exception& exception) {
      added = Error{ErrorCode::kInternal, exception.what()};
    }
    lock.lock();
    queued_bytes_ -= waiting.bytes;
    if (!added) {
      end_adding(added.error());
    } else if (*added == FrameFolder::Added::kAdded) {
      ++use_.added;
    } else if (*added != FrameFolder::Added::kKnown) {
      ++use_.passed_over;
    }
  }
}

}  // namespace overfly::server
