#include "server/net/http/rest_router.hpp"

#include <algorithm>
#include <optional>
#include <set>
#include <utility>

#include "core/barrier.hpp"
#include "server/net/http/error_response.hpp"
#include "server/net/http/rest_slots.hpp"

namespace overfly::net {
namespace {

using Captures = std::map<std::string, std::string>;

bool is_capture(const std::string& segment) {
  return segment.size() > 2 && segment.front() == '{' && segment.back() == '}';
}

std::optional<Captures> match(const std::vector<std::string>& pattern,
                              const std::vector<std::string>& segments) {
  if (pattern.size() != segments.size()) return std::nullopt;
  Captures captures;
  for (std::size_t i = 0; i < pattern.size(); ++i) {
    if (is_capture(pattern[i])) {
      if (segments[i].empty()) return std::nullopt;
      captures[pattern[i].substr(1, pattern[i].size() - 2)] = segments[i];
    } else if (pattern[i] != segments[i]) {
      return std::nullopt;
    }
  }
  return captures;
}

HttpResponse method_not_allowed(const std::string& method, const std::set<std::string>& allowed) {
  std::string list;
  for (const std::string& name : allowed) list += (list.empty() ? "" : ", ") + name;
  HttpResponse response = error_response(
      405, "method_not_allowed", "method " + method + " is not allowed here: use one of " + list);
  response.headers.emplace_back("Allow", list);
  return response;
}

Status check_query(const Url& url, const std::vector<std::string>& known) {
  std::string names;
  for (const std::string& name : known) names += (names.empty() ? "" : ", ") + name;
  for (const auto& [name, value] : url.query) {
    if (std::find(known.begin(), known.end(), name) != known.end()) continue;
    return Error{ErrorCode::kInvalidArgument,
                 "query." + name + ": is not a known parameter; there " +
                     (names.empty() ? "are none here" : "are: " + names)};
  }
  if (url.repeated) {
    return Error{ErrorCode::kInvalidArgument,
                 "query." + *url.repeated + ": must be given at most once"};
  }
  return {};
}

}  // namespace

std::string RouteCall::query_or(const std::string& name, const std::string& absent) const {
  const auto found = query.find(name);
  return found == query.end() ? absent : found->second;
}

void RestRouter::add(const std::string& method,
                     const std::string& pattern,
                     Handler handler,
                     std::vector<std::string> known_query) {
  const auto url = parse_target(pattern);
  routes_.push_back({method,
                     pattern,
                     url ? url->segments : std::vector<std::string>{},
                     std::move(handler),
                     {},
                     std::move(known_query)});
  routes_.back().changes = method != "GET";
}

void RestRouter::add_calculation(const std::string& pattern,
                                 Handler handler,
                                 std::vector<std::string> known_query) {
  add("POST", pattern, std::move(handler), std::move(known_query));
  routes_.back().changes = false;
}

void RestRouter::add_long_calculation(const std::string& pattern, Handler handler) {
  const auto limited = [handler = std::move(handler), taken = viewers_calculations_](
                           const RouteCall& call, const Respond& respond) {
    if (call.request.access == Access::kOperator) return handler(call, respond);
    const std::shared_ptr<Slot> slot = take_slot(taken, 1);
    if (!slot) {
      return respond(error_response(
          503, "too_many_calculations", "another viewer's request is calculated: try again soon"));
    }
    handler(call, [slot, respond](HttpResponse response) {
      slot->release();
      respond(std::move(response));
    });
  };
  add_calculation(pattern, limited);
}

bool RestRouter::changes(const HttpRequest& request) const {
  const auto url = parse_target(request.target);
  return url && std::any_of(routes_.begin(), routes_.end(), [&](const Route& route) {
           return route.changes && route.method == request.method &&
                  match(route.segments, url->segments);
         });
}

void RestRouter::add_quick(const std::string& pattern, Handler handler) {
  add("GET", pattern, std::move(handler));
  routes_.back().quick = true;
}

bool RestRouter::is_quick(const HttpRequest& request) const {
  const std::string path = request.target.substr(0, request.target.find('?'));
  return std::any_of(routes_.begin(), routes_.end(), [&](const Route& route) {
    return route.quick && route.pattern == path;
  });
}

void RestRouter::add_upload(const std::string& pattern,
                            Receiver receiver,
                            std::vector<std::string> known_query) {
  add("POST", pattern, {}, std::move(known_query));
  routes_.back().receiver = std::move(receiver);
}

bool RestRouter::is_upload(const HttpRequest& request) const {
  const auto url = parse_target(request.target);
  return url && std::any_of(routes_.begin(), routes_.end(), [&](const Route& route) {
           return route.receiver && route.method == request.method &&
                  match(route.segments, url->segments);
         });
}

void RestRouter::receive(const HttpRequest& request,
                         std::optional<std::uint64_t> size_bytes,
                         std::unique_ptr<BodySink>* sink,
                         std::optional<HttpResponse>* answer) const noexcept {
  const auto begin = [&] {
    const auto url = parse_target(request.target);
    if (!url) {
      *answer = error_response({ErrorCode::kInvalidArgument, "the request's path is malformed"});
      return;
    }
    for (const Route& route : routes_) {
      auto path = route.receiver ? match(route.segments, url->segments) : std::nullopt;
      if (!path) continue;
      if (const Status status = check_query(*url, route.query); !status) {
        *answer = error_response(status.error());
        return;
      }
      *sink = route.receiver({request, std::move(*path), url->query}, size_bytes, answer);
      return;
    }
  };
  (void)contained(begin, [&](const char* what) {
    if (report_) report_(request.method + " " + request.target + " failed: " + what);
  });
  if (*sink || *answer) return;
  HttpResponse response;
  response.status = 500;
  *answer = std::move(response);
}

void RestRouter::handle(const HttpRequest& request, const Respond& respond) const noexcept {
  const auto refuse = [&] { respond(internal_error_response()); };
  const auto refuse_briefly = [&](const char*) {
    HttpResponse response;
    response.status = 500;
    respond(std::move(response));
  };
  (void)contained([&] { find_and_handle(request, respond); },
                  [&](const char* what) {
                    // First the log: the answer refers to it.
                    (void)contained(
                        [&] {
                          if (report_)
                            report_(request.method + " " + request.target + " failed: " + what);
                        },
                        [](const char*) {});
                    (void)contained(refuse, refuse_briefly);
                  });
}

void RestRouter::find_and_handle(const HttpRequest& request, const Respond& respond) const {
  const auto url = parse_target(request.target);
  if (!url) {
    respond(error_response({ErrorCode::kInvalidArgument, "the request's path is malformed"}));
    return;
  }
  const std::string& method = request.method == "HEAD" ? std::string("GET") : request.method;
  std::set<std::string> allowed;
  for (const Route& route : routes_) {
    auto captures = match(route.segments, url->segments);
    if (!captures) continue;
    if (route.method == method && route.handler) {
      if (const Status status = check_query(*url, route.query); !status) {
        respond(error_response(status.error()));
        return;
      }
      route.handler({request, std::move(*captures), url->query}, respond);
      return;
    }
    allowed.insert(route.method);
    if (route.method == "GET") allowed.insert("HEAD");
  }
  if (!allowed.empty()) {
    respond(method_not_allowed(request.method, allowed));
    return;
  }
  respond(error_response({ErrorCode::kNotFound, "no such resource: " + request.target}));
}

}  // namespace overfly::net
