// Decides which files of this machine a scenario, an override or a world manifest may name.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/result.hpp"

namespace overfly {

/// Checks every file that is named from outside before anything opens it.
///
/// On the command line any regular file is allowed, because the user can read it anyway. A server
/// allows its clients only files inside its data folders. It returns the same error for all other
/// files, so that clients cannot find out which files exist on the machine.
class SourcePolicy {
 public:
  /// Allows any regular file. For the command line.
  SourcePolicy() = default;
  /// Allows only regular files inside `folders` and outside `excluded`. Both lists apply as given
  /// and with their links resolved. A folder that does not exist contains nothing.
  static SourcePolicy inside(std::vector<std::filesystem::path> folders,
                             std::vector<std::filesystem::path> excluded = {});

  /// False if any regular file is allowed.
  [[nodiscard]] bool confined() const { return confined_; }

  /// Checks that a file may be named: it lies in a data folder both as named and with all links
  /// resolved, is a regular file, and does not belong to a file system of the kernel (/proc, /sys).
  /// @param file   must not contain `..` if the policy is confined: normalise it lexically first
  /// @param field  the field that names the file, e.g. "world.imagery.0.file"
  /// Errors: kInvalidArgument "FIELD = FILE: must ...", with identical text for every file outside
  /// the data folders, whether it exists or not; kNotFound inside them.
  [[nodiscard]] Status check(const std::filesystem::path& file, const std::string& field) const;
  /// Checks only that the path lies in a data folder; the file may be of any kind or not exist.
  [[nodiscard]] Status check_place(const std::filesystem::path& file,
                                   const std::string& field) const;

 private:
  [[nodiscard]] bool holds(const std::filesystem::path& plain) const;

  bool confined_ = false;
  std::vector<std::filesystem::path> folders_;
  std::vector<std::filesystem::path> excluded_;
};

}  // namespace overfly
