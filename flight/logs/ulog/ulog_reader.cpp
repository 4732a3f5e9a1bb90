// After the ULog file format, version 1 (PX4 developer guide, "ULog File Format").
#include "flight/logs/ulog/ulog_reader.hpp"

#include <algorithm>
#include <array>
#include <string>
#include <unordered_map>
#include <utility>
#include <vector>

#include "core/text/number_text.hpp"
#include "core/text/printable_text.hpp"
#include "flight/logs/boot_clock.hpp"
#include "flight/logs/held_messages.hpp"
#include "flight/logs/ulog/ulog_message.hpp"
#include "flight/logs/ulog/ulog_topics.hpp"

namespace overfly::flight::logs {
namespace {

constexpr std::array<std::uint8_t, 7> kUlogMagic = {'U', 'L', 'o', 'g', 0x01, 0x12, 0x35};
constexpr std::size_t kUlogHeaderBytes = 16;
/// The longest message and the header of the next one.
constexpr std::size_t kLongestBytes = kUlogMessageHeaderBytes + 65535 + kUlogMessageHeaderBytes;
constexpr std::size_t kMaxTopics = 4096;

/// A state of vehicle_status, in [0, 255]. Files may declare its field with any type.
/// @return empty without the field, and for values that no state has
std::optional<double> state_in(const std::optional<UlogField>& field,
                               std::span<const std::uint8_t> data) {
  const std::optional<double> state = field ? number_in(*field, data) : std::nullopt;
  return state && *state >= 0.0 && *state <= 255.0 ? state : std::nullopt;
}

class UlogPass {
 public:
  explicit UlogPass(LogSink& sink) : sink_(sink) {}

  /// @param body  of a message, without its header
  Status take(char kind, std::span<const std::uint8_t> body);
  void skip(std::size_t bytes);
  /// What follows a cut message is in step again.
  void cut_message() {
    first_message_ = false;
    ++cut_messages_;
    in_step_ = true;
  }
  void unknown_kind() {
    first_message_ = false;
    ++unknown_kinds_;
  }
  void report();
  [[nodiscard]] bool in_step() const { return in_step_; }
  /// Offsets at which appended data begin, increasing.
  [[nodiscard]] const std::vector<std::uint64_t>& appended() const { return appended_; }

 private:
  struct Topic {
    TopicPlan plan;
    StreamId id = 0;
    bool wanted = false;
    std::optional<LocalOrigin> origin;
    std::optional<double> mode;
    std::optional<double> arming;
  };

  Status take_flags(std::span<const std::uint8_t> body);
  void take_subscription(std::span<const std::uint8_t> body);
  void take_data(std::span<const std::uint8_t> body);
  void pass_data(Topic& topic,
                 const std::optional<LogTime>& time,
                 std::span<const std::uint8_t> data);
  /// Before subscriptions change: messages belong to those with which they were written.
  void pass_held();
  void take_status(Topic& topic, const LogTime& time, std::span<const std::uint8_t> data);
  void take_text(std::span<const std::uint8_t> body, std::size_t time_at);

  LogSink& sink_;
  UlogFormats formats_;
  std::unordered_map<std::uint16_t, Topic> topics_;  ///< by msg_id
  StreamId stream_count_ = 0;
  BootClock clock_;
  HeldMessages<std::vector<std::uint8_t>> held_;  ///< bodies
  std::vector<std::uint64_t> appended_;
  bool first_message_ = true;  ///< nothing follows the header yet: only there flags are allowed
  std::uint64_t late_flags_ = 0;
  std::uint64_t skipped_bytes_ = 0;
  std::uint64_t damaged_places_ = 0;
  bool in_step_ = true;
  std::uint64_t cut_messages_ = 0;
  std::uint64_t unknown_kinds_ = 0;
  std::uint64_t bad_formats_ = 0;
  std::uint64_t unsubscribed_ = 0;
  std::uint64_t left_out_topics_ = 0;
  std::uint64_t dropouts_ = 0;
  std::uint64_t dropout_ms_ = 0;
};

Status UlogPass::take_flags(std::span<const std::uint8_t> body) {
  constexpr std::uint8_t kDataAppended = 1;
  for (std::size_t i = 0; i < 8; ++i) {
    const auto flags = ulog_value<std::uint8_t>(body, 8 + i);
    const std::uint8_t unknown = i == 0 ? flags & static_cast<std::uint8_t>(~kDataAppended) : flags;
    if (unknown == 0) continue;
    return Error{ErrorCode::kUnsupported,
                 "incompat_flags[" + std::to_string(i) + "] = " + std::to_string(flags) +
                     ": only flag 1 of the first byte (appended data) is understood"};
  }
  if ((ulog_value<std::uint8_t>(body, 8) & kDataAppended) == 0) return {};
  for (std::size_t i = 0; i < 3; ++i) {
    const auto offset = ulog_value<std::uint64_t>(body, 16 + 8 * i);
    if (offset > kUlogHeaderBytes) appended_.push_back(offset);
  }
  std::sort(appended_.begin(), appended_.end());
  return {};
}

void UlogPass::take_subscription(std::span<const std::uint8_t> body) {
  if (body.size() < 4) return;
  const std::string name = printable_text(body.subspan(3));
  const auto msg_id = ulog_value<std::uint16_t>(body, 1);
  if (stream_count_ >= kMaxTopics) {
    ++left_out_topics_;
    return;
  }
  pass_held();
  if (!formats_.has(name)) ++bad_formats_;
  Topic topic;
  topic.plan = plan_of(formats_, name, body[0]);
  topic.id = stream_count_++;
  topic.wanted = sink_.stream(topic.id, topic.plan.description);
  topics_[msg_id] = std::move(topic);
}

void UlogPass::take_data(std::span<const std::uint8_t> body) {
  const auto found = topics_.find(ulog_value<std::uint16_t>(body, 0));
  if (body.size() < 2 || found == topics_.end()) {
    ++unsubscribed_;
    return;
  }
  Topic& topic = found->second;
  const std::span<const std::uint8_t> data = body.subspan(2);
  std::optional<LogTime> time;
  if (topic.plan.time && topic.plan.time->type == "uint64_t" &&
      data.size() >= topic.plan.time->offset + sizeof(std::uint64_t)) {
    const auto time_us = ulog_value<std::uint64_t>(data, topic.plan.time->offset);
    constexpr std::uint64_t kMaxUs = std::uint64_t{1} << 52U;
    time = clock_.take(time_us < kMaxUs ? static_cast<std::int64_t>(time_us) * 1000 : -1);
  }
  if (held_.must_hold(clock_)) {
    sink_.declaration();
    held_.hold(time, {body.begin(), body.end()});
    return;
  }
  pass_held();
  pass_data(topic, time, data);
}

void UlogPass::pass_held() {
  held_.release(clock_,
                [this](const std::optional<LogTime>& time, std::span<const std::uint8_t> body) {
                  Topic& topic = topics_.at(ulog_value<std::uint16_t>(body, 0));
                  pass_data(topic, time, body.subspan(2));
                });
}

void UlogPass::pass_data(Topic& topic,
                         const std::optional<LogTime>& time,
                         std::span<const std::uint8_t> data) {
  std::optional<LogTime> measured = time;
  if (time) measured->t_ns = sampled_ns_in(topic.plan.sampled, data, time->t_ns);
  sink_.message(topic.id, measured);
  if (!time) return;
  if (topic.plan.description.position == PositionKind::kLocal) {
    const std::optional<LocalOrigin> origin = origin_in(topic.plan, data);
    if (origin && origin != topic.origin) {
      topic.origin = origin;
      sink_.local_origin(topic.id, *origin);
    }
  }
  if (topic.wanted) pass_samples(topic.plan, data, topic.id, *measured, sink_);
  if (topic.wanted && topic.plan.description.sensors) {
    const auto samples = sensor_samples_in(topic.plan.sensor, data, time->t_ns);
    if (samples) sink_.samples(topic.id, *time, topic.plan.sensor.preference, *samples);
  }
  take_status(topic, *time, data);
}

void UlogPass::take_status(Topic& topic, const LogTime& time, std::span<const std::uint8_t> data) {
  if (const std::optional<double> mode = state_in(topic.plan.mode, data)) {
    if (std::exchange(topic.mode, mode) != mode) {
      sink_.event({"", time, EventKind::kMode, "mode " + std::to_string(static_cast<int>(*mode))});
    }
  }
  if (const std::optional<double> arming = state_in(topic.plan.arming, data)) {
    constexpr double kArmed = 2.0;
    const std::optional<double> before = std::exchange(topic.arming, arming);
    if (!before || (*before == kArmed) != (*arming == kArmed)) {
      sink_.event({"", time, EventKind::kArming, *arming == kArmed ? "armed" : "disarmed"});
    }
  }
}

void UlogPass::take_text(std::span<const std::uint8_t> body, std::size_t time_at) {
  if (body.size() < time_at + 8) return;
  const auto time_us = ulog_value<std::uint64_t>(body, time_at);
  std::optional<LogTime> time = clock_.latest();
  constexpr std::uint64_t kMaxUs = std::uint64_t{1} << 52U;
  if (time && time_us < kMaxUs) time->t_ns = static_cast<std::int64_t>(time_us) * 1000;
  sink_.event({"", time, EventKind::kText, printable_text(body.subspan(time_at + 8))});
}

Status UlogPass::take(char kind, std::span<const std::uint8_t> body) {
  in_step_ = true;
  const bool is_first = std::exchange(first_message_, false);
  switch (kind) {
    case 'B':
      if (is_first) return take_flags(body);
      ++late_flags_;
      break;
    case 'F':
      sink_.declaration();
      if (!formats_.declare({reinterpret_cast<const char*>(body.data()), body.size()})) {
        ++bad_formats_;
      }
      break;
    case 'A':
      take_subscription(body);
      break;
    case 'R':
      sink_.declaration();
      pass_held();
      topics_.erase(ulog_value<std::uint16_t>(body, 0));
      break;
    case 'D':
      take_data(body);
      break;
    case 'L':
      take_text(body, 1);
      break;
    case 'C':
      take_text(body, 3);
      break;
    case 'O':
      ++dropouts_;
      dropout_ms_ += ulog_value<std::uint16_t>(body, 0);
      break;
    default:
      break;
  }
  return {};
}

void UlogPass::skip(std::size_t bytes) {
  first_message_ = false;
  skipped_bytes_ += bytes;
  if (std::exchange(in_step_, false)) ++damaged_places_;
}

void UlogPass::report() {
  pass_held();
  const auto warn = [&](std::uint64_t count, const std::string& text) {
    if (count > 0) sink_.warning(std::to_string(count) + " " + text);
  };
  warn(dropouts_, "dropouts of the logger, " + std::to_string(dropout_ms_) + " ms in all");
  warn(skipped_bytes_,
       "bytes in " + counted(damaged_places_, "place") + " belong to no message and were skipped");
  warn(cut_messages_, "messages are cut off by the end of the file or by appended data");
  warn(unknown_kinds_, "messages are of kinds that are not known");
  warn(late_flags_, "messages with flags are not the first one of the file and were not used");
  warn(bad_formats_, "formats are missing or cannot be understood");
  warn(unsubscribed_, "messages belong to no subscription");
  warn(left_out_topics_,
       "subscriptions were left out: only " + std::to_string(kMaxTopics) + " are read");
  warn(clock_.implausible(), "stamps of messages are implausible and were not used");
}

}  // namespace

bool is_ulog(std::span<const std::uint8_t> head) {
  return head.size() >= kUlogMagic.size() &&
         std::equal(kUlogMagic.begin(), kUlogMagic.end(), head.begin());
}

Status read_ulog(ForwardReader& file, LogSink& sink) {
  UlogPass pass(sink);
  const Result<std::span<const std::uint8_t>> header = file.ahead(kUlogHeaderBytes);
  if (!header) return header.error();
  file.skip(std::min(kUlogHeaderBytes, header->size()));
  std::uint64_t next_progress = 0;
  while (true) {
    const Result<std::span<const std::uint8_t>> bytes = file.ahead(kLongestBytes);
    if (!bytes) return bytes.error();
    if (bytes->empty()) break;
    std::uint64_t limit = file.size_bytes() - file.position();
    const std::uint64_t here = pass.appended().empty() ? 0 : file.file_offset();
    for (const std::uint64_t offset : pass.appended()) {
      if (offset > here) limit = std::min(limit, offset - here);
    }
    const UlogPlace place = look_at_message(*bytes, limit, pass.in_step());
    if (place.kind == UlogPlace::Kind::kMessage) {
      const Status taken =
          pass.take(static_cast<char>((*bytes)[2]),
                    bytes->subspan(kUlogMessageHeaderBytes, place.size - kUlogMessageHeaderBytes));
      if (!taken) return taken.error();
    } else if (place.kind == UlogPlace::Kind::kCut) {
      pass.cut_message();
    } else if (place.kind == UlogPlace::Kind::kUnknownKind) {
      pass.unknown_kind();
    } else {
      pass.skip(place.size);
    }
    file.skip(std::min(place.size, bytes->size()));
    if (file.position() >= next_progress) {
      next_progress = file.position() + ForwardReader::kBufferBytes;
      if (!sink.progress(file.position())) {
        return Error{ErrorCode::kCancelled, "reading was cancelled"};
      }
    }
  }
  pass.report();
  return {};
}

}  // namespace overfly::flight::logs
