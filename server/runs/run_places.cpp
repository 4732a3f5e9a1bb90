#include "server/runs/run_places.hpp"

#include <algorithm>
#include <system_error>

namespace overfly::server {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kDigits = 20;

}  // namespace

std::optional<SweepRunName> RunPlaces::in_sweep(const std::string& id) const {
  if (sweeps_folder_.empty() || id.size() < kDigits + 2) return std::nullopt;
  const std::size_t dot = id.size() - kDigits - 1;
  const auto is_digit = [](char c) { return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'f'); };
  const auto digits = id.begin() + static_cast<std::ptrdiff_t>(dot) + 1;
  if (id[dot] != '.' || !std::all_of(digits, id.end(), is_digit)) return std::nullopt;
  std::error_code ignored;
  if (fs::exists(runs_folder_ / id, ignored)) return std::nullopt;
  return SweepRunName{id.substr(0, dot), id.substr(dot + 1)};
}

fs::path RunPlaces::of(const std::string& id) const {
  const auto name = in_sweep(id);
  return name ? sweeps_folder_ / name->sweep / "runs" / name->run : runs_folder_ / id;
}

}  // namespace overfly::server
