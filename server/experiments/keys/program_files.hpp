// The files that decide what a program does.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace overfly::server::experiments {

/// The program that a command starts, found as by the shell, and the shared libraries that it
/// brings along: those that it or they need and find by RUNPATH or RPATH, or in LD_LIBRARY_PATH.
/// Libraries of the system are left out. Empty if there is no such program; without libraries for
/// one that is no 64-bit ELF file (a script).
[[nodiscard]] std::vector<std::filesystem::path> program_files(const std::string& program);

}  // namespace overfly::server::experiments
