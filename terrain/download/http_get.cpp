#include "terrain/download/http_get.hpp"

#include <cpl_http.h>
#include <cpl_string.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <ctime>
#include <memory>

#include "core/text/lower_case.hpp"
#include "terrain/raster/gdal_dataset.hpp"

namespace overfly::terrain::download {
namespace {

struct ResultDestroyer {
  void operator()(CPLHTTPResult* result) const { CPLHTTPDestroyResult(result); }
};

int CPL_STDCALL go_on(double, const char*, void* stop) {
  return static_cast<const std::atomic<bool>*>(stop)->load() ? FALSE : TRUE;
}

/// GDAL reports the status only as text ("HTTP error code : 404"), and none for a success.
int status_of(const CPLHTTPResult& result) {
  const std::string said = result.pszErrBuf == nullptr ? "" : result.pszErrBuf;
  const std::size_t at = said.find("HTTP error code");
  if (at != std::string::npos) {
    const std::size_t digit = said.find_first_of("0123456789", at);
    return digit == std::string::npos ? 0 : std::atoi(said.c_str() + digit);
  }
  if (result.nStatus != 0 || !said.empty()) return 0;
  return result.nDataLen > 0 ? 200 : 204;
}

}  // namespace

std::optional<double> retry_after_s(const std::string& value, std::int64_t unix_now_s) {
  if (value.empty()) return std::nullopt;
  char* end = nullptr;
  const double seconds = std::strtod(value.c_str(), &end);
  if (end != value.c_str() && *end == '\0') return std::max(0.0, seconds);
  std::tm date{};
  if (strptime(value.c_str(), "%a, %d %b %Y %H:%M:%S GMT", &date) == nullptr) return std::nullopt;
  return std::max(0.0, static_cast<double>(timegm(&date) - unix_now_s));
}

HttpReply http_get(const std::string& url, double stall_s, const std::atomic<bool>& stop) {
  initialise_gdal();
  GdalMessages messages;
  CPLStringList options;
  options.SetNameValue("USERAGENT", "Overfly/1 (virtual flight range; world download)");
  options.SetNameValue("CONNECTTIMEOUT", "20");
  options.SetNameValue("LOW_SPEED_LIMIT", "1");
  options.SetNameValue("LOW_SPEED_TIME",
                       std::to_string(std::max(1, static_cast<int>(stall_s))).c_str());
  // Retries are left to the caller, which knows all requests
  options.SetNameValue("MAX_RETRY", "0");
  const std::unique_ptr<CPLHTTPResult, ResultDestroyer> result(
      CPLHTTPFetchEx(url.c_str(),
                     options.List(),
                     &go_on,
                     const_cast<std::atomic<bool>*>(&stop),  // GDAL passes it back unchanged
                     nullptr,
                     nullptr));
  HttpReply reply;
  if (!result) {
    reply.error = messages.text();
    return reply;
  }
  reply.status = status_of(*result);
  if (reply.status == 0) {
    reply.error = result->pszErrBuf != nullptr ? result->pszErrBuf : messages.text();
  }
  if (result->pszContentType != nullptr) reply.content_type = lower_case(result->pszContentType);
  if (result->nDataLen > 0)
    reply.body.assign(result->pabyData, result->pabyData + result->nDataLen);
  if (const char* after = CSLFetchNameValue(result->papszHeaders, "Retry-After")) {
    const auto now = std::chrono::system_clock::now().time_since_epoch();
    reply.retry_after_s =
        retry_after_s(after, std::chrono::duration_cast<std::chrono::seconds>(now).count());
  }
  return reply;
}

}  // namespace overfly::terrain::download
