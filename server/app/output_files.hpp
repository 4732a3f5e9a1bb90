// Files that a command is to write.
#pragma once

#include <initializer_list>
#include <string>
#include <vector>

#include "core/result.hpp"

namespace overfly::app {

/// Checks that a file that is to be written is not another one of the command, also by a different
/// name. Empty names are not given. Errors: kInvalidArgument naming both options.
[[nodiscard]] Status check_other_output(const std::string& option,
                                        const std::string& out,
                                        const std::string& other_option,
                                        const std::string& other);

/// A file and the option or argument that names it.
struct NamedFile {
  std::string option;
  std::string file;
};
/// Checks each file that is to be written against the other ones and those that are read. Errors:
/// as check_other_output.
[[nodiscard]] Status check_outputs(const std::vector<NamedFile>& written,
                                   const std::vector<NamedFile>& read);

/// What a command reads of the folder of a sweep.
[[nodiscard]] std::vector<NamedFile> files_of_sweep(const std::string& folder);

/// Checks that a file that is read is none of those that the command is to write into the folder of
/// --out. Errors: kInvalidArgument naming both.
/// @param option  of the file that is read
/// @param names   of the files that are written
[[nodiscard]] Status check_not_written(const std::string& option,
                                       const std::string& file,
                                       const std::string& folder,
                                       std::initializer_list<const char*> names);

}  // namespace overfly::app
