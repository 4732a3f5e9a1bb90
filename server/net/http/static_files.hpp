// Serves the dashboard's files.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "server/net/http/http_message.hpp"

namespace overfly::net {

/// "text/html; charset=utf-8" and so on, by the file name's extension.
[[nodiscard]] std::string mime_type(const std::filesystem::path& file);

/// The regular file below `root` for a request's path, symbolic links resolved. Empty if it is
/// missing, lies outside the root, or if a path segment is empty, hidden or `..`.
[[nodiscard]] std::optional<std::filesystem::path> resolve_below(const std::filesystem::path& root,
                                                                 const std::string& target);

/// Serves GET and HEAD below a folder. `/` gives index.html, and so does a path without a file
/// extension that names no file (the dashboard's own addresses). Files below `assets/` have a hash
/// in their name and may be cached for ever; all others are revalidated by their ETag.
class StaticFiles {
 public:
  /// @param root  existing folder; empty = serve no files
  explicit StaticFiles(const std::filesystem::path& root);
  [[nodiscard]] HttpResponse serve(const HttpRequest& request) const;

 private:
  std::filesystem::path root_;
};

}  // namespace overfly::net
