// Scenario documents with overrides, and what makes them a scenario.
//
// The input is the document's text; lines `--set PATH=VALUE` at its end are overrides.
#include "server/scenario/scenario.hpp"

#include <cstdlib>

#include "server/files/whole_file.hpp"
#include "server/scenario/document/scenario_file.hpp"
#include "server/scenario/document/scenario_override.hpp"
#include "tests/fuzz/input_folder.hpp"

namespace {

using namespace overfly;
using namespace overfly::server;

constexpr std::string_view kSet = "\n--set ";

std::vector<Override> take_overrides(std::string_view* input) {
  std::vector<Override> overrides;
  const std::size_t first = input->find(kSet);
  if (first == std::string_view::npos) return overrides;
  std::string_view rest = input->substr(first + 1);
  *input = input->substr(0, first);
  while (!rest.empty()) {
    std::string_view line = fuzz::take_line(&rest);
    if (!line.starts_with(kSet.substr(1))) continue;
    line.remove_prefix(kSet.size() - 1);
    if (const auto change = parse_override(std::string(line))) overrides.push_back(*change);
  }
  return overrides;
}

Result<Scenario> scenario_of(std::string_view input) {
  const std::vector<Override> overrides = take_overrides(&input);
  const auto document = parse_json(std::string(input), "the input");
  if (!document) return document.error();
  return resolve_scenario(*document, overrides, "/nonexistent");
}

}  // namespace

extern "C" bool overfly_fuzz_accepts(const std::uint8_t* data, std::size_t size) {
  return scenario_of(fuzz::text_of(data, size)).ok();
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto scenario = scenario_of(fuzz::text_of(data, size));
  if (!scenario) return 0;
  // What a run writes into its folder is the same scenario again.
  const auto again = parse_json(scenario->resolved.dump(), "the resolved document");
  if (!again || !resolve_scenario(*again, {}, "/nonexistent")) std::abort();
  return 0;
}
