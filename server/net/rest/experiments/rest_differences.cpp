#include <string>
#include <utility>
#include <vector>

#include "server/net/http/error_response.hpp"
#include "server/net/rest/rest_api.hpp"
#include "server/record/comparison/differences.hpp"

namespace overfly::net {
namespace {

using nlohmann::json;

constexpr std::size_t kMaxComparedRuns = 16;
/// Values longer than this are cut.
constexpr std::size_t kMaxValueBytes = 1000;

/// Does not cut within a character of UTF-8.
std::string cut(const std::string& text) {
  if (text.size() <= kMaxValueBytes) return text;
  std::size_t end = kMaxValueBytes;
  while (end > 0 && (static_cast<unsigned char>(text[end]) & 0xc0U) == 0x80U) --end;
  return text.substr(0, end) + "...";
}

Result<json> differences_of(const server::RunManager& runs, const std::vector<std::string>& ids) {
  std::vector<json> documents;
  for (const std::string& id : ids) {
    Result<json> document = runs.compared_document_of(id);
    if (!document) return document.error();
    documents.push_back(std::move(*document));
  }
  const server::Differences differences = server::differences_between(documents);
  json fields = json::array();
  for (const server::Difference& difference : differences.fields) {
    json values = json::array();
    for (const auto& value : difference.values) {
      values.push_back(value ? json(cut(*value)) : json(nullptr));
    }
    fields.push_back({{"field", difference.field}, {"values", std::move(values)}});
  }
  return json{{"runs", ids}, {"fields", std::move(fields)}, {"left_out", differences.left_out}};
}

}  // namespace

void add_difference_routes(RestRouter* router,
                           server::RunManager* runs,
                           const ReadingRoutes& readers) {
  router->add("GET",
              "/api/v1/differences",
              [runs, readers](const RouteCall& call, const Respond& respond) {
                const auto ids = run_ids_query_of(call, 2, kMaxComparedRuns);
                if (!ids) return respond(error_response(ids.error()));
                read_and_answer(readers,
                                "what differs between runs",
                                call,
                                respond,
                                [runs, ids = *ids](const std::atomic<bool>*) {
                                  return differences_of(*runs, ids);
                                });
              },
              {"runs"});
}

}  // namespace overfly::net
