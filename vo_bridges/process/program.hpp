// Where a command's program is.
#pragma once

#include <filesystem>
#include <string>

#include "core/result.hpp"

namespace overfly::process {

/// The absolute path of a program: as the shell finds it, in $PATH where it has no slash.
/// Errors: kNotFound for one that is not there; kInvalidArgument for one that cannot be executed.
[[nodiscard]] Result<std::filesystem::path> find_program(const std::string& program);

}  // namespace overfly::process
