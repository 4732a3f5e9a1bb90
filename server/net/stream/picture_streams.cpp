#include "server/net/stream/picture_streams.hpp"

#include <algorithm>
#include <utility>

#include "server/net/http/json_text.hpp"

namespace overfly::net {
namespace {

using server::PictureRequest;

constexpr const char* kDebugPrefix = "debug/";

PictureRequest::Kind kind_of(const std::string& name) {
  if (name == "camera") return PictureRequest::Kind::kCamera;
  if (name == "scene") return PictureRequest::Kind::kScene;
  return PictureRequest::Kind::kDebug;
}

}  // namespace

void PictureStreams::subscribe(const std::vector<StreamRequest>& requests) {
  std::vector<Stream> before = std::move(streams_);
  streams_.clear();
  const auto key_of = [](const StreamRequest& requested) {
    return StreamKey(requested.name, requested.camera);
  };
  for (const Stream& stream : before) sequences_[key_of(stream.request)] = stream.sequence;
  for (const StreamRequest& requested : requests) {
    const auto kept = std::find_if(before.begin(), before.end(), [&](const Stream& stream) {
      return key_of(stream.request) == key_of(requested);
    });
    Stream stream;
    if (kept != before.end()) stream = std::move(*kept);
    const auto [id, is_new] =
        ids_.emplace(key_of(requested), static_cast<std::uint32_t>(ids_.size() + 1));
    stream.id = id->second;
    stream.sequence = is_new ? 0 : sequences_[key_of(requested)];
    stream.request = requested;
    stream.slot.set_max_hz(requested.max_hz);
    stream.slot.set_limit_hz(limit_hz_);
    streams_.push_back(std::move(stream));
  }
  show_again();
}

void PictureStreams::set_view(const ViewCommand& command) {
  scene_.mode = command.mode.value_or(scene_.mode);
  scene_.azimuth_rad = command.azimuth_rad.value_or(scene_.azimuth_rad);
  scene_.elevation_rad = command.elevation_rad.value_or(scene_.elevation_rad);
  scene_.distance_m = command.distance_m.value_or(scene_.distance_m);
  scene_.follow = command.follow.value_or(scene_.follow);
  scene_.width_px = command.width_px.value_or(scene_.width_px);
  scene_.height_px = command.height_px.value_or(scene_.height_px);
  ++view_change_;
}

void PictureStreams::set_alignment(const std::string& mode) {
  if (scene_.alignment == mode) return;
  scene_.alignment = mode;
  ++view_change_;
}

bool PictureStreams::set_limit_hz(std::optional<double> limit_hz) {
  if (limit_hz_ == limit_hz) return false;
  limit_hz_ = limit_hz;
  for (Stream& stream : streams_) stream.slot.set_limit_hz(limit_hz);
  return true;
}

void PictureStreams::restart() {
  for (Stream& stream : streams_) {
    stream.slot = PictureSlot(stream.request.max_hz);
    stream.slot.set_limit_hz(limit_hz_);
    stream.ticket = 0;
    stream.sent_frame.reset();
    stream.error_sent.clear();
  }
}

std::optional<PictureRequest> PictureStreams::request_of(const Stream& stream,
                                                         const Instant& instant) const {
  PictureRequest request;
  request.run_id = instant.run_id;
  request.kind = kind_of(stream.request.name);
  request.t_ns = instant.t_ns;
  request.live = instant.live;
  request.scene = scene_;
  request.camera = stream.request.camera;
  request.quality = stream.request.quality;
  request.max_width_px = stream.request.max_width_px;
  if (request.kind == PictureRequest::Kind::kDebug) {
    const auto& names = instant.timeline.estimators();
    const std::string name = stream.request.name.substr(std::string(kDebugPrefix).size());
    const auto found = std::find(names.begin(), names.end(), name);
    if (found == names.end()) return std::nullopt;
    request.estimator = static_cast<std::size_t>(found - names.begin());
  }
  return request;
}

void PictureStreams::pump(const Instant& instant, ViewerPort* port, std::int64_t now_ns) {
  for (Stream& stream : streams_) {
    const auto request = request_of(stream, instant);
    if (!request) continue;
    const bool is_scene = request->kind == PictureRequest::Kind::kScene;
    stream.slot.want({instant.frame, change_ + (is_scene ? view_change_ : 0)});
    const auto key = stream.slot.take(now_ns);
    if (!key) continue;
    stream.ticket = ++tickets_;
    stream.live = instant.live;
    stream.change = key->change;
    port->draw({stream.id, stream.ticket}, *request);
  }
}

PictureStreams::Stream* PictureStreams::find(const PictureTicket& ticket) {
  for (Stream& stream : streams_) {
    if (stream.id == ticket.stream_id && stream.ticket == ticket.number) return &stream;
  }
  return nullptr;
}

void PictureStreams::ready(const PictureTicket& ticket,
                           const Result<server::Picture>& picture,
                           ViewerPort* port) {
  Stream* stream = find(ticket);
  if (stream == nullptr) return;
  const bool same =
      picture && stream->sent_frame == picture->frame && stream->sent_change == stream->change;
  if (!picture || same) {
    if (!picture) tell_error(stream, picture.error(), port);
    stream->slot.done();
    stream->ticket = 0;
    return;
  }
  stream->error_sent.clear();
  stream->slot.answered_with(picture->frame);
  stream->sent_frame = picture->frame;
  stream->sent_change = stream->change;
  PictureHeader header;
  header.stream_id = stream->id;
  header.sequence = stream->sequence++;
  header.frame = picture->frame;
  header.t_ns = picture->t_ns;
  header.width_px = static_cast<std::uint16_t>(picture->width_px);
  header.height_px = static_cast<std::uint16_t>(picture->height_px);
  header.encoding = picture->grey ? PictureEncoding::kJpegGrey : PictureEncoding::kJpegColour;
  header.payload_bytes = static_cast<std::uint32_t>(picture->jpeg->size());
  header.live = stream->live;
  port->send_picture(ticket, header, picture->jpeg);
}

void PictureStreams::tell_error(Stream* stream, const Error& error, ViewerPort* port) {
  // Not an error: there is nothing to show at this instant, and the panel stays empty until there
  // is.
  if (error.code == ErrorCode::kNotFound || error.code == ErrorCode::kCancelled) return;
  if (stream->error_sent == error.message) return;
  stream->error_sent = error.message;
  port->send_text(to_text({{"type", "error"},
                           {"stream", stream->request.name},
                           {"code", to_string(error.code)},
                           {"message", error.message}}));
}

void PictureStreams::sent(const PictureTicket& ticket) {
  Stream* stream = find(ticket);
  if (stream == nullptr) return;
  stream->slot.done();
  stream->ticket = 0;
}

bool PictureStreams::waiting() const {
  return std::any_of(
      streams_.begin(), streams_.end(), [](const Stream& stream) { return stream.slot.waiting(); });
}

nlohmann::json PictureStreams::streams_json() const {
  nlohmann::json list = nlohmann::json::array();
  for (const Stream& stream : streams_) {
    const double max_hz = stream.request.max_hz;
    nlohmann::json entry = {{"id", stream.id},
                            {"name", stream.request.name},
                            {"max_hz", max_hz},
                            {"limit_hz", std::min(max_hz, limit_hz_.value_or(max_hz))}};
    if (!stream.request.camera.empty()) entry["camera"] = stream.request.camera;
    list.push_back(std::move(entry));
  }
  return {{"type", "streams"}, {"streams", std::move(list)}};
}

}  // namespace overfly::net
