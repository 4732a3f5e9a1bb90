#include "server/net/stream/row_feed.hpp"

#include <set>
#include <utility>

#include "server/net/http/json_text.hpp"
#include "server/net/stream/row_encoder.hpp"

namespace overfly::net {

Status RowFeed::check_resume(const server::RunTimeline& timeline,
                             const std::map<std::string, std::size_t>& resume) {
  std::set<std::string> streams = {"truth", "log", "vehicle"};
  for (const std::string& name : timeline.estimators()) streams.insert("estimate/" + name);
  for (const auto& [name, rows] : resume) {
    if (streams.contains(name)) continue;
    return Error{ErrorCode::kInvalidArgument,
                 "watch.resume." + name + ": is not a stream of rows of this run"};
  }
  return {};
}

RowFeed::RowFeed(std::string run_id,
                 std::shared_ptr<const server::RunTimeline> timeline,
                 const std::map<std::string, std::size_t>& resume)
    : run_id_(std::move(run_id)), timeline_(std::move(timeline)) {
  add("truth", Stream::Kind::kTruth, 0, resume);
  const auto& estimators = timeline_->estimators();
  for (std::size_t i = 0; i < estimators.size(); ++i) {
    add("estimate/" + estimators[i], Stream::Kind::kEstimate, i, resume);
  }
  add("log", Stream::Kind::kLog, 0, resume);
  add("vehicle", Stream::Kind::kVehicle, 0, resume);
}

void RowFeed::add(const std::string& name,
                  Stream::Kind kind,
                  std::size_t estimator,
                  const std::map<std::string, std::size_t>& resume) {
  const auto known = resume.find(name);
  streams_.push_back({name, kind, estimator, known == resume.end() ? 0 : known->second});
}

std::optional<std::string> RowFeed::next() {
  for (Stream& stream : streams_) {
    if (auto message = next_of(&stream)) return message;
  }
  return std::nullopt;
}

std::optional<std::string> RowFeed::next_of(Stream* stream) {
  nlohmann::json columns;
  std::size_t count = 0;
  switch (stream->kind) {
    case Stream::Kind::kTruth: {
      const auto rows = timeline_->frames(stream->next_row, kMaxRows);
      count = rows.size();
      if (count > 0) columns = truth_columns(rows);
      break;
    }
    case Stream::Kind::kEstimate: {
      const auto rows = timeline_->estimates(stream->estimator, stream->next_row, kMaxRows);
      count = rows.size();
      if (count > 0) columns = estimate_columns(*timeline_, stream->estimator, rows);
      break;
    }
    case Stream::Kind::kLog: {
      const auto rows = timeline_->logs(stream->next_row, kMaxRows);
      count = rows.size();
      if (count > 0) columns = log_columns(rows);
      break;
    }
    case Stream::Kind::kVehicle: {
      const auto rows = timeline_->vehicle_statuses(stream->next_row, kMaxRows);
      count = rows.size();
      if (count > 0) columns = vehicle_columns(rows);
      break;
    }
  }
  if (count == 0) return std::nullopt;
  const std::size_t first = stream->next_row;
  stream->next_row += count;
  return to_text({{"type", "rows"},
                  {"run", run_id_},
                  {"stream", stream->name},
                  {"seq", first},
                  {"columns", std::move(columns)}});
}

}  // namespace overfly::net
