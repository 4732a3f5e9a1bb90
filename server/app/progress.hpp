// Progress display of long operations: a bar on a terminal, plain lines elsewhere.
#pragma once

#include <chrono>
#include <filesystem>
#include <string>

namespace overfly::app {

/// Writes to standard error, so that standard output contains only results.
class ProgressDisplay {
 public:
  /// @param file  gets {"share","text"}, also in quiet mode; empty = none
  explicit ProgressDisplay(bool quiet, std::filesystem::path file = {});
  ~ProgressDisplay();  ///< ends the bar's line
  ProgressDisplay(const ProgressDisplay&) = delete;
  ProgressDisplay& operator=(const ProgressDisplay&) = delete;

  /// @param share  done, in [0, 1]
  /// @param text  shown after the bar: "frame 120 of 3911, tracking"
  void show(double share, const std::string& text);
  /// For work whose end is not known. @param text  "frame 120"
  void show_so_far(const std::string& text);
  /// Prints a permanent line.
  void note(const std::string& text);
  /// Prints a permanent line, also in quiet mode.
  void warn(const std::string& text);

 private:
  void write_file(double share, const std::string& text);

  bool quiet_;
  bool terminal_;
  std::filesystem::path file_;
  std::chrono::steady_clock::time_point last_written_{};
  bool open_line_ = false;
  int last_tenth_ = -1;
  std::chrono::steady_clock::time_point last_shown_{};
};

}  // namespace overfly::app
