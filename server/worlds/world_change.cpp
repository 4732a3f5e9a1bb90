#include "server/worlds/world_change.hpp"

#include <utility>
#include <vector>

#include "server/files/file_field.hpp"
#include "server/files/whole_file.hpp"
#include "server/record/run_folder.hpp"

namespace overfly::engine {
namespace {

/// Digest of the world's manifest, if it has one, and of its data files in their order.
struct Digests {
  std::string manifest;
  std::vector<std::string> files;
};

/// Errors: as read_json and guarded_fields.
Result<Digests> recorded(const std::filesystem::path& run_folder) {
  const Result<nlohmann::json> manifest = read_json(manifest_file(run_folder));
  if (!manifest) return manifest.error();
  return guarded_fields([&] {
    Digests digests;
    const FileField world = FileField(*manifest).at("world");
    if (const auto own = world.find("manifest")) digests.manifest = own->at("digest").text();
    for (const FileField& file : world.at("data_hashes").items()) {
      digests.files.push_back(file.at("digest").text());
    }
    return digests;
  });
}

std::string told(const std::vector<std::string>& changed) {
  if (changed.empty()) return "";
  std::string text = changed.front();
  if (changed.size() > 1) text += " and " + std::to_string(changed.size() - 1) + " more";
  return text + (changed.size() > 1 ? " have" : " has") +
         " changed since this run was flown: newly rendered pictures show the present terrain";
}

}  // namespace

std::string world_change(const std::filesystem::path& run_folder, const OpenedWorld& opened) {
  const Result<Digests> then = recorded(run_folder);
  if (!then) return "";
  const auto& now = opened.world.data_hashes;
  std::vector<std::string> changed;
  if (opened.manifest && opened.manifest->digest != then->manifest) {
    changed.push_back(opened.manifest->file);
  }
  for (std::size_t i = 0; i < now.size(); ++i) {
    if (i >= then->files.size() || now[i].second != then->files[i]) changed.push_back(now[i].first);
  }
  return told(changed);
}

}  // namespace overfly::engine
