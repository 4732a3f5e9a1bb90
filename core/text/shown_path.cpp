#include "core/text/shown_path.hpp"

namespace overfly {

namespace fs = std::filesystem;

std::string shown_without(const fs::path& path, const std::string& shown, std::string message) {
  const std::string own = path.string();
  if (own.empty()) return message;
  for (std::size_t at = message.find(own); at != std::string::npos; at = message.find(own, at)) {
    const bool inside = message.compare(at + own.size(), 1, "/") == 0;
    message.replace(at, own.size() + (inside ? 1 : 0), inside ? "" : shown);
    if (!inside) at += shown.size();
  }
  return message;
}

}  // namespace overfly
