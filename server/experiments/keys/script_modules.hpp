// The Python modules that decide what a script does.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace overfly::server::experiments {

/// Of each script that a command names (a file that ends in .py or begins with #!, also the
/// program itself, found as by the shell): the files *.py of its folder and of the folders in it,
/// at most 2000. Links of scripts are resolved, as Python does. Left out are hidden folders,
/// __pycache__, folders of virtual environments, sweeps, runs and caches, folders behind links, and
/// what lies in folders of the system (/usr/bin). Of folders that hold much else (the home folder,
/// that of temporary files) only their own files. Sorted by folder.
[[nodiscard]] std::vector<std::filesystem::path> script_modules(
    const std::vector<std::string>& command);

}  // namespace overfly::server::experiments
