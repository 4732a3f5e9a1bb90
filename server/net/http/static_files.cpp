#include "server/net/http/static_files.hpp"

#include <algorithm>
#include <array>
#include <string_view>
#include <system_error>
#include <utility>

#include "core/outside/file_text.hpp"
#include "server/net/http/error_response.hpp"
#include "server/net/http/url.hpp"

namespace overfly::net {
namespace {

namespace fs = std::filesystem;

constexpr const char* kOctets = "application/octet-stream";
constexpr std::array<std::pair<const char*, const char*>, 18> kMimeTypes = {{
    {".html", "text/html; charset=utf-8"},
    {".js", "text/javascript; charset=utf-8"},
    {".mjs", "text/javascript; charset=utf-8"},
    {".css", "text/css; charset=utf-8"},
    {".json", "application/json"},
    {".map", "application/json"},
    {".webmanifest", "application/manifest+json"},
    {".txt", "text/plain; charset=utf-8"},
    {".md", "text/plain; charset=utf-8"},
    {".svg", "image/svg+xml"},
    {".png", "image/png"},
    {".jpg", "image/jpeg"},
    {".jpeg", "image/jpeg"},
    {".webp", "image/webp"},
    {".ico", "image/x-icon"},
    {".woff", "font/woff"},
    {".woff2", "font/woff2"},
    {".wasm", "application/wasm"},
}};

/// Quoted size and modification time; changes whenever a build replaces the file.
std::string etag_of(const fs::path& file, std::uintmax_t size_bytes, const char* variant) {
  std::error_code ignored;
  const auto time = fs::last_write_time(file, ignored).time_since_epoch().count();
  std::string etag = "\"";
  etag.append(std::to_string(size_bytes)).append("-").append(std::to_string(time));
  etag.append(variant).append("\"");
  return etag;
}

bool is_below(const fs::path& folder, const fs::path& file) {
  const auto [end, ignored] = std::mismatch(folder.begin(), folder.end(), file.begin(), file.end());
  return end == folder.end();
}

/// Marks a page for a viewer, so that it does not show for a moment what its user may not do.
void mark_for_viewer(std::string& page) {
  constexpr std::string_view kRoot = "<html";
  if (const std::size_t at = page.find(kRoot); at != std::string::npos) {
    page.insert(at + kRoot.size(), " data-access=\"viewer\"");
  }
}

HttpResponse static_response(const fs::path& root,
                             const fs::path& file,
                             const HttpRequest& request) {
  std::error_code error;
  const std::uintmax_t size_bytes = fs::file_size(file, error);
  if (error) return error_response({ErrorCode::kIo, "cannot read " + file.filename().string()});
  HttpResponse response;
  const bool marked = request.access == Access::kViewer && file.extension() == ".html";
  // Otherwise a browser that changes its token would keep the other one's page.
  const std::string etag = etag_of(file, size_bytes, marked ? "-viewer" : "");
  const bool hashed = is_below(root / "assets", file);
  response.headers.emplace_back("ETag", etag);
  response.headers.emplace_back("Cache-Control",
                                hashed ? "private, max-age=31536000, immutable" : "no-cache");
  if (request.header("if-none-match") == etag) {
    response.status = 304;
    return response;
  }
  response.content_type = mime_type(file);
  constexpr std::uint64_t kMaxBytes = std::uint64_t{256} << 20U;
  Result<std::string> text = read_file_text(file, kMaxBytes);
  if (!text) return error_response({ErrorCode::kIo, "cannot read " + file.filename().string()});
  response.body = std::move(*text);
  if (marked) mark_for_viewer(response.body);
  return response;
}

/// True for an address such as /runs/abc, which the dashboard handles itself.
bool is_page(const std::string& target) {
  const auto url = parse_target(target);
  return url && (url->segments.empty() || url->segments.back().find('.') == std::string::npos);
}

}  // namespace

std::string mime_type(const fs::path& file) {
  std::string ending = file.extension().string();
  std::transform(ending.begin(), ending.end(), ending.begin(), [](unsigned char c) {
    return static_cast<char>(c >= 'A' && c <= 'Z' ? c - 'A' + 'a' : c);
  });
  for (const auto& [name, type] : kMimeTypes) {
    if (ending == name) return type;
  }
  return kOctets;
}

std::optional<fs::path> resolve_below(const fs::path& root, const std::string& target) {
  const auto url = parse_target(target);
  if (!url) return std::nullopt;
  fs::path relative;
  for (const std::string& segment : url->segments) {
    const bool plain = !segment.empty() && segment.front() != '.' &&
                       segment.find_first_of("/\\") == std::string::npos;
    if (!plain) return std::nullopt;
    relative /= segment;
  }
  std::error_code error;
  const fs::path real_root = fs::canonical(root, error);
  if (error) return std::nullopt;
  const fs::path file = fs::canonical(real_root / relative, error);
  if (error || !is_below(real_root, file) || !fs::is_regular_file(file, error)) return std::nullopt;
  return file;
}

StaticFiles::StaticFiles(const fs::path& root) {
  std::error_code error;
  if (!root.empty()) root_ = fs::canonical(root, error);
}

HttpResponse StaticFiles::serve(const HttpRequest& request) const {
  if (request.method != "GET" && request.method != "HEAD") {
    HttpResponse response = error_response(
        405, "method_not_allowed", "method " + request.method + " is not allowed here");
    response.headers.emplace_back("Allow", "GET, HEAD");
    return response;
  }
  if (root_.empty()) {
    return error_response({ErrorCode::kNotFound, "this server serves no dashboard: see /api/v1"});
  }
  if (const auto file = resolve_below(root_, request.target)) {
    return static_response(root_, *file, request);
  }
  if (is_page(request.target)) {
    if (const auto index = resolve_below(root_, "/index.html")) {
      return static_response(root_, *index, request);
    }
  }
  return error_response({ErrorCode::kNotFound, "no such file: " + request.target});
}

}  // namespace overfly::net
