#include "server/net/foxglove/server_message.hpp"

#include <bit>

#include "core/time.hpp"
#include "server/net/http/json_text.hpp"

namespace overfly::net::foxglove {
namespace {

using nlohmann::json;

constexpr std::uint8_t kData = 1;
constexpr std::uint8_t kTime = 2;
constexpr std::uint8_t kPlayback = 5;

template <typename T>
void append_number(Bytes& bytes, T value) {
  for (std::size_t i = 0; i < sizeof(T); ++i) {
    bytes.push_back(static_cast<std::uint8_t>(value >> (8U * i)));
  }
}

json stamp_json(std::int64_t utc_ns) {
  return {{"sec", utc_ns / kNsPerS}, {"nsec", utc_ns % kNsPerS}};
}

}  // namespace

std::string info_text(const ServerInfo& info) {
  json capabilities = {"time", "parameters", "parametersSubscribe"};
  json message = {{"op", "serverInfo"}, {"name", info.name}, {"sessionId", info.session}};
  if (info.span_utc_ns) {
    capabilities.push_back("playbackControl");
    message["dataStartTime"] = stamp_json(info.span_utc_ns->first);
    message["dataEndTime"] = stamp_json(info.span_utc_ns->second);
  }
  message["capabilities"] = std::move(capabilities);
  message["metadata"] = info.metadata;
  return to_text(message);
}

std::string status_text(StatusLevel level, const std::string& message, const std::string& id) {
  json value = {{"op", "status"}, {"level", static_cast<int>(level)}, {"message", message}};
  if (!id.empty()) value["id"] = id;
  return to_text(value);
}

std::string advertise_text(const std::vector<Channel>& channels) {
  json list = json::array();
  for (const Channel& channel : channels) {
    list.push_back({{"id", channel.id},
                    {"topic", channel.topic},
                    {"encoding", "cdr"},
                    {"schemaName", channel.type->name},
                    {"schemaEncoding", "ros2msg"},
                    {"schema", channel.type->definition}});
  }
  return to_text({{"op", "advertise"}, {"channels", std::move(list)}});
}

std::string unadvertise_text(const std::vector<Channel>& channels) {
  json ids = json::array();
  for (const Channel& channel : channels) ids.push_back(channel.id);
  return to_text({{"op", "unadvertise"}, {"channelIds", std::move(ids)}});
}

std::string parameters_text(const std::vector<Parameter>& parameters,
                            const std::optional<std::string>& id) {
  json list = json::array();
  for (const Parameter& parameter : parameters) {
    json entry = {{"name", parameter.name}, {"value", parameter.value}};
    if (parameter.is_float) entry["type"] = "float64";
    list.push_back(std::move(entry));
  }
  json message = {{"op", "parameterValues"}, {"parameters", std::move(list)}};
  if (id) message["id"] = *id;
  return to_text(message);
}

Bytes data_head(std::uint32_t subscription, std::int64_t log_time_ns) {
  Bytes bytes = {kData};
  append_number(bytes, subscription);
  append_number(bytes, static_cast<std::uint64_t>(log_time_ns));
  return bytes;
}

Bytes time_message(std::int64_t utc_ns) {
  Bytes bytes = {kTime};
  append_number(bytes, static_cast<std::uint64_t>(utc_ns));
  return bytes;
}

Bytes playback_message(const PlaybackState& state) {
  Bytes bytes = {kPlayback, static_cast<std::uint8_t>(state.status)};
  append_number(bytes, static_cast<std::uint64_t>(state.utc_ns));
  append_number(bytes, std::bit_cast<std::uint32_t>(static_cast<float>(state.speed)));
  bytes.push_back(state.did_seek ? 1 : 0);
  append_number(bytes, static_cast<std::uint32_t>(state.request_id.size()));
  bytes.insert(bytes.end(), state.request_id.begin(), state.request_id.end());
  return bytes;
}

}  // namespace overfly::net::foxglove
