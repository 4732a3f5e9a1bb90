// Finds the handler of a REST request by method and path.
#pragma once

#include <functional>
#include <map>
#include <string>
#include <vector>

#include "core/result.hpp"
#include "server/net/http_message.hpp"
#include "server/net/url.hpp"

namespace overfly::net {

/// A request that matched a route.
struct RouteCall {
  const HttpRequest& request;               ///< lives until the handler returns, no longer
  std::map<std::string, std::string> path;  ///< values of the pattern's {names}, decoded
  std::map<std::string, std::string> query;

  /// Errors: kInvalidArgument naming a query parameter that is not in `known`.
  [[nodiscard]] Status allow_query(const std::vector<std::string>& known) const;
};

class RestRouter {
 public:
  using Handler = std::function<void(const RouteCall&, Respond)>;

  struct Route {
    std::string method;
    std::string pattern;  ///< "/api/v1/runs/{id}"
    std::vector<std::string> segments;
    Handler handler;
  };

  void add(const std::string& method, const std::string& pattern, Handler handler);

  /// Answers 404 for an unknown path, 405 with `Allow` for a known path's other methods.
  /// HEAD is served by GET's handler: the caller leaves the body out.
  void handle(const HttpRequest& request, const Respond& respond) const;
  [[nodiscard]] const std::vector<Route>& routes() const { return routes_; }

 private:
  std::vector<Route> routes_;
};

}  // namespace overfly::net
