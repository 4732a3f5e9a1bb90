// fork and exec, and all that must be said between the two.
#pragma once

#include <filesystem>

#include "core/result.hpp"
#include "vo_bridges/process/child_process.hpp"

namespace overfly::process {

/// Starts `program` as a child of the calling thread, its stdout and stderr into `output`; it is
/// killed when that thread ends. Returns its process id, which is its process group's as well.
/// Errors: kInvalidArgument, kIo, naming what could not be done.
[[nodiscard]] Result<int> start_child(const std::filesystem::path& program,
                                      const ChildCommand& command,
                                      int output);

}  // namespace overfly::process
