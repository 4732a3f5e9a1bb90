#include <algorithm>
#include <cctype>
#include <memory>
#include <string>
#include <utility>

#include "server/net/http/error_response.hpp"
#include "server/net/rest/rest_api.hpp"

namespace overfly::net {

bool is_progress_id(const std::string& id) {
  constexpr std::size_t kLeast = 8;
  constexpr std::size_t kMost = 64;
  return id.size() >= kLeast && id.size() <= kMost &&
         std::all_of(id.begin(), id.end(), [](unsigned char c) {
           return std::isalnum(c) != 0 || c == '-';
         });
}

void add_progress_routes(RestRouter* router, std::shared_ptr<ProgressBoard> progress) {
  router->add("GET",
              "/api/v1/progress/{id}",
              [progress = std::move(progress)](const RouteCall& call, const Respond& respond) {
                const auto found = progress->find(call.path.at("id"));
                if (!found) {
                  respond(error_response(
                      {ErrorCode::kNotFound, "no request of this name is being worked on"}));
                  return;
                }
                respond(json_response(200, {{"step", found->step}, {"share", found->share}}));
              });
}

}  // namespace overfly::net
