// Scripts with an independent implementation of MAVLink, node-mavlink.
#pragma once

#include <cstdio>
#include <filesystem>
#include <string>
#include <vector>

#include "tests/support/support.hpp"

namespace overfly::flight::testing {

inline constexpr const char* kPeerNotInstalled =
    "node-mavlink is not installed: npm ci --prefix tests/flight/mavlink/peer";

/// The lines that a script of this folder prints; empty if node-mavlink is not installed.
inline std::vector<std::string> lines_of_script(const std::string& name,
                                                const std::string& arguments) {
  const std::filesystem::path script =
      overfly::testing::source_file("tests/flight/mavlink/peer/" + name);
  if (!std::filesystem::exists(script.parent_path() / "node_modules" / "node-mavlink")) return {};
  std::FILE* const pipe = ::popen(("node '" + script.string() + "' " + arguments).c_str(), "r");
  if (pipe == nullptr) return {};
  std::string text;
  for (int c = std::fgetc(pipe); c != EOF; c = std::fgetc(pipe)) text += static_cast<char>(c);
  ::pclose(pipe);
  std::vector<std::string> lines;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end = std::min(text.find('\n', at), text.size());
    lines.push_back(text.substr(at, end - at));
    at = end + 1;
  }
  return lines;
}

}  // namespace overfly::flight::testing
