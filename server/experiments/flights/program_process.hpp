// A program as a process of its own, which ends with the thread that started it.
#pragma once

#include <sys/types.h>

#include <filesystem>
#include <string>
#include <vector>

#include "core/result.hpp"

namespace overfly::server::experiments {

/// Starts a program. The process is killed with the calling thread, gets no signals of its
/// terminal, and inherits no open file.
/// @param words  file of the program, and its arguments
/// @param output  file for what it prints, replaced
/// Errors: kIo; kInternal with the system's reason.
[[nodiscard]] Result<pid_t> start_program(std::vector<std::string> words,
                                          const std::filesystem::path& output);

/// "exit code 1", "signal 9 (Killed)"; empty for exit code 0. @param status  of waitpid
[[nodiscard]] std::string end_reason(int status);

}  // namespace overfly::server::experiments
