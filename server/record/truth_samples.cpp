#include "server/record/truth_samples.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <optional>
#include <utility>

#include "core/motion/wrapped_truth.hpp"
#include "core/time.hpp"
#include "server/files/file_field.hpp"

namespace overfly::server {
namespace {

namespace fs = std::filesystem;

static_assert(std::endian::native == std::endian::little);

constexpr std::size_t kValues = kTruthSampleBytes / 8 - 1;

using SampleBytes = std::array<std::uint8_t, kTruthSampleBytes>;

SampleBytes bytes_of(const AircraftState& state) {
  const Eigen::Vector3d& p = state.T_world_body.translation;
  const Eigen::Quaterniond& q = state.T_world_body.rotation;
  const Eigen::Vector3d& v = state.v_body_world_m_s;
  const Eigen::Vector3d& w = state.omega_body_rad_s;
  const std::array<double, kValues> values = {p.x(),
                                              p.y(),
                                              p.z(),
                                              q.x(),
                                              q.y(),
                                              q.z(),
                                              q.w(),
                                              v.x(),
                                              v.y(),
                                              v.z(),
                                              w.x(),
                                              w.y(),
                                              w.z(),
                                              state.airspeed_m_s};
  SampleBytes bytes;
  std::memcpy(bytes.data(), &state.t_ns, 8);
  std::memcpy(bytes.data() + 8, values.data(), sizeof(values));
  return bytes;
}

/// Limits of a plausible flight. Beyond them the arithmetic of the renderers could overflow.
constexpr double kMaxDistanceM = 1e8;
constexpr double kMaxRate = 1e6;  ///< of position [m/s], rotation [rad/s] and airspeed [m/s]

/// Empty for values that no state can have.
std::optional<AircraftState> state_from(const std::uint8_t* bytes) {
  std::array<double, kValues> v;
  std::memcpy(v.data(), bytes + 8, sizeof(v));
  // A comparison with a value that is not a number is false.
  const auto within = [&](std::size_t begin, std::size_t end, double limit) {
    return std::all_of(
        v.begin() + begin, v.begin() + end, [&](double value) { return std::abs(value) <= limit; });
  };
  if (!within(0, 3, kMaxDistanceM) || !within(3, 7, 2.0) || !within(7, kValues, kMaxRate)) {
    return std::nullopt;
  }
  AircraftState state;
  std::memcpy(&state.t_ns, bytes, 8);
  if (state.t_ns < 0 || state.t_ns > kLargestFileInteger) return std::nullopt;
  state.T_world_body.translation = {v[0], v[1], v[2]};
  state.T_world_body.rotation = Eigen::Quaterniond(v[6], v[3], v[4], v[5]);
  if (std::abs(state.T_world_body.rotation.norm() - 1.0) > 1e-6) return std::nullopt;
  state.v_body_world_m_s = {v[7], v[8], v[9]};
  state.omega_body_rad_s = {v[10], v[11], v[12]};
  state.airspeed_m_s = v[13];
  return state;
}

class RecordedWhileFlown final : public WrappedTruth {
 public:
  RecordedWhileFlown(std::unique_ptr<TruthSource> flight, TruthSampleFile& file)
      : WrappedTruth(std::move(flight)), file_(file) {}

 private:
  [[nodiscard]] Result<std::optional<AircraftState>> find_state(
      std::int64_t t_ns, const std::atomic<bool>* cancel) override {
    while (true) {
      const std::int64_t sample_ns = frame_time_ns(next_sample_, {kTruthSampleHz, 1});
      if (sample_ns > t_ns) break;
      ++next_sample_;
      if (sample_ns == t_ns) break;
      const auto sample = record(sample_ns, cancel);
      if (!sample || !*sample) return sample;
    }
    return record(t_ns, cancel);
  }

  Result<std::optional<AircraftState>> record(std::int64_t t_ns, const std::atomic<bool>* cancel) {
    auto state = flight().state_at(t_ns, cancel);
    if (!state || !*state) return state;
    (*state)->t_ns = t_ns;
    if (t_ns > recorded_ns_) file_.add(**state);
    recorded_ns_ = std::max(recorded_ns_, t_ns);
    return state;
  }

  TruthSampleFile& file_;
  std::int64_t next_sample_ = 0;   ///< index of the next sample of the regular grid
  std::int64_t recorded_ns_ = -1;  ///< time of the last sample in the file
};

/// Blocks of samples are read when a time in them is requested; their first times are known.
class RecordedFlight final : public TruthSource {
 public:
  RecordedFlight(ReadableFile file,
                 fs::path name,
                 std::string description,
                 std::optional<std::int64_t> log_start_ns)
      : file_(std::move(file)),
        name_(std::move(name)),
        description_(std::move(description)),
        log_start_ns_(log_start_ns) {}

  /// Finds samples that were added to the file.
  Status read_on() {
    const Result<std::uint64_t> size = file_.size_bytes();
    if (!size) return size.error();
    const std::uint64_t count = *size / kTruthSampleBytes;
    if (count <= count_) return {};
    // What was known stays valid if the new part is not.
    std::vector<std::int64_t> times_ns = block_times_ns_;
    for (std::uint64_t first = times_ns.size() * kBlock; first < count; first += kBlock) {
      const auto state = read_sample(first);
      if (!state) return state.error();
      if (!times_ns.empty() && state->t_ns <= std::max(times_ns.back(), end_ns_)) {
        return invalid(first);
      }
      times_ns.push_back(state->t_ns);
    }
    const auto last = read_sample(count - 1);
    if (!last) return last.error();
    if (last->t_ns < times_ns.back()) return invalid(count - 1);
    block_times_ns_ = std::move(times_ns);
    count_ = count;
    end_ns_ = last->t_ns;
    block_index_.reset();
    return {};
  }

  [[nodiscard]] std::optional<std::int64_t> duration_ns() const override { return end_ns_; }
  [[nodiscard]] std::string description() const override { return description_; }
  [[nodiscard]] std::optional<std::int64_t> log_start_ns() const override { return log_start_ns_; }

 private:
  static constexpr std::uint64_t kBlock = 1024;

  [[nodiscard]] Result<std::optional<AircraftState>> find_state(
      std::int64_t t_ns, const std::atomic<bool>* /*cancel*/) override {
    if (t_ns > end_ns_) {
      if (Status status = read_on(); !status) return status.error();
    }
    if (count_ == 0 || t_ns > end_ns_) return std::optional<AircraftState>();
    const auto after = std::upper_bound(block_times_ns_.begin(), block_times_ns_.end(), t_ns);
    if (after == block_times_ns_.begin()) {
      return Error{ErrorCode::kInvalidArgument,
                   "t_ns = " + std::to_string(t_ns) + ": the recorded flight spans [" +
                       std::to_string(block_times_ns_.front()) + ", " + std::to_string(end_ns_) +
                       "] ns"};
    }
    Status loaded = load(static_cast<std::uint64_t>(after - block_times_ns_.begin()) - 1);
    if (!loaded) return loaded.error();
    const auto next = std::lower_bound(
        block_.begin(), block_.end(), t_ns, [](const AircraftState& state, std::int64_t t) {
          return state.t_ns < t;
        });
    if (next->t_ns == t_ns) return std::optional(*next);
    return std::optional(interpolate(*std::prev(next), *next, t_ns));
  }

  /// Reads a block and the first sample of the next one.
  Status load(std::uint64_t index) {
    if (block_index_ == index) return {};
    block_index_.reset();
    const std::uint64_t first = index * kBlock;
    const std::uint64_t samples = std::min(kBlock + 1, count_ - first);
    std::vector<std::uint8_t> bytes(samples * kTruthSampleBytes);
    if (Status status = file_.read_at(first * kTruthSampleBytes, bytes); !status) return status;
    block_.clear();
    for (std::uint64_t i = 0; i < samples; ++i) {
      const auto state = state_from(bytes.data() + i * kTruthSampleBytes);
      if (!state || (i > 0 && state->t_ns <= block_.back().t_ns)) return invalid(first + i);
      block_.push_back(*state);
    }
    // The times by which the block was found.
    if (block_.front().t_ns != block_times_ns_[index]) return invalid(first);
    const std::int64_t until_ns = samples > kBlock ? block_times_ns_[index + 1] : end_ns_;
    if (block_.back().t_ns != until_ns) return invalid(first + samples - 1);
    block_index_ = index;
    return {};
  }

  [[nodiscard]] Result<AircraftState> read_sample(std::uint64_t index) const {
    SampleBytes bytes;
    if (Status status = file_.read_at(index * kTruthSampleBytes, bytes); !status) {
      return status.error();
    }
    const auto state = state_from(bytes.data());
    if (!state) return invalid(index);
    return *state;
  }

  [[nodiscard]] Error invalid(std::uint64_t index) const {
    return {ErrorCode::kUnreadable,
            name_.string() + ": sample " + std::to_string(index) +
                ": must have values within their limits, a unit quaternion and a later time than "
                "the sample before it"};
  }

  ReadableFile file_;
  fs::path name_;
  std::string description_;
  std::optional<std::int64_t> log_start_ns_;
  std::uint64_t count_ = 0;
  std::int64_t end_ns_ = 0;
  std::vector<std::int64_t> block_times_ns_;  ///< of the first sample of each block
  std::optional<std::uint64_t> block_index_;
  std::vector<AircraftState> block_;  ///< of block_index_
};

}  // namespace

Result<TruthSampleFile> TruthSampleFile::create(const fs::path& file) {
  Result<AppendFile> created = AppendFile::create(file);
  if (!created) return created.error();
  return TruthSampleFile(std::move(*created));
}

void TruthSampleFile::add(const AircraftState& state) {
  const SampleBytes bytes = bytes_of(state);
  pending_.insert(pending_.end(), bytes.begin(), bytes.end());
}

Status TruthSampleFile::flush() {
  const Status written = file_.append(pending_);
  pending_.clear();
  return written;
}

std::unique_ptr<TruthSource> recorded_while_flown(std::unique_ptr<TruthSource> flight,
                                                  TruthSampleFile& file) {
  return std::make_unique<RecordedWhileFlown>(std::move(flight), file);
}

Result<std::unique_ptr<TruthSource>> open_recorded_flight(
    const fs::path& file,
    const std::string& description,
    std::optional<std::int64_t> log_start_ns) {
  Result<ReadableFile> opened = ReadableFile::open(file);
  if (!opened) return opened.error();
  auto flight =
      std::make_unique<RecordedFlight>(std::move(*opened), file, description, log_start_ns);
  if (Status status = flight->read_on(); !status) return status.error();
  return std::unique_ptr<TruthSource>(std::move(flight));
}

}  // namespace overfly::server
