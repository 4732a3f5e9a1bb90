#include "server/record/rows/recorded_events.hpp"

#include <algorithm>
#include <optional>
#include <string>

#include "server/files/whole_file.hpp"
#include "server/record/rows/run_rows.hpp"
#include "server/record/run_folder.hpp"

namespace overfly::server {
namespace {

std::optional<FlightEventKind> event_kind(const std::string& kind) {
  for (const FlightEventKind known :
       {FlightEventKind::kMode, FlightEventKind::kMissionItem, FlightEventKind::kOther}) {
    if (kind == to_string(known)) return known;
  }
  return std::nullopt;
}

}  // namespace

Result<std::vector<FlightEvent>> read_recorded_events(const std::filesystem::path& run_folder,
                                                      std::size_t max_others) {
  const std::filesystem::path file = log_file(run_folder);
  const Result<std::vector<nlohmann::json>> lines = read_lines(file);
  if (!lines) return lines.error();
  std::vector<FlightEvent> events;
  std::size_t others = 0;
  for (std::size_t i = 0; i < lines->size(); ++i) {
    const Result<LogRow> row = log_row_from((*lines)[i]);
    if (!row) return row.error().in(file.string() + ", row " + std::to_string(i + 1));
    const std::optional<FlightEventKind> kind = event_kind(row->kind);
    if (!kind || !row->source.empty()) continue;
    if (*kind == FlightEventKind::kOther && ++others > max_others) continue;
    events.push_back({row->t_ns, *kind, row->text});
  }
  std::stable_sort(events.begin(), events.end(), [](const FlightEvent& a, const FlightEvent& b) {
    return a.t_ns < b.t_ns;
  });
  return events;
}

}  // namespace overfly::server
