#include "server/net/stream/picture_streams.hpp"

#include <algorithm>
#include <tuple>
#include <utility>

#include "server/net/http/json_text.hpp"
#include "server/net/stream/pictures/picture_codec.hpp"

namespace overfly::net {
namespace {

using server::PictureRequest;

/// A view that was changed so recently is being moved.
constexpr std::int64_t kViewMovesNs = 300'000'000;
/// A scene or frame that took longer to draw is previewed after a jump in time.
constexpr std::int64_t kLongDrawingNs = 15'000'000;
/// Longer ones count as this: five whole pictures later that do not take long, previews end.
constexpr std::int64_t kLongestDrawingNs = 4 * kLongDrawingNs;
/// A picture previewed after a jump is drawn in full once no other jump has followed for so long:
/// the next preview would have to wait for it.
constexpr std::int64_t kPreviewStandsNs = 200'000'000;
/// Pictures are not reduced below this quality, unless the client asks for it.
constexpr int kLeastQuality = 30;

PictureRequest::Kind kind_of(const std::string& name) {
  if (name == "camera") return PictureRequest::Kind::kCamera;
  if (name == "scene") return PictureRequest::Kind::kScene;
  if (name == "depth") return PictureRequest::Kind::kDepth;
  if (name == "error" || name.starts_with("error/")) return PictureRequest::Kind::kError;
  return PictureRequest::Kind::kDebug;
}

/// Whose stream it is; empty for one that belongs to no estimator.
std::string estimator_of(const std::string& name) {
  const std::size_t slash = name.find('/');
  return slash == std::string::npos ? std::string() : name.substr(slash + 1);
}

PictureEncoding encoding_of(const server::Picture& picture) {
  if (picture.coding == server::PictureCoding::kVp8) return PictureEncoding::kVp8;
  return picture.grey ? PictureEncoding::kJpegGrey : PictureEncoding::kJpegColour;
}

/// Where the aircraft are in the picture that follows.
nlohmann::json labels_json(const PictureHeader& header,
                           const std::vector<server::SceneLabel>& labels) {
  nlohmann::json list = nlohmann::json::array();
  for (const server::SceneLabel& label : labels) {
    nlohmann::json entry = {{"run", label.run_id},
                            {"x_px", label.x_px},
                            {"y_px", label.y_px},
                            {"distance_m", label.distance_m}};
    if (!label.estimator.empty()) entry["estimator"] = label.estimator;
    if (label.error_m) entry["error_m"] = *label.error_m;
    list.push_back(std::move(entry));
  }
  return {{"type", "labels"},
          {"id", header.stream_id},
          {"sequence", header.sequence},
          {"labels", std::move(list)}};
}

}  // namespace

std::uint64_t PictureStreams::change_of(const Stream& stream) const {
  std::uint64_t change = change_ + stream.change;
  if (kind_of(stream.request.name) != PictureRequest::Kind::kScene) return change;
  if (const auto view = views_.find(stream.request.view); view != views_.end()) {
    change += view->second.change;
  }
  return change;
}

std::optional<PictureRequest> PictureStreams::request_of(const Stream& stream,
                                                         const Instant& instant) const {
  PictureRequest request;
  request.run_id = instant.run_id;
  request.kind = kind_of(stream.request.name);
  request.t_ns = instant.t_ns;
  request.live = instant.live;
  request.camera = stream.request.camera;
  request.quality = stream.request.quality;
  request.max_width_px = stream.request.max_width_px;
  request.alignment = instant.alignment;
  if (request.kind == PictureRequest::Kind::kScene) {
    const auto view = views_.find(stream.request.view);
    if (view != views_.end()) request.scene = view->second.settings;
    request.look = stream.request.look;
    request.compared = stream.request.compared;
  }
  if (const std::string name = estimator_of(stream.request.name); !name.empty()) {
    const auto& names = instant.timeline->estimators();
    const auto found = std::find(names.begin(), names.end(), name);
    if (found == names.end()) return std::nullopt;
    request.estimator = static_cast<std::size_t>(found - names.begin());
    request.error.estimator = request.estimator;
  }
  return request;
}

const PictureStreams::Instant* PictureStreams::find_instant(const std::vector<Instant>& instants,
                                                            const std::string& run_id) {
  const auto found = std::find_if(instants.begin(), instants.end(), [&](const Instant& instant) {
    return instant.run_id == run_id;
  });
  return found == instants.end() ? nullptr : &*found;
}

std::int64_t PictureStreams::add_others(const Stream& stream,
                                        const Instant& main,
                                        const std::vector<Instant>& instants,
                                        PictureRequest* request) {
  std::int64_t times_ns = 0;
  const std::int64_t since_frame_ns = main.at_end ? 0 : main.at_ns - main.t_ns;
  for (const SceneRun& run : stream.request.with) {
    const Instant* other = find_instant(instants, run.run_id);
    if (other == nullptr || other->run_id == stream.request.run_id) continue;
    const std::int64_t t_ns = other->live ? other->t_ns : other->at_ns - since_frame_ns;
    request->others.push_back({other->run_id, t_ns, other->live, other->alignment, run.look});
    times_ns += t_ns;
  }
  return times_ns;
}

bool PictureStreams::view_moves(const Stream& stream, std::int64_t now_ns) const {
  if (kind_of(stream.request.name) != PictureRequest::Kind::kScene) return false;
  const auto view = views_.find(stream.request.view);
  if (view == views_.end() || view->second.changed_ns == 0) return false;
  return now_ns - view->second.changed_ns < kViewMovesNs;
}

bool PictureStreams::wants_preview(const Stream& stream) {
  const PictureRequest::Kind kind = kind_of(stream.request.name);
  const bool rendered =
      kind == PictureRequest::Kind::kScene || kind == PictureRequest::Kind::kCamera;
  return rendered && stream.jumped && !stream.moving && stream.drawing_ns > kLongDrawingNs;
}

bool PictureStreams::preview_stands(const Stream& stream, std::int64_t now_ns) {
  return stream.preview && now_ns - stream.requested_ns < kPreviewStandsNs;
}

void PictureStreams::show_again() {
  ++change_;
  for (Stream& stream : streams_) stream.jumped = false;
}

void PictureStreams::show_after_jump() {
  ++change_;
  for (Stream& stream : streams_) stream.jumped = true;
}

/// While processor time is short, because a real-time flight limits the pictures, video is made
/// only for a client that needs it: it takes several times the time of a JPEG.
void PictureStreams::fit_to_link(Stream* stream, PictureRequest* request) const {
  stream->reduced = stream->preview = request->preview = wants_preview(*stream);
  if (stream->preview) {
    request->scene.width_px >>= 1;
    request->scene.height_px >>= 1;
  }
  if (!stream->moving) return;
  const Reduction reduction = reduction_at(link_.reduction());
  stream->reduced = request->sparing = link_.reduction() > 0;
  request->quality = std::max(std::min(request->quality, kLeastQuality),
                              request->quality - reduction.quality_less);
  request->max_width_px >>= reduction.halvings;
  request->scene.width_px >>= reduction.halvings;
  request->scene.height_px >>= reduction.halvings;
  // The first picture after a seek is a JPEG, which is there sooner than a key picture.
  const bool follows = stream->sent && stream->sent->change == stream->drawn.change;
  const bool affordable = !limit_hz_ || link_.tight();
  if (!stream->request.video || !follows || !affordable) {
    stream->key_wanted = true;
    return;
  }
  stream->reduced = true;
  request->video = server::VideoChain{
      0, stream->id, stream->video_sent, std::exchange(stream->key_wanted, false)};
}

bool PictureStreams::request_one(Stream* stream,
                                 const std::vector<Instant>& instants,
                                 bool playing,
                                 bool room,
                                 ViewerPort* port,
                                 std::int64_t now_ns) {
  const Instant* instant = find_instant(instants, stream->request.run_id);
  if (instant == nullptr) return false;
  auto request = request_of(*stream, *instant);
  if (!request) return false;
  const std::int64_t others = add_others(*stream, *instant, instants, &*request);
  if (stream->slot.window_full() && now_ns - stream->requested_ns > SendWindow::kArrivedByNs) {
    // Its pictures were lost, or the client does not report them.
    stream->shown = stream->sequence - 1;
    count_unshown(stream);
  }
  stream->moving = playing || view_moves(*stream, now_ns);
  const bool full = !stream->moving && stream->reduced && !wants_preview(*stream) &&
                    !preview_stands(*stream, now_ns);
  stream->slot.want({instant->frame, change_of(*stream), others, full});
  const std::size_t bytes = expected_bytes(*stream);
  if (acknowledges_ && stream->slot.due(now_ns)) {
    if (!room || !window_.has_room(bytes)) return true;
    window_.reserve(stream->id, bytes, now_ns);
  }
  const auto key = stream->slot.take(now_ns);
  if (!key) return false;
  stream->still = !stream->moving;
  stream->ticket = ++tickets_;
  stream->requested_ns = now_ns;
  stream->live = instant->live;
  stream->drawn = *key;
  const bool was_reduced = stream->reduced;
  fit_to_link(stream, &*request);
  stream->jumped = false;
  // So that the same picture is not requested once more.
  if (full) stream->reduced = was_reduced;
  port->draw({stream->id, stream->ticket}, *request);
  return false;
}

std::size_t PictureStreams::expected_bytes(const Stream& stream) {
  return stream.moving && stream.moving_bytes > 0 ? stream.moving_bytes : stream.still_bytes;
}

std::vector<PictureStreams::Stream*> PictureStreams::in_turn() {
  std::vector<Stream*> streams;
  for (Stream& stream : streams_) streams.push_back(&stream);
  const auto place = [](const Stream* stream) {
    const bool frame_after_jump =
        stream->jumped && kind_of(stream->request.name) == PictureRequest::Kind::kCamera;
    const bool scene = kind_of(stream->request.name) == PictureRequest::Kind::kScene;
    return std::tuple(!(scene && wants_preview(*stream)), !frame_after_jump, stream->requested_ns);
  };
  std::stable_sort(streams.begin(), streams.end(), [&](const Stream* a, const Stream* b) {
    return place(a) < place(b);
  });
  return streams;
}

void PictureStreams::pump(const std::vector<Instant>& instants,
                          bool playing,
                          ViewerPort* port,
                          std::int64_t now_ns) {
  bool moving = false;
  bool blocked = false;
  bool held = false;
  bool waits = false;
  changes_soon_ = false;
  for (Stream* stream : in_turn()) {
    // While one waits for room, those after it wait too, so that a large one gets its turn.
    const bool room = !held;
    held = request_one(stream, instants, playing, room, port, now_ns) || held;
    waits = waits || (held && window_.link_is_full(expected_bytes(*stream)));
    moving = moving || stream->moving;
    blocked = blocked || (stream->moving && (waits || stream->slot.blocked(now_ns)));
    changes_soon_ = changes_soon_ || view_moves(*stream, now_ns) || preview_stands(*stream, now_ns);
  }
  if (!acknowledges_) return;
  window_.note(waits, now_ns);
  link_.note(moving, blocked, now_ns);
}

PictureStreams::Stream* PictureStreams::find(const PictureTicket& ticket) {
  for (Stream& stream : streams_) {
    if (stream.id == ticket.stream_id && stream.ticket == ticket.number) return &stream;
  }
  return nullptr;
}

void PictureStreams::ready(const PictureTicket& ticket,
                           const Result<server::Picture>& picture,
                           ViewerPort* port,
                           std::int64_t now_ns) {
  Stream* stream = find(ticket);
  if (stream == nullptr) return;
  PictureKey shown = stream->drawn;
  if (picture) shown.frame = picture->frame;
  const bool same = picture && stream->sent == shown;
  if (!picture || same) {
    if (!picture) tell_error(stream, picture.error(), port);
    window_.release(stream->id);
    stream->slot.done();
    stream->ticket = 0;
    return;
  }
  stream->error_sent.clear();
  const bool frame = kind_of(stream->request.name) == PictureRequest::Kind::kCamera;
  // The whole frame was available: it need not follow.
  if (frame && stream->preview && !picture->preview) stream->preview = stream->reduced = false;
  if (stream->still && !stream->preview) {
    // One that was drawn quickly may have shown ground that was in memory: the next may not.
    // Opening a world may have taken a minute: that is soon forgotten.
    const std::int64_t drawing_ns = std::min(now_ns - stream->requested_ns, kLongestDrawingNs);
    stream->drawing_ns = std::max(drawing_ns, stream->drawing_ns / 4 * 3);
  }
  stream->slot.answered_with(picture->frame);
  stream->slot.sending();
  stream->sent = shown;
  PictureHeader header;
  header.stream_id = stream->id;
  header.sequence = stream->sequence++;
  count_unshown(stream);
  const std::size_t bytes = picture->bytes->size();
  (stream->still ? stream->still_bytes : stream->moving_bytes) = bytes;
  window_.sent(stream->id, header.sequence, bytes);
  header.frame = picture->frame;
  header.t_ns = picture->t_ns;
  header.width_px = static_cast<std::uint16_t>(picture->width_px);
  header.height_px = static_cast<std::uint16_t>(picture->height_px);
  header.encoding = encoding_of(*picture);
  header.key = picture->key;
  if (picture->coding == server::PictureCoding::kVp8) ++stream->video_sent;
  header.payload_bytes = static_cast<std::uint32_t>(picture->bytes->size());
  header.live = stream->live;
  if (const auto& scale = picture->scale) {
    header.scale = {
        static_cast<float>(scale->low), static_cast<float>(scale->high), scale->logarithmic};
  }
  header.full_width_px = static_cast<std::uint16_t>(picture->full_width_px);
  header.full_height_px = static_cast<std::uint16_t>(picture->full_height_px);
  if (!picture->labels.empty()) port->send_text(to_text(labels_json(header, picture->labels)));
  const auto head = encode_picture_header(header);
  port->send_picture(ticket, {head.begin(), head.end()}, picture->bytes);
}

void PictureStreams::tell_error(Stream* stream, const Error& error, ViewerPort* port) {
  // Not an error: there is nothing to show at this instant, and the panel stays empty until there
  // is.
  if (error.code == ErrorCode::kNotFound || error.code == ErrorCode::kCancelled) return;
  if (stream->error_sent == error.message) return;
  stream->error_sent = error.message;
  port->send_text(to_text({{"type", "error"},
                           {"run", stream->request.run_id},
                           {"picture", stream->request.name},
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
  if (changes_soon_) return true;
  return std::any_of(
      streams_.begin(), streams_.end(), [](const Stream& stream) { return stream.slot.waiting(); });
}

nlohmann::json PictureStreams::pictures_json() const {
  nlohmann::json list = nlohmann::json::array();
  for (const Stream& stream : streams_) {
    const double max_hz = stream.request.max_hz;
    nlohmann::json entry = {{"id", stream.id},
                            {"run", stream.request.run_id},
                            {"name", stream.request.name},
                            {"max_hz", max_hz},
                            {"limit_hz", std::min(max_hz, limit_hz_.value_or(max_hz))}};
    if (!stream.request.camera.empty()) entry["camera"] = stream.request.camera;
    if (!stream.request.view.empty()) entry["view"] = stream.request.view;
    list.push_back(std::move(entry));
  }
  return {{"type", "pictures"}, {"pictures", std::move(list)}, {"reduction", link_.reduction()}};
}

}  // namespace overfly::net
