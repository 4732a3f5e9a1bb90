#include "server/experiments/service/client_sweep.hpp"

#include <functional>
#include <utility>

#include "server/experiments/service/sweep_files.hpp"
#include "server/files/plain_name.hpp"

namespace overfly::server::experiments {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

/// Replaces the name of a scenario by its file.
Status name_to_file(const ScenarioLibrary& library, Json& document) {
  const auto found = document.find("scenario");
  if (found == document.end() || !found->is_string()) return {};
  const auto& name = found->get_ref<const std::string&>();
  if (!is_plain_name(name) || name.ends_with(".json")) return {};
  const Result<fs::path> file = library.file(name);
  if (!file) {
    return Error{ErrorCode::kInvalidArgument,
                 "scenario = " + name + ": must be the name of a scenario of this server"};
  }
  *found = fs::absolute(*file).string();
  return {};
}

/// Files of the library may be flown by their names, also where their folder is no data folder.
Status check_scenario_file(const ScenarioLibrary& library,
                           const SourcePolicy& sources,
                           const fs::path& file) {
  const Result<fs::path> known = library.file(file.stem().string());
  if (known && fs::absolute(*known).lexically_normal() == file) return {};
  return sources.check(file, "scenario");
}

/// Whether a sweep is one of the owner's files, which may name any program.
bool is_owners(const Sweep& sweep, const fs::path& folder) {
  const Json files = sweep_file_list(folder);
  for (const Json& entry : files) {
    const std::string name = entry.at("name").get<std::string>() + ".json";
    const Result<Sweep> owned = load_sweep(folder / name);
    if (!owned || owned->scenario_file != sweep.scenario_file) continue;
    Json same = owned->document;
    same["scenario"] = sweep.document.at("scenario");
    if (same == sweep.document) return true;
  }
  return false;
}

/// Confines the processes of the flights to the files that clients may name.
std::vector<std::string> options_of(const DataFolders& data) {
  std::vector<std::string> options;
  if (!data.sources.confined()) return options;
  const auto add = [&](const char* option, const std::vector<fs::path>& folders) {
    for (const fs::path& folder : folders) {
      if (folder.empty()) continue;
      options.emplace_back(option);
      options.push_back(fs::absolute(folder).string());
    }
  };
  add("--files-in", data.folders);
  add("--files-not-in", data.closed);
  return options;
}

}  // namespace

Result<ClientSweep> read_client_sweep(RunManager& runs,
                                      Json document,
                                      SweepRefusal& refusal,
                                      const std::atomic<bool>* cancel) {
  const DataFolders data = runs.data_folders();
  const ScenarioLibrary& library = runs.library();
  const fs::path folder = sweep_files_folder(library.folder());
  if (Status status = name_to_file(library, document); !status) return status.error();
  Result<Sweep> resolved = resolve_sweep(std::move(document), folder);
  if (!resolved) return resolved.error();
  const auto sweep = std::make_shared<Sweep>(std::move(*resolved));
  Status place = check_scenario_file(library, data.sources, sweep->scenario_file);
  if (!place) return place.error();
  sweep->sources = data.sources;
  std::function<Status(const Scenario&)> reach;
  if (!is_owners(*sweep, folder)) reach = library.reach_check();
  // The check goes on in flight, when nobody reads the refusal any more.
  const auto found = std::make_shared<std::atomic<SweepRefusal>>(SweepRefusal::kNone);
  sweep->check = [&runs, reach = std::move(reach), found](const Scenario& scenario) -> Status {
    if (Status allowed = reach ? reach(scenario) : Status(); !allowed) return allowed;
    Status fits = runs.check_memory(scenario);
    if (!fits) *found = SweepRefusal::kMemory;
    return fits;
  };
  Result<std::vector<SweepCell>> cells = cells_of(*sweep);
  if (!cells) return cells.error();
  Result<SweepPlan> plan = SweepPlan::make(*sweep, std::move(*cells), cancel);
  refusal = *found;
  if (!plan) return plan.error();
  return ClientSweep{sweep, std::move(*plan), options_of(data)};
}

}  // namespace overfly::server::experiments
