#include "vo_bridges/process/options.hpp"

#include <sched.h>

#include <cmath>
#include <string>
#include <string_view>

#include "vo_bridges/estimator_text.hpp"
#include "vo_bridges/process/link/wire.hpp"

namespace overfly::process {

namespace {

Status check_number(const char* name, double value, double low, double high, const char* limit) {
  if (value >= low && value <= high) return {};
  return Error{ErrorCode::kInvalidArgument,
               std::string(name) + " = " + std::to_string(value) + ": must be " + limit};
}

/// The CPUs available to this program, as "0-1,4".
std::string allowed_cpus(const cpu_set_t& set) {
  std::string text;
  for (std::size_t cpu = 0; cpu < CPU_SETSIZE; ++cpu) {
    if (!CPU_ISSET(cpu, &set)) continue;
    std::size_t last = cpu;
    while (last + 1 < CPU_SETSIZE && CPU_ISSET(last + 1, &set)) ++last;
    if (!text.empty()) text += ",";
    text += std::to_string(cpu);
    if (last > cpu) text += std::string("-") + std::to_string(last);
    cpu = last;
  }
  return text;
}

Status check_cpus(const std::vector<int>& cpus) {
  cpu_set_t allowed;
  CPU_ZERO(&allowed);
  ::sched_getaffinity(0, sizeof(allowed), &allowed);
  for (std::size_t i = 0; i < cpus.size(); ++i) {
    if (cpus[i] >= 0 && cpus[i] < CPU_SETSIZE &&
        CPU_ISSET(static_cast<std::size_t>(cpus[i]), &allowed)) {
      continue;
    }
    return Error{ErrorCode::kInvalidArgument,
                 "cpus[" + std::to_string(i) + "] = " + std::to_string(cpus[i]) +
                     ": this machine offers " + allowed_cpus(allowed)};
  }
  return {};
}

Status check_parameters(const VoParameters& parameters) {
  std::size_t bytes = 0;
  for (const auto& [name, value] : parameters) {
    const std::string text = text_of(value);
    if (name.empty() || name.find_first_of(" \n") != std::string::npos) {
      return Error{
          ErrorCode::kInvalidArgument,
          "parameters: the name '" + printable(name) + "' must not be empty or contain spaces"};
    }
    if (text.find('\n') != std::string::npos) {
      return Error{ErrorCode::kInvalidArgument, "parameters." + name + ": must be one line"};
    }
    bytes += name.size() + text.size() + 16;
  }
  if (bytes + 64 <= kTextLimitBytes) return {};
  return Error{ErrorCode::kInvalidArgument,
               "parameters: names and values have " + std::to_string(bytes) +
                   " bytes: must be at most 65000"};
}

}  // namespace

Status validate(const ProcessEstimatorOptions& options) {
  const auto bad = [](const char* what) { return Error{ErrorCode::kInvalidArgument, what}; };
  if (options.command.empty() && options.listen.empty()) {
    return bad("command and listen are both empty: one of them is required");
  }
  if (!options.command.empty() && options.command[0].empty()) return bad("command[0]: is empty");
  if (options.command.empty() && options.listen.starts_with("tcp:") &&
      options.listen.ends_with(":0")) {
    return bad("listen: port 0 requires a command, which receives the assigned port");
  }
  for (const Status& status :
       {check_number("start_timeout_s", options.start_timeout_s, 1e-3, 3600.0, "in (0, 3600]"),
        check_number("answer_timeout_s", options.answer_timeout_s, 1e-3, 3600.0, "in (0, 3600]"),
        check_number("rate_hz", options.rate_hz, 0.0, 10000.0, "in [0, 10000]"),
        check_number("memory_limit_mb", options.memory_limit_mb, 0.0, 1e9, "in [0, 1e9]"),
        check_cpus(options.cpus),
        check_parameters(options.parameters)}) {
    if (!status) return status;
  }
  if (options.command.empty() && !options.cpus.empty()) {
    return bad("cpus: requires command, because only a program started here can be bound to CPUs");
  }
  if (options.command.empty() && options.memory_limit_mb > 0.0) {
    return bad(
        "memory_limit_mb: requires command, because only a program started here can be limited");
  }
  return {};
}

}  // namespace overfly::process
