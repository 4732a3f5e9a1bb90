#include "server/net/foxglove/flight_pictures.hpp"

#include <algorithm>

#include "server/net/foxglove/server_message.hpp"

namespace overfly::net::foxglove {
namespace {

/// More than any camera has; the limit during real-time flights is lower.
constexpr double kMostHz = 100.0;
constexpr int kJpegQuality = 85;
/// Estimators see the whole image, so clients get it too.
constexpr int kMostWidthPx = 8192;

bool has_pictures(ChannelKind kind) {
  return kind == ChannelKind::kCameraImage || kind == ChannelKind::kDebugImage;
}

server::PictureRequest picture_request(const server::RunTimeline& timeline,
                                       const Channel& channel,
                                       const FlightPictures::Instant& instant) {
  server::PictureRequest request;
  request.run_id = timeline.info().id;
  request.t_ns = instant.t_ns;
  request.live = instant.live;
  request.quality = kJpegQuality;
  request.max_width_px = kMostWidthPx;
  if (channel.kind == ChannelKind::kDebugImage) {
    request.kind = server::PictureRequest::Kind::kDebug;
    request.estimator = channel.index;
  } else {
    request.camera = timeline.cameras().at(channel.index).name;
  }
  return request;
}

}  // namespace

void FlightPictures::match(const Subscriptions& subscriptions) {
  std::erase_if(slots_, [&](const auto& entry) {
    const Channel& channel = entry.second.channel;
    return !subscriptions.of(channel.kind, channel.index);
  });
  for (const Channel& channel : subscriptions.channels()) {
    if (!has_pictures(channel.kind) || slots_.contains(channel.id)) continue;
    if (!subscriptions.of(channel.kind, channel.index)) continue;
    slots_.emplace(channel.id, Slot{channel, PictureSlot(kMostHz), 0, {}, {}, {}});
  }
}

void FlightPictures::pump(const server::RunTimeline& timeline,
                          const Instant& instant,
                          const Subscriptions& subscriptions,
                          ViewerPort* port,
                          std::int64_t now_ns) {
  match(subscriptions);
  for (auto& [id, slot] : slots_) {
    const bool of_camera = slot.channel.kind == ChannelKind::kCameraImage;
    const std::size_t camera = of_camera ? slot.channel.index : server::kMainCamera;
    const auto row = timeline.frame_at(instant.t_ns, camera);
    if (!row) continue;
    slot.slot.set_limit_hz(port->picture_limit_hz());
    slot.slot.want({row->frame, change_, 0});
    const auto key = slot.slot.take(now_ns);
    if (!key) continue;
    slot.ticket = ++tickets_;
    slot.drawn = *key;
    port->draw({id, slot.ticket}, picture_request(timeline, slot.channel, instant));
  }
}

FlightPictures::Slot* FlightPictures::find(const PictureTicket& ticket) {
  const auto found = slots_.find(ticket.stream_id);
  const bool known = found != slots_.end() && found->second.ticket == ticket.number;
  return known ? &found->second : nullptr;
}

void FlightPictures::ready(const PictureTicket& ticket,
                           const Result<server::Picture>& picture,
                           FlightMessages* messages,
                           ViewerPort* port) {
  Slot* slot = find(ticket);
  if (slot == nullptr) return;
  const auto drop = [&] {
    slot->slot.done();
    slot->ticket = 0;
  };
  if (!picture) {
    tell_error(slot, picture.error(), port);
    drop();
    return;
  }
  PictureKey shown = slot->drawn;
  shown.frame = picture->frame;
  const Channel& channel = slot->channel;
  auto head =
      messages->picture_head(channel.kind, channel.index, picture->t_ns, picture->bytes->size());
  if (slot->sent == shown || !head) {
    drop();
    return;
  }
  slot->error_sent.clear();
  slot->slot.answered_with(picture->frame);
  slot->sent = shown;
  if (channel.kind == ChannelKind::kCameraImage) {
    messages->send_camera_info(channel.index, picture->t_ns);
  }
  port->send_picture(ticket, std::move(*head), picture->bytes);
}

void FlightPictures::tell_error(Slot* slot, const Error& error, ViewerPort* port) {
  // Not an error: there is nothing to show at this instant.
  if (error.code == ErrorCode::kNotFound || error.code == ErrorCode::kCancelled) return;
  if (slot->error_sent == error.message) return;
  slot->error_sent = error.message;
  port->send_text(status_text(StatusLevel::kError, error.message, slot->channel.topic));
}

void FlightPictures::sent(const PictureTicket& ticket) {
  Slot* slot = find(ticket);
  if (slot == nullptr) return;
  slot->slot.done();
  slot->ticket = 0;
}

bool FlightPictures::waiting() const {
  return std::any_of(
      slots_.begin(), slots_.end(), [](const auto& entry) { return entry.second.slot.waiting(); });
}

}  // namespace overfly::net::foxglove
