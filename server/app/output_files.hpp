// Files that a command is to write.
#pragma once

#include <string>

#include "core/result.hpp"

namespace overfly::app {

/// Checks that a file that is to be written is not another one of the command, also by a different
/// name. Empty names are not given. Errors: kInvalidArgument naming both options.
[[nodiscard]] Status check_other_output(const std::string& option,
                                        const std::string& out,
                                        const std::string& other_option,
                                        const std::string& other);

}  // namespace overfly::app
