// The file of an index, all numbers little-endian: 8 bytes magic, size, time and hash of the log,
// number of blocks (8 bytes each); of each block offset of its begin and end, first and last time
// (8 bytes each) and flags (1 byte); the hash of all that.
#include <algorithm>
#include <bit>
#include <chrono>
#include <cstdlib>
#include <cstring>
#include <span>
#include <string>
#include <string_view>
#include <system_error>

#include "core/outside/file_text.hpp"
#include "flight/logs/index/log_index.hpp"
#include "flight/logs/whole_file.hpp"

namespace overfly::flight::logs {
namespace {

namespace fs = std::filesystem;

static_assert(std::endian::native == std::endian::little, "numbers are copied");

constexpr std::string_view kIndexMagic = "OVFLIDX2";
constexpr std::size_t kIndexBlockBytes = 4 * 8 + 1;
constexpr std::uint64_t kMaxIndexBytes = std::uint64_t{64} << 20U;
constexpr std::uint8_t kDeclaresFlag = 1;
constexpr std::uint8_t kTimedFlag = 2;

/// FNV-1a (Fowler, Noll, Vo), 64 bit.
std::uint64_t hash_of(std::span<const std::uint8_t> bytes, std::uint64_t hash) {
  for (const std::uint8_t byte : bytes) hash = (hash ^ byte) * 0x100000001b3ULL;
  return hash;
}
constexpr std::uint64_t kHashStart = 0xcbf29ce484222325ULL;

std::span<const std::uint8_t> bytes_in(const std::string& text) {
  return {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()};
}

template <typename T>
void put_number(std::string& bytes, T value) {
  bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
}

/// Takes a number off the front. @pre there are enough bytes
template <typename T>
T take_number(std::span<const std::uint8_t>& bytes) {
  T value{};
  std::memcpy(&value, bytes.data(), sizeof value);
  bytes = bytes.subspan(sizeof value);
  return value;
}

fs::path beside(const fs::path& log) { return log.string() + ".overfly-index"; }

std::string variable(const char* name) {
  const char* const value = std::getenv(name);
  return value != nullptr ? value : "";
}

/// Empty if the environment names no folder.
fs::path in_cache(const fs::path& log) {
  fs::path folder = variable("OVERFLY_CACHE");
  if (folder.empty() && !variable("XDG_CACHE_HOME").empty()) {
    folder = fs::path(variable("XDG_CACHE_HOME")) / "overfly";
  }
  if (folder.empty() && !variable("HOME").empty()) {
    folder = fs::path(variable("HOME")) / ".cache" / "overfly";
  }
  if (folder.empty()) return {};
  std::error_code failure;
  const std::string place = fs::absolute(log, failure).lexically_normal().string();
  const std::uint64_t name = hash_of(bytes_in(place), kHashStart);
  return folder / "log-indices" / (std::to_string(name) + ".overfly-index");
}

/// Whether the folder of a file is marked as writable by its owner. Nobody expects new files in one
/// that is not, although the system lets the superuser write there.
bool in_writable_folder(const fs::path& file) {
  std::error_code failure;
  const fs::path folder = fs::absolute(file, failure).parent_path();
  const fs::perms permissions = fs::status(folder, failure).permissions();
  return !failure && (permissions & fs::perms::owner_write) != fs::perms::none;
}

std::string bytes_of_index(const LogIdentity& identity, const LogIndex& index) {
  std::string bytes(kIndexMagic);
  put_number(bytes, identity.size_bytes);
  put_number(bytes, identity.modified_ns);
  put_number(bytes, identity.hash);
  put_number(bytes, std::uint64_t{index.size()});
  for (const LogBlock& block : index) {
    put_number(bytes, block.bytes.begin);
    put_number(bytes, block.bytes.end);
    put_number(bytes, block.first_ns.value_or(0));
    put_number(bytes, block.last_ns.value_or(0));
    const unsigned flags =
        (block.declares ? kDeclaresFlag : 0U) | (block.first_ns ? kTimedFlag : 0U);
    put_number(bytes, static_cast<std::uint8_t>(flags));
  }
  put_number(bytes, hash_of(bytes_in(bytes), kHashStart));
  return bytes;
}

std::optional<LogIndex> index_in(std::span<const std::uint8_t> bytes, const LogIdentity& identity) {
  constexpr std::size_t kFixedBytes = 8 + 4 * 8 + 8;
  if (bytes.size() < kFixedBytes) return std::nullopt;
  std::span<const std::uint8_t> end = bytes.last(8);
  bytes = bytes.first(bytes.size() - 8);
  if (take_number<std::uint64_t>(end) != hash_of(bytes, kHashStart) ||
      std::memcmp(bytes.data(), kIndexMagic.data(), kIndexMagic.size()) != 0) {
    return std::nullopt;
  }
  bytes = bytes.subspan(kIndexMagic.size());
  LogIdentity of;
  of.size_bytes = take_number<std::uint64_t>(bytes);
  of.modified_ns = take_number<std::int64_t>(bytes);
  of.hash = take_number<std::uint64_t>(bytes);
  const auto count = take_number<std::uint64_t>(bytes);
  if (!(of == identity) || count == 0 || bytes.size() % kIndexBlockBytes != 0 ||
      bytes.size() / kIndexBlockBytes != count) {
    return std::nullopt;
  }
  LogIndex index;
  std::uint64_t offset = 0;
  for (std::uint64_t i = 0; i < count; ++i) {
    LogBlock block;
    block.bytes.begin = take_number<std::uint64_t>(bytes);
    block.bytes.end = take_number<std::uint64_t>(bytes);
    const auto first_ns = take_number<std::int64_t>(bytes);
    const auto last_ns = take_number<std::int64_t>(bytes);
    const auto flags = take_number<std::uint8_t>(bytes);
    if (block.bytes.begin != offset || block.bytes.end <= offset) return std::nullopt;
    offset = block.bytes.end;
    block.declares = (flags & kDeclaresFlag) != 0;
    if ((flags & kTimedFlag) != 0) {
      block.first_ns = first_ns;
      block.last_ns = last_ns;
    }
    index.push_back(block);
  }
  if (offset != identity.size_bytes) return std::nullopt;
  return index;
}

bool write_index(const fs::path& file, const std::string& bytes) {
  return write_whole_file(file, [&](std::ofstream& out) { out << bytes; }).ok();
}

}  // namespace

std::optional<LogIdentity> identify_log(const fs::path& log) {
  constexpr std::uint64_t kHashedBytes = 65536;
  const Result<ReadableFile> file = ReadableFile::open(log);
  if (!file) return std::nullopt;
  const Result<std::uint64_t> size = file->size_bytes();
  std::error_code failure;
  const fs::file_time_type modified = fs::last_write_time(log, failure);
  if (!size || failure) return std::nullopt;
  LogIdentity identity{
      *size,
      std::chrono::duration_cast<std::chrono::nanoseconds>(modified.time_since_epoch()).count(),
      kHashStart};
  std::vector<std::uint8_t> bytes(std::min(*size, kHashedBytes));
  for (const std::uint64_t offset : {std::uint64_t{0}, *size - bytes.size()}) {
    if (!file->read_at(offset, bytes)) return std::nullopt;
    identity.hash = hash_of(bytes, identity.hash);
  }
  return identity;
}

std::optional<LogIndex> load_log_index(const fs::path& log, const LogIdentity& identity) {
  for (const fs::path& file : {beside(log), in_cache(log)}) {
    if (file.empty()) continue;
    const Result<std::vector<std::uint8_t>> bytes = read_file_bytes(file, kMaxIndexBytes);
    if (!bytes) continue;
    if (std::optional<LogIndex> index = index_in(*bytes, identity)) return index;
  }
  return std::nullopt;
}

void save_log_index(const fs::path& log, const LogIdentity& identity, const LogIndex& index) {
  const std::string bytes = bytes_of_index(identity, index);
  if (bytes.size() > kMaxIndexBytes) return;
  if (in_writable_folder(log) && write_index(beside(log), bytes)) return;
  const fs::path cached = in_cache(log);
  if (cached.empty()) return;
  std::error_code failure;
  fs::create_directories(cached.parent_path(), failure);
  if (!failure) (void)write_index(cached, bytes);
}

}  // namespace overfly::flight::logs
