// The dashboard's files.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "server/net/http/http_message.hpp"

namespace overfly::net {

/// "text/html; charset=utf-8" and so on, by the file name's ending.
[[nodiscard]] std::string mime_type(const std::filesystem::path& file);

/// The regular file that a request's path names below `root`, symbolic links resolved. Empty for
/// one that is missing, lies outside the root, or has a segment that is empty, hidden or `..`.
[[nodiscard]] std::optional<std::filesystem::path> resolve_below(const std::filesystem::path& root,
                                                                 const std::string& target);

/// Serves GET and HEAD below a folder: `/` is index.html, and so is a path without a file name's
/// ending that names no file (the dashboard's own addresses). Files below `assets/` carry a hash
/// in their name and may be kept for ever; all others are asked for again with their ETag.
class StaticFiles {
 public:
  /// @param root  existing folder; empty = serve nothing
  explicit StaticFiles(const std::filesystem::path& root);
  [[nodiscard]] HttpResponse serve(const HttpRequest& request) const;

 private:
  std::filesystem::path root_;
};

}  // namespace overfly::net
