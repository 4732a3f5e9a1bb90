#include "flight/playback/tlog_records.hpp"

#include <algorithm>
#include <utility>
#include <vector>

#include "flight/logs/boot_clock.hpp"
#include "flight/logs/held_messages.hpp"
#include "flight/logs/tlog/tlog_reader.hpp"

namespace overfly::flight::playback {
namespace {

constexpr std::size_t kReceptionBytes = 8;
/// Bytes that surely hold a whole record, and that decide whether a file is a telemetry log.
constexpr std::size_t kRecordWindowBytes = 4096;
/// A pause in a recording is played as this at most: 1 day.
constexpr std::uint64_t kLongestUs = 86'400'000'000;

std::uint64_t reception_us(std::span<const std::uint8_t> prefix) {
  std::uint64_t value = 0;
  for (const std::uint8_t byte : prefix) value = (value << 8U) | byte;
  return value;
}

}  // namespace

TlogRecords::TlogRecords(ForwardReader file)
    : file_(std::move(file)), finder_(kReceptionBytes), size_bytes_(file_.size_bytes()) {}

void TlogRecords::rewind() {
  file_.only({{0, size_bytes_}});
  finder_ = mavlink::FrameFinder(kReceptionBytes);
  consumed_ = 0;
  read_ = 0;
  last_us_ = 0;
}

Status TlogRecords::find_first_stamp() {
  constexpr std::uint64_t kMostUs = std::uint64_t{1} << 52U;  // its nanoseconds fit
  logs::BootClock clock;
  std::vector<std::uint64_t> stamps_us;
  while (!clock.proven() && stamps_us.size() < logs::kMostHeld) {
    const auto record = next();
    if (!record) return record.error();
    if (!*record) break;
    stamps_us.push_back(stamp_us_);
    (void)clock.take(stamp_us_ < kMostUs ? static_cast<std::int64_t>(stamp_us_) * 1000 : -1);
  }
  if (clock.proven() && clock.first_were_wrong()) {
    wrong_first_ = stamps_us.size() - logs::BootClock::kBelieved;
  }
  if (!stamps_us.empty()) first_us_ = stamps_us[wrong_first_];
  rewind();
  return {};
}

Result<TlogRecords> TlogRecords::open(const std::filesystem::path& file) {
  Result<ForwardReader> reader = ForwardReader::open(file);
  if (!reader) return reader.error();
  const auto head = reader->ahead(kRecordWindowBytes);
  if (!head) return head.error();
  if (!logs::is_tlog(head->first(std::min(head->size(), kRecordWindowBytes)))) {
    return Error{ErrorCode::kUnreadable, file.string() + ": is no telemetry log (.tlog)"};
  }
  TlogRecords records(std::move(*reader));
  if (Status status = records.find_first_stamp(); !status) return status.error();
  while (true) {
    const auto record = records.next();
    if (!record) return record.error();
    if (!*record) break;
    ++records.count_;
    records.duration_us_ = (*record)->t_us;
  }
  records.rewind();
  return records;
}

Status TlogRecords::seek(std::int64_t t_us) {
  // Records cannot be found backwards: the file is read again from its start.
  rewind();
  begin_us_ = t_us;
  return {};
}

Result<std::optional<TlogRecords::Record>> TlogRecords::next() {
  while (true) {
    file_.skip(std::exchange(consumed_, 0));
    const auto bytes = file_.ahead(kRecordWindowBytes);
    if (!bytes) return bytes.error();
    if (bytes->empty()) return std::optional<Record>();
    const bool last = bytes->size() < kRecordWindowBytes;
    const mavlink::FrameFinder::Found found = finder_.next(*bytes, last);
    consumed_ = found.consumed_bytes;
    if (!found.frame) {
      if (last && consumed_ == 0) return std::optional<Record>();
      continue;
    }
    stamp_us_ = reception_us(found.prefix);
    const std::uint64_t since = stamp_us_ > first_us_ ? stamp_us_ - first_us_ : 0;
    const bool wrong = read_++ < wrong_first_;
    // A stamp far ahead is damage: it must not stop the playback.
    if (!wrong && since <= static_cast<std::uint64_t>(last_us_) + kLongestUs) {
      last_us_ = std::max(last_us_, static_cast<std::int64_t>(since));
    }
    if (last_us_ < begin_us_) continue;
    return std::optional(Record{last_us_, found.bytes});
  }
}

}  // namespace overfly::flight::playback
