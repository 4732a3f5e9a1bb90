#include "server/net/foxglove/client_message.hpp"

#include <bit>
#include <limits>
#include <string_view>

#include "server/net/http/json_text.hpp"

namespace overfly::net::foxglove {
namespace {

using nlohmann::json;

constexpr std::size_t kLongestName = 200;
constexpr std::uint8_t kClientMessage = 1;
constexpr std::uint8_t kServiceCall = 2;
constexpr std::uint8_t kPlaybackControl = 3;

Error bad(const std::string& what) { return {ErrorCode::kInvalidArgument, what}; }

/// A field that must be an array of at most kMostEntries.
Result<const json*> array_of(const json& message, const char* field) {
  const auto found = message.find(field);
  if (found == message.end() || !found->is_array() || found->size() > kMostEntries) {
    return bad(std::string(field) + ": must be an array of at most " +
               std::to_string(kMostEntries) + " entries");
  }
  return &*found;
}

Result<std::uint32_t> number_of(const json& value, const std::string& field) {
  constexpr std::uint64_t kLargest = std::numeric_limits<std::uint32_t>::max();
  if (value.is_number_unsigned() && value.get<std::uint64_t>() <= kLargest) {
    return static_cast<std::uint32_t>(value.get<std::uint64_t>());
  }
  return bad(field + ": must be a whole number in [0, 2^32)");
}

Result<std::string> name_of(const json& value, const std::string& field) {
  if (value.is_string() && value.get_ref<const std::string&>().size() <= kLongestName) {
    return value.get<std::string>();
  }
  return bad(field + ": must be text of at most " + std::to_string(kLongestName) + " characters");
}

Result<std::optional<std::string>> request_id_of(const json& message) {
  const auto found = message.find("id");
  if (found == message.end() || found->is_null()) return std::optional<std::string>();
  auto id = name_of(*found, "id");
  if (!id) return id.error();
  return std::optional(std::move(*id));
}

Result<Command> subscribe_from(const json& message) {
  const auto list = array_of(message, "subscriptions");
  if (!list) return list.error();
  Subscribe command;
  for (const json& entry : **list) {
    if (!entry.is_object()) return bad("subscriptions: must be objects");
    const auto id = number_of(entry.value("id", json()), "subscriptions.id");
    if (!id) return id.error();
    const auto channel = number_of(entry.value("channelId", json()), "subscriptions.channelId");
    if (!channel) return channel.error();
    command.entries.push_back({*id, *channel});
  }
  return Command(std::move(command));
}

Result<Command> unsubscribe_from(const json& message) {
  const auto list = array_of(message, "subscriptionIds");
  if (!list) return list.error();
  Unsubscribe command;
  for (const json& entry : **list) {
    const auto id = number_of(entry, "subscriptionIds");
    if (!id) return id.error();
    command.subscriptions.push_back(*id);
  }
  return Command(std::move(command));
}

Result<std::vector<std::string>> names_of(const json& message) {
  const auto list = array_of(message, "parameterNames");
  if (!list) return list.error();
  std::vector<std::string> names;
  for (const json& entry : **list) {
    auto name = name_of(entry, "parameterNames");
    if (!name) return name.error();
    names.push_back(std::move(*name));
  }
  return names;
}

Result<Command> get_parameters_from(const json& message) {
  auto names = names_of(message);
  if (!names) return names.error();
  auto id = request_id_of(message);
  if (!id) return id.error();
  return Command(GetParameters{std::move(*names), std::move(*id)});
}

Result<Command> watch_parameters_from(const json& message, bool wanted) {
  auto names = names_of(message);
  if (!names) return names.error();
  return Command(WatchParameters{wanted, std::move(*names)});
}

Result<Command> set_parameters_from(const json& message) {
  const auto list = array_of(message, "parameters");
  if (!list) return list.error();
  SetParameters command;
  for (const json& entry : **list) {
    if (!entry.is_object()) return bad("parameters: must be objects");
    auto name = name_of(entry.value("name", json()), "parameters.name");
    if (!name) return name.error();
    command.values.emplace_back(std::move(*name), entry.value("value", json()));
  }
  auto id = request_id_of(message);
  if (!id) return id.error();
  command.id = std::move(*id);
  return Command(std::move(command));
}

/// Little-endian numbers of a binary message.
class ByteReader {
 public:
  explicit ByteReader(std::span<const std::uint8_t> bytes) : bytes_(bytes) {}
  template <typename T>
  T number() {
    T value = 0;
    for (std::size_t i = 0; i < sizeof(T); ++i) {
      value |= static_cast<T>(static_cast<T>(bytes_[i]) << (8U * i));
    }
    bytes_ = bytes_.subspan(sizeof(T));
    return value;
  }
  [[nodiscard]] std::span<const std::uint8_t> rest() const { return bytes_; }

 private:
  std::span<const std::uint8_t> bytes_;
};

Result<Command> playback_control_from(std::span<const std::uint8_t> bytes) {
  // Command, speed, whether it seeks, time, length of the id.
  constexpr std::size_t kFixedBytes = 1 + 4 + 1 + 8 + 4;
  if (bytes.size() < kFixedBytes) return bad("playback control: must have 18 bytes and an id");
  ByteReader reader(bytes);
  const auto command = reader.number<std::uint8_t>();
  const auto speed = std::bit_cast<float>(reader.number<std::uint32_t>());
  const bool seeks = reader.number<std::uint8_t>() != 0;
  const auto seek_utc_ns = reader.number<std::uint64_t>();
  const std::size_t id_bytes = reader.number<std::uint32_t>();
  const auto id = reader.rest();
  if (command > 1) return bad("playback control: command must be 0 (play) or 1 (pause)");
  if (id_bytes > id.size() || id_bytes > kLongestName) {
    return bad("playback control: the id is longer than the message, or than 200 bytes");
  }
  PlaybackControl control;
  control.play = command == 0;
  control.speed = static_cast<double>(speed);
  if (seeks) control.seek_utc_ns = seek_utc_ns;
  control.request_id.assign(id.begin(), id.begin() + static_cast<std::ptrdiff_t>(id_bytes));
  return Command(std::move(control));
}

}  // namespace

Result<Command> parse_text(const std::string& text) {
  const Result<json> message = parse_object(text, "a message");
  if (!message) return message.error();
  const auto op = message->find("op");
  if (op == message->end() || !op->is_string()) return bad("op: must be text");
  const auto& name = op->get_ref<const std::string&>();
  if (name == "subscribe") return subscribe_from(*message);
  if (name == "unsubscribe") return unsubscribe_from(*message);
  if (name == "getParameters") return get_parameters_from(*message);
  if (name == "setParameters") return set_parameters_from(*message);
  if (name == "subscribeParameterUpdates") return watch_parameters_from(*message, true);
  if (name == "unsubscribeParameterUpdates") return watch_parameters_from(*message, false);
  return Command(NotOffered{name.substr(0, kLongestName)});
}

Result<Command> parse_binary(std::span<const std::uint8_t> bytes) {
  if (bytes.empty()) return bad("a binary message: must not be empty");
  const auto payload = bytes.subspan(1);
  switch (bytes.front()) {
    case kClientMessage:
      return Command(NotOffered{"publishing"});
    case kServiceCall:
      return Command(NotOffered{"services"});
    case kPlaybackControl:
      return playback_control_from(payload);
    default:
      break;
  }
  return bad("a binary message: unknown opcode " + std::to_string(bytes.front()));
}

}  // namespace overfly::net::foxglove
