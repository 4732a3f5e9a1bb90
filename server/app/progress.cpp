#include "server/app/progress.hpp"

#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <iostream>
#include <utility>

#include "server/files/whole_file.hpp"

namespace overfly::app {

ProgressDisplay::ProgressDisplay(bool quiet, std::filesystem::path file)
    : quiet_(quiet), terminal_(isatty(STDERR_FILENO) == 1), file_(std::move(file)) {}

ProgressDisplay::~ProgressDisplay() {
  if (open_line_) std::cerr << "\n";
}

void ProgressDisplay::write_file(double share, const std::string& text) {
  const auto now = std::chrono::steady_clock::now();
  if (share < 1.0 && now - last_written_ < std::chrono::milliseconds(200)) return;
  last_written_ = now;
  // The work goes on without it: who reads the file sees that it stands still.
  (void)server::write_json(file_, {{"share", share}, {"text", text}});
}

void ProgressDisplay::show(double share, const std::string& text) {
  const double done = std::clamp(share, 0.0, 1.0);
  if (!file_.empty()) write_file(done, text);
  if (quiet_) return;
  const int percent = static_cast<int>(std::floor(100.0 * done));
  if (!terminal_) {
    // One line for each tenth keeps a log short.
    if (percent / 10 == last_tenth_) return;
    last_tenth_ = percent / 10;
    std::cerr << percent << " % " << text << "\n";
    return;
  }
  const auto now = std::chrono::steady_clock::now();
  if (done < 1.0 && now - last_shown_ < std::chrono::milliseconds(100)) return;
  last_shown_ = now;
  constexpr int kWidth = 30;
  const int filled = static_cast<int>(done * kWidth);
  std::cerr << "\r[" << std::string(static_cast<std::size_t>(filled), '#')
            << std::string(static_cast<std::size_t>(kWidth - filled), '.') << "] " << percent
            << " % " << text << "\033[K" << std::flush;
  open_line_ = true;
}

void ProgressDisplay::show_so_far(const std::string& text) {
  if (quiet_) return;
  const auto now = std::chrono::steady_clock::now();
  // A line every ten seconds keeps a log short.
  const auto period = terminal_ ? std::chrono::milliseconds(100) : std::chrono::milliseconds(10000);
  if (now - last_shown_ < period) return;
  last_shown_ = now;
  if (!terminal_) {
    std::cerr << text << "\n";
    return;
  }
  std::cerr << "\r" << text << "\033[K" << std::flush;
  open_line_ = true;
}

void ProgressDisplay::note(const std::string& text) {
  if (!quiet_) warn(text);
}

void ProgressDisplay::warn(const std::string& text) {
  if (open_line_) std::cerr << "\n";
  open_line_ = false;
  std::cerr << text << "\n";
}

}  // namespace overfly::app
