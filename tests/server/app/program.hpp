// The program as a child process.
#pragma once

#include <sys/types.h>

#include <filesystem>
#include <string>
#include <vector>

namespace overfly::testing {

struct Outcome {
  int exit_code = -1;  ///< -1 = ended by a signal
  std::string out;
  std::string err;
};

/// Runs the program to its end.
/// @param out  where standard output goes instead of Outcome::out; empty = nowhere else
[[nodiscard]] Outcome overfly_program(const std::vector<std::string>& arguments,
                                      const std::filesystem::path& out = {});

/// The running program; killed with the object.
class RunningProgram {
 public:
  /// Standard output and error go to files in `folder`.
  /// @param out  where standard output goes instead; empty = nowhere else
  RunningProgram(const std::vector<std::string>& arguments,
                 const std::filesystem::path& folder,
                 const std::filesystem::path& out = {});
  ~RunningProgram();
  RunningProgram(const RunningProgram&) = delete;
  RunningProgram& operator=(const RunningProgram&) = delete;

  void signal(int number) const;
  /// Waits for its end. @return exit code, or -1 when a signal ended it
  int wait();
  [[nodiscard]] bool running();
  [[nodiscard]] std::string out() const;
  [[nodiscard]] std::string err() const;

 private:
  pid_t pid_ = -1;
  int status_ = 0;
  std::filesystem::path folder_;
};

}  // namespace overfly::testing
