// What clients ask of picture streams: which ones, from which view, what they have shown.
#include <algorithm>
#include <set>
#include <utility>

#include "server/net/stream/picture_streams.hpp"

namespace overfly::net {
namespace {

/// Numbers of streams that are not subscribed any more are kept up to this count, so that a stream
/// that comes back keeps its number.
constexpr std::size_t kMaxKnownStreams = 1024;

}  // namespace

PictureStreams::StreamKey PictureStreams::key_of(const StreamRequest& request) {
  return {request.run_id, request.name, request.camera, request.view};
}

void PictureStreams::subscribe(const SubscribeCommand& command) {
  acknowledges_ = command.acknowledges;
  std::vector<Stream> before = std::move(streams_);
  streams_.clear();
  for (const Stream& stream : before) sequences_[key_of(stream.request)] = stream.sequence;
  for (const StreamRequest& requested : command.pictures) {
    const auto kept = std::find_if(before.begin(), before.end(), [&](const Stream& stream) {
      return key_of(stream.request) == key_of(requested);
    });
    Stream stream;
    if (kept != before.end()) stream = std::move(*kept);
    const auto [id, is_new] = ids_.emplace(key_of(requested), next_id_);
    if (is_new) ++next_id_;
    stream.id = id->second;
    stream.sequence = is_new ? 0 : sequences_[key_of(requested)];
    if (stream.request != requested) ++stream.change;
    stream.request = requested;
    stream.slot.set_max_hz(requested.max_hz);
    stream.slot.set_limit_hz(limit_hz_);
    stream.slot.set_window(acknowledges_ ? kWindow : 0);
    // Pictures of an earlier subscription need not be shown any more.
    if (kept == before.end() && stream.sequence > 0) stream.shown = stream.sequence - 1;
    count_unshown(&stream);
    streams_.push_back(std::move(stream));
  }
  for (const Stream& stream : before) {
    const bool stays = std::any_of(
        streams_.begin(), streams_.end(), [&](const Stream& kept) { return kept.id == stream.id; });
    if (!stays) window_.forget(stream.id);
  }
  forget_old_streams();
}

void PictureStreams::forget_old_streams() {
  if (ids_.size() <= kMaxKnownStreams) return;
  std::set<StreamKey> subscribed;
  for (const Stream& stream : streams_) subscribed.insert(key_of(stream.request));
  std::erase_if(ids_, [&](const auto& entry) { return !subscribed.contains(entry.first); });
  std::erase_if(sequences_, [&](const auto& entry) { return !subscribed.contains(entry.first); });
}

void PictureStreams::count_unshown(Stream* stream) {
  const std::uint32_t shown = stream->shown ? *stream->shown + 1 : 0;
  stream->slot.set_unshown(static_cast<int>(stream->sequence - shown));
}

void PictureStreams::shown(const ShownCommand& command) {
  for (const auto& [id, sequence] : command.pictures) {
    for (Stream& stream : streams_) {
      if (stream.id != id || sequence >= stream.sequence) continue;
      stream.shown = std::max(stream.shown.value_or(0), sequence);
      count_unshown(&stream);
      window_.arrived(id, sequence);
    }
  }
}

Status PictureStreams::restart_video(const KeyCommand& command) {
  for (Stream& stream : streams_) {
    if (stream.id != command.stream_id) continue;
    stream.key_wanted = true;
    return {};
  }
  return Error{ErrorCode::kNotFound,
               "key.id = " + std::to_string(command.stream_id) + ": is no subscribed stream"};
}

bool PictureStreams::reduction_changed() {
  return std::exchange(reduction_told_, link_.reduction()) != link_.reduction();
}

Status PictureStreams::set_view(const ViewCommand& command, std::int64_t now_ns) {
  if (!views_.contains(command.view) && views_.size() >= kMaxViews) {
    return Error{ErrorCode::kInvalidArgument,
                 "view.view: " + std::to_string(kMaxViews) + " views exist, which is the limit"};
  }
  View& view = views_[command.view];
  server::SceneSettings& settings = view.settings;
  settings.mode = command.mode.value_or(settings.mode);
  settings.azimuth_rad = command.azimuth_rad.value_or(settings.azimuth_rad);
  settings.elevation_rad = command.elevation_rad.value_or(settings.elevation_rad);
  settings.distance_m = command.distance_m.value_or(settings.distance_m);
  settings.follow = command.follow.value_or(settings.follow);
  settings.width_px = command.width_px.value_or(settings.width_px);
  settings.height_px = command.height_px.value_or(settings.height_px);
  settings.eye_world_m = command.eye_world_m.value_or(settings.eye_world_m);
  settings.show = command.show.value_or(settings.show);
  ++view.change;
  view.changed_ns = now_ns;
  return {};
}

bool PictureStreams::set_limit_hz(std::optional<double> limit_hz) {
  if (limit_hz_ == limit_hz) return false;
  limit_hz_ = limit_hz;
  for (Stream& stream : streams_) stream.slot.set_limit_hz(limit_hz);
  return true;
}

void PictureStreams::restart(const std::string& run_id) {
  for (Stream& stream : streams_) {
    if (stream.request.run_id != run_id) continue;
    stream.slot = PictureSlot(stream.request.max_hz);
    stream.slot.set_limit_hz(limit_hz_);
    stream.slot.set_window(acknowledges_ ? kWindow : 0);
    if (stream.sequence > 0) stream.shown = stream.sequence - 1;
    window_.forget(stream.id);
    stream.ticket = 0;
    stream.sent.reset();
    stream.error_sent.clear();
  }
  show_again();
}

}  // namespace overfly::net
