// HTTP requests and responses as plain values, independent of a library.
#pragma once

#include <atomic>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace overfly::net {

/// What a client may do.
enum class Access {
  kOperator,  ///< everything
  kViewer,    ///< look at everything, and change nothing
};

struct HttpRequest {
  std::string method;                          ///< upper-case
  std::string target;                          ///< as sent: path and query, percent-encoded
  std::map<std::string, std::string> headers;  ///< names in lower case
  std::string body;
  Access access = Access::kOperator;  ///< of the token that it shows
  /// Set when nobody waits for the answer any more; null if that is not watched.
  std::shared_ptr<std::atomic<bool>> abandoned{};

  /// Empty when the header is absent.
  [[nodiscard]] std::string header(const std::string& lower_case_name) const {
    const auto found = headers.find(lower_case_name);
    return found == headers.end() ? std::string() : found->second;
  }
};

struct HttpResponse {
  int status = 200;
  std::string content_type;
  std::vector<std::pair<std::string, std::string>> headers;
  std::string body;
  /// What the server's log must say of a failure of the server; not sent.
  std::string failure{};
};

/// Called once, from any thread, with the response to a request.
using Respond = std::function<void(HttpResponse)>;

}  // namespace overfly::net
