// The files and the world of a scenario document.
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>

#include "server/scenario/scenario.hpp"

namespace overfly::server {

/// Resolves relative files. Files that are not searched for in `data` become absolute in the
/// document too, so that a copy of it elsewhere refers to the same files.
class FileResolver {
 public:
  /// @param base  absolute folder of the scenario file
  FileResolver(nlohmann::json& document, std::filesystem::path base);
  [[nodiscard]] std::filesystem::path resolve(nlohmann::json& field) const;

 private:
  std::filesystem::path base_;
  std::filesystem::path data_;
  bool has_data_ = false;
};

[[nodiscard]] std::optional<double> number_or_none(const nlohmann::json& object, const char* key);

/// @pre the document is valid and has its defaults
void read_world(nlohmann::json& document, const FileResolver& files, Scenario& scenario);

}  // namespace overfly::server
