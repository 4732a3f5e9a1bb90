// The program to start as a child process, and its environment.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace overfly::process {

struct ChildCommand {
  std::vector<std::string> arguments;    ///< starting with the program
  std::vector<std::string> environment;  ///< "NAME=VALUE", in addition to the inherited one
  std::filesystem::path working_folder;  ///< empty = that of this process
  std::vector<int> cpus;                 ///< empty = all
  double memory_limit_mb = 0.0;          ///< of its address space; 0 = unlimited
};

}  // namespace overfly::process
