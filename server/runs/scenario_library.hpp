// The scenarios of a server: those of its owner, and those that clients saved.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <mutex>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "core/outside/source_policy.hpp"
#include "core/result.hpp"
#include "server/scenario/document/scenario_list.hpp"
#include "server/scenario/scenario.hpp"

namespace overfly::server {

/// Limits of saved scenarios: their number, and the bytes of each.
inline constexpr std::size_t kMaxSavedScenarios = 500;
inline constexpr std::size_t kMaxSavedScenarioBytes = std::size_t{1} << 20U;

/// Why a scenario is not saved or deleted, in addition to the error.
enum class SaveRefusal {
  kNone,
  kOff,    ///< the server keeps none
  kOwned,  ///< the owner's scenario has this name
  kFull,   ///< kMaxSavedScenarios are saved
};

/// Thread-safe. A name belongs to the owner's scenario if there is one.
class ScenarioLibrary {
 public:
  struct Options {
    std::filesystem::path folder;  ///< of the owner's scenarios
    std::filesystem::path saved;   ///< of saved ones, created with the first; empty = none are kept
    bool allow_commands = false;   ///< clients may name programs to start and network addresses
    std::function<SourcePolicy()> sources;  ///< what scenarios may name now
  };
  explicit ScenarioLibrary(Options options) : options_(std::move(options)) {}

  /// Folder of the owner's scenarios.
  [[nodiscard]] const std::filesystem::path& folder() const { return options_.folder; }
  /// The file of a scenario. Errors: kNotFound.
  [[nodiscard]] Result<std::filesystem::path> file(const std::string& name) const;
  /// Whether clients may save scenarios.
  [[nodiscard]] bool saves() const { return !options_.saved.empty(); }
  /// The owner's scenarios by name, then the saved ones by name.
  [[nodiscard]] std::vector<ScenarioEntry> list() const;
  /// The resolved document. Errors: kNotFound; as load_scenario.
  [[nodiscard]] Result<nlohmann::json> document(const std::string& name) const;
  /// A scenario that can be flown, to be looked at. Errors: kNotFound; as load_scenario,
  /// check_scenario.
  [[nodiscard]] Result<Scenario> load(const std::string& name) const;
  /// The same of a client's document. Relative files are relative to the owner's folder.
  /// Errors: as resolve_scenario, check_scenario.
  [[nodiscard]] Result<Scenario> read(const nlohmann::json& document) const;
  /// As load(), for a client who wants to fly it: overrides must not change commands, sockets and
  /// addresses of the scenario's file; a saved scenario may contain only those of the owner's
  /// files. Errors: as load(); kForbidden naming the field.
  [[nodiscard]] Result<Scenario> load_to_fly(const std::string& name,
                                             const std::vector<Override>& overrides = {}) const;
  /// As read(), for a client who wants to fly or save it: it may contain what a saved scenario may.
  /// Errors: as read(); kForbidden naming the field.
  [[nodiscard]] Result<Scenario> read_to_fly(const nlohmann::json& document) const;

  /// Whether a client may fly scenarios that were read in another way: as for saved ones. Reads the
  /// owner's scenarios once, now. Errors of the check: kForbidden naming the field.
  [[nodiscard]] std::function<Status(const Scenario&)> reach_check() const;

  /// Saves a document, resolved and under this name.
  /// @param replace  a saved scenario of this name is replaced
  /// @return true if there was none of this name
  /// Errors: kInvalidArgument for the name (letters, digits, `_`, `-`, at most 64), and as read();
  /// kConflict if the name exists, or with `refusal`; kIo.
  [[nodiscard]] Result<bool> save(const std::string& name,
                                  const nlohmann::json& document,
                                  bool replace,
                                  SaveRefusal& refusal);
  /// Errors: kNotFound; kConflict with `refusal`; kIo.
  [[nodiscard]] Status remove(const std::string& name, SaveRefusal& refusal);

 private:
  struct Found {
    std::filesystem::path file;
    bool saved = false;
  };
  [[nodiscard]] Result<Found> find(const std::string& name) const;
  [[nodiscard]] Result<Scenario> load(const Found& found,
                                      const std::vector<Override>& overrides) const;
  /// As for saved scenarios.
  [[nodiscard]] Status check_reach(const Scenario& wanted) const;
  [[nodiscard]] Status check_reach(const Scenario& wanted,
                                   const Found& found,
                                   const std::vector<Override>& overrides) const;
  [[nodiscard]] Status check_name(const std::string& name,
                                  bool replace,
                                  SaveRefusal& refusal) const;

  const Options options_;
  std::mutex saving_;
};

}  // namespace overfly::server
