#include "vo_bridges/process/child/child_output.hpp"

#include <utility>

#include "vo_bridges/estimator_text.hpp"

namespace overfly::process {

namespace {

constexpr std::size_t kLastLines = 8;

}  // namespace

Status ChildOutput::open_file(const std::filesystem::path& file) {
  if (file.empty()) return {};
  const std::lock_guard lock(mutex_);
  file_.open(file, std::ios::binary | std::ios::trunc);
  if (!file_) return Error{ErrorCode::kIo, "cannot write output_file = " + file.string()};
  return {};
}

void ChildOutput::write_file(std::string_view bytes) {
  if (!file_.is_open() || file_bytes_ >= kFileLimitBytes) return;
  const std::string_view fits = bytes.substr(0, kFileLimitBytes - file_bytes_);
  file_ << fits;
  file_bytes_ += fits.size();
  if (file_bytes_ >= kFileLimitBytes) file_ << "\n(truncated at 64 MB)\n";
  file_.flush();
}

void ChildOutput::keep(std::string line) {
  last_.push_back(line);
  if (last_.size() > kLastLines) last_.pop_front();
  wait_for_taker(std::move(line));
}

void ChildOutput::wait_for_taker(std::string line) {
  waiting_.push_back(std::move(line));
  if (waiting_.size() > kWaitingLineLimit) {
    waiting_.pop_front();
    ++dropped_;
  }
}

void ChildOutput::end_line() {
  if (!partial_.empty() && partial_.back() == '\r') partial_.pop_back();
  if (std::string line = printable(partial_); !line.empty()) keep(std::move(line));
  partial_.clear();
}

void ChildOutput::add(std::string_view bytes) {
  const std::lock_guard lock(mutex_);
  write_file(bytes);
  for (const char byte : bytes) {
    if (byte != '\n') partial_ += byte;
    if (byte == '\n' || partial_.size() >= kLogLineLimitBytes) end_line();
  }
}

void ChildOutput::say(const std::string& line) {
  const std::lock_guard lock(mutex_);
  keep(line);
}

void ChildOutput::note(const std::string& line) {
  const std::lock_guard lock(mutex_);
  wait_for_taker(line);
}

void ChildOutput::close() {
  const std::lock_guard lock(mutex_);
  end_line();
  if (file_.is_open()) file_.flush();
  closed_ = true;
  closed_changed_.notify_all();
}

void ChildOutput::wait_closed(std::chrono::milliseconds patience) {
  std::unique_lock lock(mutex_);
  closed_changed_.wait_for(lock, patience, [this] { return closed_; });
}

std::vector<std::string> ChildOutput::take_lines() {
  const std::lock_guard lock(mutex_);
  std::vector<std::string> lines;
  if (dropped_ > 0) {
    lines.push_back(std::to_string(dropped_) + " earlier lines were dropped, too many to keep");
  }
  lines.insert(lines.end(), waiting_.begin(), waiting_.end());
  waiting_.clear();
  dropped_ = 0;
  return lines;
}

std::string ChildOutput::last_words() const {
  const std::lock_guard lock(mutex_);
  if (last_.empty()) return "; it printed nothing";
  std::string text;
  for (const std::string& line : last_) {
    text += (text.empty() ? "; its last output: " : " | ") + printable(line, 300);
  }
  return text;
}

}  // namespace overfly::process
