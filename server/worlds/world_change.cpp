#include "server/worlds/world_change.hpp"

#include <optional>
#include <vector>

#include "server/record/run_manifest.hpp"

namespace overfly::server {
namespace {

std::string told(const std::vector<std::string>& changed) {
  if (changed.empty()) return "";
  std::string text = changed.front();
  if (changed.size() > 1) text += " and " + std::to_string(changed.size() - 1) + " more";
  return text + (changed.size() > 1 ? " have" : " has") +
         " changed since this run was flown: newly rendered pictures show the present terrain";
}

}  // namespace

std::string world_change(const std::filesystem::path& run_folder, const OpenedWorld& opened) {
  const Result<ReadManifest> manifest = read_run_manifest(run_folder);
  if (!manifest || !manifest->check(ManifestPart::kWorld)) return "";
  const std::optional<RunManifest::World>& then = manifest->values.world;
  if (!then || then->data_hashes.empty()) return "";
  const auto& now = opened.world.data_hashes;
  std::vector<std::string> changed;
  const std::string own_digest = then->manifest ? then->manifest->digest : "";
  if (opened.manifest && opened.manifest->digest != own_digest) {
    changed.push_back(opened.manifest->file);
  }
  for (std::size_t i = 0; i < now.size(); ++i) {
    if (i >= then->data_hashes.size() || now[i].second != then->data_hashes[i].digest) {
      changed.push_back(now[i].first);
    }
  }
  return told(changed);
}

}  // namespace overfly::server
