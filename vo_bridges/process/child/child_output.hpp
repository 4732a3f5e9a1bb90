// Collects an estimator's output: in a file, as lines for the run's log, and the last lines for
// errors.
#pragma once

#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <deque>
#include <filesystem>
#include <fstream>
#include <mutex>
#include <string>
#include <string_view>
#include <vector>

#include "core/result.hpp"

namespace overfly::process {

/// All storage is bounded, however much an estimator writes. Thread-safe.
class ChildOutput {
 public:
  static constexpr std::size_t kFileLimitBytes = 64'000'000;
  static constexpr std::size_t kWaitingLineLimit = 2000;

  /// Errors: kIo if the file cannot be opened. An empty path means no file.
  [[nodiscard]] Status open_file(const std::filesystem::path& file);

  /// Adds bytes from stdout or stderr.
  void add(std::string_view bytes);
  /// Adds a line received by the protocol.
  void say(const std::string& line);
  /// Adds a line from this program about the estimator; not part of the estimator's last output.
  void note(const std::string& line);
  /// Marks the end of the output.
  void close();
  /// Waits until the output ends, at most `patience`.
  void wait_closed(std::chrono::milliseconds patience);

  /// The lines since the last call. If lines were dropped, the first line gives their number.
  [[nodiscard]] std::vector<std::string> take_lines();
  /// "; its last output: ..." with the last lines, or a note that there was no output.
  [[nodiscard]] std::string last_words() const;

 private:
  void write_file(std::string_view bytes);
  void keep(std::string line);
  void wait_for_taker(std::string line);
  void end_line();

  mutable std::mutex mutex_;
  std::condition_variable closed_changed_;
  bool closed_ = false;
  std::ofstream file_;
  std::size_t file_bytes_ = 0;
  std::string partial_;  // a line without its line end
  std::deque<std::string> waiting_;
  std::size_t dropped_ = 0;
  std::deque<std::string> last_;
};

}  // namespace overfly::process
