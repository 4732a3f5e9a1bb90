// Finds a command's program.
#pragma once

#include <filesystem>
#include <string>

#include "core/result.hpp"

namespace overfly::process {

/// The absolute path of a program, found as by the shell: in $PATH if the name has no slash.
/// Errors: kNotFound if it does not exist; kInvalidArgument if it is not executable.
[[nodiscard]] Result<std::filesystem::path> find_program(const std::string& program);

}  // namespace overfly::process
