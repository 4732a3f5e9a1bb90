#include <string>
#include <utility>

#include "server/experiments/tables/sweep_tables.hpp"
#include "server/net/http/error_response.hpp"
#include "server/net/rest/rest_api.hpp"

namespace overfly::net {
namespace {

namespace fs = std::filesystem;
namespace experiments = server::experiments;
using nlohmann::json;

/// Names the runs as routes and the stream know them: "runs/RUN" becomes "SWEEP.RUN".
void rename_runs(const std::string& sweep, json& table) {
  constexpr std::string_view kFolder = "runs/";
  for (json& row : table.at("rows")) {
    for (json& run : row.at("runs")) {
      const std::string folder = run.get<std::string>();
      if (folder.starts_with(kFolder)) run = sweep + "." + folder.substr(kFolder.size());
    }
  }
}

/// Null before the first flight is over.
Result<json> table_of(const fs::path& sweeps_folder,
                      const std::string& name,
                      const std::atomic<bool>* cancel) {
  Result<experiments::SweepScores> scores =
      experiments::read_sweep_scores(sweeps_folder / name, cancel);
  if (!scores) {
    if (scores.error().code == ErrorCode::kNotFound) return json(nullptr);
    return scores.error();
  }
  // Their texts name folders of this machine.
  const std::size_t unreadable = std::exchange(scores->problems, {}).size();
  const auto tables = experiments::sweep_tables(std::move(*scores), {}, cancel);
  if (!tables) return tables.error();
  json table = experiments::json_from(*tables);
  table.erase("problems");
  table["unreadable"] = unreadable;
  rename_runs(name, table);
  return table;
}

}  // namespace

void add_sweep_routes(RestRouter* router, const SweepRoutes& routes) {
  router->add("GET", "/api/v1/sweeps", [routes](const RouteCall& call, const Respond& respond) {
    read_and_answer(routes.readers,
                    "sweeps",
                    call,
                    respond,
                    [sweeps = routes.sweeps](const std::atomic<bool>*) {
                      return Result<json>(sweeps->list());
                    });
  });
  router->add(
      "GET", "/api/v1/sweeps/{name}", [routes](const RouteCall& call, const Respond& respond) {
        read_and_answer(
            routes.readers,
            "a sweep",
            call,
            respond,
            [routes, name = call.path.at("name")](const std::atomic<bool>* cancel) -> Result<json> {
              Result<json> entry = routes.sweeps->entry(name);
              if (!entry) return entry.error();
              Result<json> table = table_of(routes.folder, name, cancel);
              if (!table) return table.error();
              json envelope = routes.sweeps->envelope(*entry);
              return json{{"sweep", std::move(*entry)},
                          {"table", std::move(*table)},
                          {"envelope", std::move(envelope)}};
            });
      });
}

}  // namespace overfly::net
