// What the server's tests share: a small world, scenarios over it, a renderer without EGL.
#pragma once

#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "renderer/renderer.hpp"
#include "server/run/run.hpp"
#include "tests/support/support.hpp"

namespace overfly::server::testing {

/// The manifest of a small landscape, made once per program.
[[nodiscard]] const std::filesystem::path& small_world();

/// 2 s at 10 Hz over that world with a small camera; `overrides` as of --set.
[[nodiscard]] Scenario small_scenario(const std::vector<std::string>& overrides = {});
[[nodiscard]] nlohmann::json small_document();

[[nodiscard]] RendererFactory noop_factory();
/// A run without pictures into a folder.
[[nodiscard]] RunOptions options_for(const std::filesystem::path& folder);

/// Path relative to the folder -> content, of all files but timings.json and created.json.
[[nodiscard]] std::vector<std::pair<std::string, std::string>> contents_without_timings(
    const std::filesystem::path& folder);

}  // namespace overfly::server::testing
