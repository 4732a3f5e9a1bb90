#include "flight/mavlink/link/frame_recorder.hpp"

#include <fcntl.h>

#include <cerrno>
#include <cstring>
#include <utility>

namespace overfly::flight::mavlink {
namespace {

constexpr std::size_t kWriteBytes = 16384;
constexpr std::chrono::milliseconds kLongestWait{500};
constexpr std::size_t kRecordedTimeBytes = 8;

}  // namespace

Result<std::shared_ptr<FrameRecorder>> FrameRecorder::create(const std::filesystem::path& file,
                                                             std::uint64_t most_bytes) {
  FileDescriptor descriptor(
      ::open(file.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_APPEND | O_CLOEXEC, 0644));
  if (!descriptor.open()) {
    return Error{ErrorCode::kIo, file.string() + ": cannot be created: " + std::strerror(errno)};
  }
  std::shared_ptr<FrameRecorder> recorder(
      new FrameRecorder(file, std::move(descriptor), most_bytes));
  recorder->flushed_ = std::chrono::steady_clock::now();
  return recorder;
}

FrameRecorder::~FrameRecorder() { flush(); }

void FrameRecorder::add(std::span<const std::uint8_t> frame,
                        std::chrono::system_clock::time_point received) {
  const std::lock_guard lock(mutex_);
  const std::uint64_t record = kRecordedTimeBytes + frame.size();
  if (!failure_.empty() || bytes_ + record > most_bytes_) {
    ++left_out_;
    return;
  }
  bytes_ += record;
  const auto us = static_cast<std::uint64_t>(
      std::chrono::duration_cast<std::chrono::microseconds>(received.time_since_epoch()).count());
  for (int shift = 56; shift >= 0; shift -= 8) {
    waiting_.push_back(static_cast<std::uint8_t>(us >> static_cast<unsigned>(shift)));
  }
  waiting_.insert(waiting_.end(), frame.begin(), frame.end());
  const auto now = std::chrono::steady_clock::now();
  if (waiting_.size() < kWriteBytes && now - flushed_ < kLongestWait) return;
  flushed_ = now;
  flush();
}

void FrameRecorder::flush() {
  std::size_t written = 0;
  while (written < waiting_.size()) {
    const ssize_t step =
        ::write(descriptor_.get(), waiting_.data() + written, waiting_.size() - written);
    if (step < 0 && errno == EINTR) continue;
    if (step <= 0) {
      failure_ = std::strerror(errno);
      break;
    }
    written += static_cast<std::size_t>(step);
  }
  waiting_.clear();
}

std::string FrameRecorder::problem() const {
  const std::lock_guard lock(mutex_);
  if (!failure_.empty()) {
    return file_.filename().string() + ": writing failed (" + failure_ +
           "): the recording of the vehicle's messages ends early";
  }
  if (left_out_ == 0) return "";
  return std::to_string(left_out_) +
         " messages of the vehicle were not recorded: " + file_.filename().string() +
         " has its largest size, " + std::to_string(most_bytes_ >> 20U) + " MiB";
}

}  // namespace overfly::flight::mavlink
