// Starts a child process with fork and exec.
#pragma once

#include <filesystem>

#include "core/result.hpp"
#include "vo_bridges/process/child/child_command.hpp"

namespace overfly::process {

/// Starts `program` as a child of the calling thread, with stdout and stderr redirected to
/// `output`. The child is killed when that thread ends. Returns its process id, which is also its
/// process group id.
/// Errors: kInvalidArgument, kIo, naming the step that failed.
[[nodiscard]] Result<int> start_child(const std::filesystem::path& program,
                                      const ChildCommand& command,
                                      int output);

}  // namespace overfly::process
