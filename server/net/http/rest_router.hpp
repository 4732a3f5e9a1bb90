// Finds the handler of a REST request by method and path.
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/result.hpp"
#include "server/net/http/body_sink.hpp"
#include "server/net/http/http_message.hpp"
#include "server/net/http/url.hpp"

namespace overfly::net {

/// A request that matched a route.
struct RouteCall {
  const HttpRequest& request;                ///< lives until the handler returns, no longer
  std::map<std::string, std::string> path;   ///< values of the pattern's {names}, decoded
  std::map<std::string, std::string> query;  ///< only names that the route accepts

  /// Value of a query parameter, or `absent` if it is not given.
  [[nodiscard]] std::string query_or(const std::string& name, const std::string& absent) const;
};

class RestRouter {
 public:
  using Handler = std::function<void(const RouteCall&, Respond)>;
  /// Begins to receive a body; `size_bytes` if it is known in advance. Without a sink the answer
  /// says why it is refused.
  using Receiver = std::function<std::unique_ptr<BodySink>(const RouteCall&,
                                                           std::optional<std::uint64_t> size_bytes,
                                                           std::optional<HttpResponse>* answer)>;

  struct Route {
    std::string method;
    std::string pattern;  ///< "/api/v1/runs/{id}"
    std::vector<std::string> segments;
    Handler handler;
    Receiver receiver;               ///< instead of a handler
    std::vector<std::string> query;  ///< accepted parameters
    bool quick = false;              ///< does not block: no disk, no other thread
    bool changes = false;            ///< something on the server, for everybody
  };

  /// @param report  called with exceptions of handlers and the request that caused them
  explicit RestRouter(std::function<void(const std::string&)> report = {})
      : report_(std::move(report)) {}

  void add(const std::string& method,
           const std::string& pattern,
           Handler handler,
           std::vector<std::string> known_query = {});
  /// As add, for a POST that only calculates: a GET whose request is too long for an address.
  void add_calculation(const std::string& pattern,
                       Handler handler,
                       std::vector<std::string> known_query = {});
  /// The same for one that may take a reading thread for long: of those of viewers one is answered
  /// at a time, others with 503, so that operators find a thread.
  void add_long_calculation(const std::string& pattern, Handler handler);
  /// Whether a request would change something on the server: any but GET and HEAD of a known route
  /// that does not only calculate.
  [[nodiscard]] bool changes(const HttpRequest& request) const;
  /// As add, for a GET that does not block and need not wait behind those that do.
  void add_quick(const std::string& pattern, Handler handler);
  [[nodiscard]] bool is_quick(const HttpRequest& request) const;
  /// A POST whose body is received piece by piece.
  void add_upload(const std::string& pattern,
                  Receiver receiver,
                  std::vector<std::string> known_query = {});
  [[nodiscard]] bool is_upload(const HttpRequest& request) const;
  /// Begins to receive the body of such a request: either `sink` or `answer` is set.
  void receive(const HttpRequest& request,
               std::optional<std::uint64_t> size_bytes,
               std::unique_ptr<BodySink>* sink,
               std::optional<HttpResponse>* answer) const noexcept;

  /// Answers 404 for an unknown path, 405 with `Allow` for another method of a known path, and 400
  /// naming a query parameter that the route does not accept. HEAD is served by GET's handler; the
  /// caller omits the body. Never throws: an exception of a handler is reported and answered with
  /// 500. Work that the handler began may call `respond` again afterwards.
  void handle(const HttpRequest& request, const Respond& respond) const noexcept;
  [[nodiscard]] const std::vector<Route>& routes() const { return routes_; }

 private:
  void find_and_handle(const HttpRequest& request, const Respond& respond) const;
  std::function<void(const std::string&)> report_;
  std::vector<Route> routes_;
  std::shared_ptr<std::atomic<int>> viewers_calculations_ = std::make_shared<std::atomic<int>>(0);
};

}  // namespace overfly::net
