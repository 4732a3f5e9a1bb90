#include "server/experiments/jobs/job_folder.hpp"

#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdint>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <random>
#include <system_error>

#include "server/files/whole_file.hpp"

namespace overfly::server::experiments {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

constexpr std::uint64_t kMaxJobBytes = 65536;

bool is_hexadecimal(const std::string& text) {
  return text.find_first_not_of("0123456789abcdef") == std::string::npos;
}

/// "000123-9f3a2c01"
bool is_job_id(const std::string& name) {
  constexpr std::size_t kDash = 6;
  constexpr std::size_t kLength = 15;
  return name.size() == kLength && name[kDash] == '-' && is_hexadecimal(name.substr(0, kDash)) &&
         is_hexadecimal(name.substr(kDash + 1));
}

/// Digests only: the name becomes a path.
bool is_flight_key(const std::string& name) {
  constexpr std::size_t kLongest = 64;
  return !name.empty() && name.size() <= kLongest && is_hexadecimal(name);
}

constexpr const char* kRemoved = ".removed";

bool is_worker_name(const std::string& name) {
  constexpr std::size_t kLongest = 128;
  return !name.empty() && name.size() <= kLongest &&
         std::all_of(name.begin(), name.end(), [](char c) {
           return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
                  c == '-' || c == '_';
         });
}

Error unreadable(const fs::path& file, const std::string& text) {
  return {ErrorCode::kUnreadable, file.string() + ": " + text};
}

Status remove_path(const fs::path& path) {
  std::error_code error;
  fs::remove_all(path, error);
  if (!error) return {};
  return Error{ErrorCode::kIo, path.string() + ": cannot be removed: " + error.message()};
}

Status move_path(const fs::path& from, const fs::path& to) {
  std::error_code error;
  fs::rename(from, to, error);
  if (!error || error == std::errc::no_such_file_or_directory) return {};
  return Error{ErrorCode::kIo,
               from.string() + ": cannot move to " + to.string() + ": " + error.message()};
}

/// Names of jobs that have a file with this extension in a folder, in order.
Result<std::vector<std::string>> jobs_in(const fs::path& folder, const char* extension) {
  std::vector<std::string> jobs;
  std::error_code error;
  for (fs::directory_iterator entry(folder, error), end; !error && entry != end;
       entry.increment(error)) {
    const fs::path& path = entry->path();
    if (path.extension() == extension && is_job_id(path.stem().string())) {
      jobs.push_back(path.stem().string());
    }
  }
  if (error) return Error{ErrorCode::kIo, folder.string() + ": " + error.message()};
  std::sort(jobs.begin(), jobs.end());
  return jobs;
}

/// The fields of a job, a worker or a delivery, with messages that name file and field.
class JobFields {
 public:
  JobFields(const fs::path& file, const Json& values) : file_(file), values_(values) {}

  template <typename T>
  void read(const char* name, T& value) {
    if (error_) return;
    const auto found = values_.find(name);
    if (found == values_.end()) {
      error_ = unreadable(file_, std::string(name) + " is missing");
      return;
    }
    try {
      value = found->template get<T>();
    } catch (const Json::exception&) {
      error_ = unreadable(file_, std::string(name) + " has a value of another type");
    }
  }
  void require(bool valid, const char* text) {
    if (!error_ && !valid) error_ = unreadable(file_, text);
  }
  [[nodiscard]] Status status() const { return error_ ? Status(*error_) : Status(); }

 private:
  const fs::path& file_;
  const Json& values_;
  std::optional<Error> error_;
};

Result<Json> read_object(const fs::path& file) {
  Result<Json> values = read_json(file, kMaxJobBytes);
  if (values && !values->is_object()) return unreadable(file, "is no JSON object");
  return values;
}

}  // namespace

Status JobFolder::create() const {
  for (const char* kind : {"open", "taken", "workers", "delivered", "flights"}) {
    std::error_code error;
    fs::create_directories(folder_ / kind, error);
    if (error) {
      return Error{ErrorCode::kIo,
                   (folder_ / kind).string() + ": cannot create: " + error.message()};
    }
  }
  return {};
}

fs::path JobFolder::file(const char* kind, const std::string& name, const char* extension) const {
  return folder_ / kind / (name + extension);
}

fs::path JobFolder::scenario(const std::string& flight) const {
  return sweep_ / "scenarios" / (flight + ".json");
}

fs::path JobFolder::run(const std::string& job) const { return file("flights", job, ""); }

fs::path JobFolder::output(const std::string& job) const { return file("flights", job, ".txt"); }

Status JobFolder::publish(const OpenJob& job) const {
  return write_json(file("open", job.id),
                    {{"flight", job.flight},
                     {"version", job.version},
                     {"timeout_s", job.timeout_s},
                     {"images_bytes", job.memory.images_bytes},
                     {"caches_bytes", job.memory.caches_bytes}});
}

Status JobFolder::withdraw(const std::string& job) const {
  // In this order: a worker that takes the name again finds that the job is no longer open.
  if (Status status = remove_path(file("open", job)); !status) return status;
  if (Status status = release(job); !status) return status;
  (void)remove_flight(job);  // It may fail while a worker still writes.
  return {};
}

void JobFolder::remove_flights_except(const std::set<std::string>& jobs) const {
  for (const char* extension : {"", ".txt", kRemoved}) {
    const Result<std::vector<std::string>> written = jobs_in(folder_ / "flights", extension);
    if (!written) return;
    for (const std::string& job : *written) {
      if (!jobs.contains(job)) (void)remove_flight(job);
    }
  }
}

Status JobFolder::release(const std::string& job) const {
  return remove_path(file("taken", job, ""));
}

Status JobFolder::remove_flight(const std::string& job) const {
  // Moved first: a process that still writes into the folder would add files as fast as they go.
  const fs::path removed = file("flights", job, kRemoved);
  if (Status status = remove_path(removed); !status) return status;
  if (Status status = move_path(run(job), removed); !status) return status;
  if (Status status = remove_path(removed); !status) return status;
  return remove_path(output(job));
}

Status JobFolder::move_flight(const std::string& job, const FlightJob& to) const {
  if (Status status = move_path(run(job), to.folder); !status) return status;
  return move_path(output(job), to.output);
}

Result<std::vector<std::string>> JobFolder::delivered() const {
  return jobs_in(folder_ / "delivered", ".json");
}

bool JobFolder::is_delivered(const std::string& job) const {
  std::error_code error;
  return fs::exists(file("delivered", job), error);
}

Result<JobDelivery> JobFolder::read_delivery(const std::string& job) const {
  const fs::path path = file("delivered", job);
  const Result<Json> values = read_object(path);
  if (!values) return values.error();
  JobDelivery delivery;
  delivery.job = job;
  JobFields fields(path, *values);
  fields.read("worker", delivery.worker);
  fields.read("duration_s", delivery.duration_s);
  fields.read("timed_out", delivery.timed_out);
  fields.read("reason", delivery.reason);
  fields.require(delivery.duration_s >= 0.0, "duration_s must not be negative");
  if (Status status = fields.status(); !status) return status.error();
  return delivery;
}

Status JobFolder::remove_delivery(const std::string& job) const {
  return remove_path(file("delivered", job));
}

Result<std::optional<std::string>> JobFolder::holder(const std::string& job) const {
  const fs::path path = file("taken", job, "");
  const Result<Json> values = read_object(path);
  if (!values && values.error().code == ErrorCode::kNotFound) return std::optional<std::string>();
  if (!values) return values.error();
  std::string worker;
  JobFields fields(path, *values);
  fields.read("worker", worker);
  fields.require(is_worker_name(worker), "worker is no name of a worker");
  if (Status status = fields.status(); !status) return status.error();
  return std::optional(worker);
}

std::optional<WorkerState> JobFolder::worker(const std::string& name) const {
  const fs::path path = file("workers", name);
  const Result<Json> values = read_object(path);
  if (!values) return std::nullopt;
  WorkerState state;
  state.name = name;
  JobFields fields(path, *values);
  fields.read("beat", state.beat);
  fields.read("over", state.over);
  fields.read("jobs", state.jobs);
  return fields.status() ? std::optional(state) : std::nullopt;
}

Status JobFolder::remove_workers_except(const std::set<std::string>& names) const {
  const fs::path folder = folder_ / "workers";
  std::vector<fs::path> others;
  std::error_code error;
  for (fs::directory_iterator entry(folder, error), end; !error && entry != end;
       entry.increment(error)) {
    if (names.count(entry->path().stem().string()) == 0) others.push_back(entry->path());
  }
  if (error) return Error{ErrorCode::kIo, folder.string() + ": " + error.message()};
  for (const fs::path& other : others) {
    if (Status status = remove_path(other); !status) return status;
  }
  return {};
}

Status JobFolder::set_closed(bool closed) const {
  const fs::path path = folder_ / "closed";
  return closed ? write_whole(path, std::string()) : remove_path(path);
}

bool JobFolder::is_closed() const {
  std::error_code error;
  return fs::exists(folder_ / "closed", error);
}

Result<std::vector<std::string>> JobFolder::open_jobs() const {
  return jobs_in(folder_ / "open", ".json");
}

Result<std::vector<std::string>> JobFolder::taken() const { return jobs_in(folder_ / "taken", ""); }

Result<OpenJob> JobFolder::read_job(const std::string& job) const {
  const fs::path path = file("open", job);
  const Result<Json> values = read_object(path);
  if (!values) return values.error();
  OpenJob open;
  open.id = job;
  JobFields fields(path, *values);
  fields.read("flight", open.flight);
  fields.read("version", open.version);
  fields.read("timeout_s", open.timeout_s);
  fields.read("images_bytes", open.memory.images_bytes);
  fields.read("caches_bytes", open.memory.caches_bytes);
  fields.require(is_flight_key(open.flight), "flight is no digest of a flight");
  fields.require(open.timeout_s > 0.0, "timeout_s must be above 0");
  if (Status status = fields.status(); !status) return status.error();
  return open;
}

bool JobFolder::is_open(const std::string& job) const {
  std::error_code error;
  return fs::exists(file("open", job), error);
}

Result<bool> JobFolder::take(const std::string& job, const std::string& worker) const {
  const fs::path own = file("taken", worker, ".own");
  const fs::path name = file("taken", job, "");
  if (Status status = write_json(own, {{"worker", worker}}); !status) return status.error();
  const bool linked = ::link(own.c_str(), name.c_str()) == 0;
  const int number = errno;
  // The answer of an NFS server can be lost after it made the link: the count of links tells.
  struct stat info {};
  const bool taken = linked || (::stat(own.c_str(), &info) == 0 && info.st_nlink == 2);
  ::unlink(own.c_str());
  if (taken || number == EEXIST) return taken;
  return Error{ErrorCode::kIo,
               name.string() + ": cannot link: " + std::generic_category().message(number)};
}

Status JobFolder::show_worker(const WorkerState& state) const {
  return write_json(file("workers", state.name),
                    {{"beat", state.beat}, {"over", state.over}, {"jobs", state.jobs}});
}

Status JobFolder::deliver(const JobDelivery& delivery) const {
  return write_json(file("delivered", delivery.job),
                    {{"worker", delivery.worker},
                     {"duration_s", delivery.duration_s},
                     {"timed_out", delivery.timed_out},
                     {"reason", delivery.reason}});
}

std::string random_name() {
  std::random_device device;
  std::array<char, 9> text{};
  std::snprintf(text.data(), text.size(), "%08x", static_cast<unsigned>(device()));
  return text.data();
}

}  // namespace overfly::server::experiments
