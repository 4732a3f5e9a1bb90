// What an estimator said: in a file, in lines for the run's log, and the last ones for errors.
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

/// Bounded in everything, whatever an estimator pours into it. All methods from any thread.
class ChildOutput {
 public:
  static constexpr std::size_t kFileLimitBytes = 64'000'000;
  static constexpr std::size_t kWaitingLineLimit = 2000;

  /// Errors: kIo if the file cannot be opened. An empty path = no file.
  [[nodiscard]] Status open_file(const std::filesystem::path& file);

  /// Bytes of its stdout and stderr.
  void add(std::string_view bytes);
  /// A line that came by the protocol.
  void say(const std::string& line);
  /// A line of ours about it: no word of its own.
  void note(const std::string& line);
  /// No more bytes will come.
  void close();
  /// Waits until no more bytes will come, or the time is over.
  void wait_closed(std::chrono::milliseconds patience);

  /// The lines since the last call; where more came than are kept, the first says how many.
  [[nodiscard]] std::vector<std::string> take_lines();
  /// "; it last said: ..." with its last lines, or that it said nothing.
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
  std::string partial_;  // a line without its end
  std::deque<std::string> waiting_;
  std::size_t dropped_ = 0;
  std::deque<std::string> last_;
};

}  // namespace overfly::process
