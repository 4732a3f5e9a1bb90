// What the routes share whose answers need much reading: their threads and their parameters.
#pragma once

#include <atomic>
#include <charconv>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "core/result.hpp"
#include "server/net/http/rest_router.hpp"

namespace overfly::net {

/// Threads that read for clients.
struct ReadingRoutes {
  /// Runs work on one of them. @return false if too much is waiting
  std::function<bool(std::function<void()>, std::shared_ptr<std::atomic<bool>> cancel)> read;
  /// Called with the reason of an internal error.
  std::function<void(const std::string&)> report;
};

/// Answers from such a thread with what `read` returns. What cannot be read is answered with 422,
/// too many requests with 503. @param what  is read, for the log: "a flight log"
void read_and_answer(const ReadingRoutes& routes,
                     const std::string& what,
                     const RouteCall& call,
                     const Respond& respond,
                     std::function<Result<nlohmann::json>(const std::atomic<bool>* cancel)> read);

/// The same with a response of any kind.
void respond_from_reader(const ReadingRoutes& routes,
                         const std::string& what,
                         const RouteCall& call,
                         const Respond& respond,
                         std::function<Result<HttpResponse>(const std::atomic<bool>* cancel)> read);

/// The response to a request whose body is not announced as JSON.
[[nodiscard]] std::optional<HttpResponse> not_json(const HttpRequest& request);

/// A page whose texts come from scenarios: it may run no script and load nothing, in a window of
/// its own too.
[[nodiscard]] HttpResponse page_response(std::string html);

/// Errors: kInvalidArgument naming a parameter and its limit.
[[nodiscard]] Error bad_query(const std::string& name,
                              const std::string& text,
                              const std::string& limit);

/// The number that a text consists of.
template <typename Number>
[[nodiscard]] std::optional<Number> number_from(const std::string& text) {
  Number number{};
  const char* end = text.data() + text.size();
  const auto [rest, error] = std::from_chars(text.data(), end, number);
  if (error != std::errc() || rest != end) return std::nullopt;
  return number;
}

/// The parameter `runs`: ids with commas between. Errors: kInvalidArgument.
[[nodiscard]] Result<std::vector<std::string>> run_ids_query_of(const RouteCall& call,
                                                                std::size_t min,
                                                                std::size_t max);

struct TimeQuery {
  std::optional<std::int64_t> from_ns;
  std::optional<std::int64_t> to_ns;
};
/// The parameters from_s and to_s. Errors: kInvalidArgument.
[[nodiscard]] Result<TimeQuery> time_query_of(const RouteCall& call);

/// The parameter `points`, or `absent` if it is not given. Errors: kInvalidArgument.
[[nodiscard]] Result<std::size_t> points_query_of(const RouteCall& call,
                                                  std::size_t absent,
                                                  std::size_t min,
                                                  std::size_t max);

}  // namespace overfly::net
