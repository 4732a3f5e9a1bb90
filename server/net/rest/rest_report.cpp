#include <cctype>
#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "core/cancel.hpp"
#include "core/text/shown_path.hpp"
#include "server/net/http/error_response.hpp"
#include "server/net/rest/rest_api.hpp"
#include "server/report/report.hpp"

namespace overfly::net {
namespace {

namespace fs = std::filesystem;

/// Fewer than a command may report: other clients wait meanwhile, and flights need the memory.
constexpr std::size_t kMaxServedRuns = 16;
constexpr std::size_t kMaxServedRows = 1'000'000;

Result<evaluation::AlignmentMode> alignment_query_of(const RouteCall& call) {
  const std::string text = call.query_or("alignment", "init_scale");
  if (const auto mode = evaluation::alignment_mode_from(text)) return *mode;
  std::string modes;
  for (const evaluation::AlignmentMode mode : evaluation::all_alignment_modes()) {
    modes += (modes.empty() ? "" : ", ") + std::string(evaluation::to_string(mode));
  }
  return bad_query("alignment", text, "one of " + modes);
}

/// A run's id as a part of a file's name.
std::string file_part(std::string id) {
  for (char& c : id) {
    const bool plain = std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '-' || c == '_';
    if (!plain) c = '-';
  }
  return id;
}

/// The runs in the order of the query.
struct ReportedRuns {
  std::vector<fs::path> folders;
  std::map<fs::path, std::string> id_of;
};

/// Errors: kNotFound; kInvalidArgument for a run that is named twice.
Result<ReportedRuns> reported_runs(const server::RunManager& runs,
                                   const std::vector<std::string>& ids) {
  ReportedRuns reported;
  for (const std::string& id : ids) {
    const Result<fs::path> folder = runs.folder(id);
    if (!folder) return folder.error();
    if (!reported.id_of.emplace(*folder, id).second) {
      return bad_query("runs", id, "each run only once");
    }
    reported.folders.push_back(*folder);
  }
  return reported;
}

/// Without the folders of this machine.
Error shown_to_client(Error error, const ReportedRuns& reported) {
  for (const fs::path& folder : reported.folders) {
    error.message = shown_without(folder.parent_path(), "", std::move(error.message));
  }
  return error;
}

Result<HttpResponse> report_of(server::RunManager& runs,
                               const std::vector<std::string>& ids,
                               evaluation::AlignmentMode alignment,
                               const std::atomic<bool>* cancel) {
  const auto reported = reported_runs(runs, ids);
  if (!reported) return reported.error();
  server::report::ReportOptions options;
  options.alignment = alignment;
  options.max_rows = kMaxServedRows;
  options.cancel = cancel;
  // Only worlds that this server may open, and those that it holds open are shared.
  options.open_world = [&](const fs::path& folder) {
    return runs.ready_world_of(reported->id_of.at(folder), [&] { return is_cancelled(cancel); });
  };
  Result<server::report::MadeReport> made = server::report::make_report(reported->folders, options);
  if (!made) return shown_to_client(made.error(), *reported);
  HttpResponse response = page_response(std::move(made->html));
  const std::string name =
      ids.size() == 1 ? file_part(ids.front()) : std::to_string(ids.size()) + "-runs";
  response.headers.emplace_back("Content-Disposition",
                                "inline; filename=\"overfly-report-" + name + ".html\"");
  return response;
}

}  // namespace

void add_report_routes(RestRouter* router, server::RunManager* runs, const ReadingRoutes& drawers) {
  router->add("GET",
              "/api/v1/report",
              [runs, drawers](const RouteCall& call, const Respond& respond) {
                const auto ids = run_ids_query_of(call, 1, kMaxServedRuns);
                if (!ids) return respond(error_response(ids.error()));
                const auto alignment = alignment_query_of(call);
                if (!alignment) return respond(error_response(alignment.error()));
                respond_from_reader(
                    drawers,
                    "runs for a report",
                    call,
                    respond,
                    [runs, ids = *ids, alignment = *alignment](const std::atomic<bool>* cancel) {
                      return report_of(*runs, ids, alignment, cancel);
                    });
              },
              {"runs", "alignment"});
}

}  // namespace overfly::net
