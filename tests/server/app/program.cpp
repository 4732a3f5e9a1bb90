#include "tests/server/app/program.hpp"

#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <stdexcept>

#include "tests/support/support.hpp"

namespace overfly::testing {
namespace {

void redirect(const std::filesystem::path& file, int descriptor) {
  const int opened = ::open(file.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0644);
  ::dup2(opened, descriptor);
  ::close(opened);
}

}  // namespace

RunningProgram::RunningProgram(const std::vector<std::string>& arguments,
                               const std::filesystem::path& folder,
                               const std::filesystem::path& out)
    : folder_(folder) {
  std::vector<std::string> all = {OVERFLY_PROGRAM};
  all.insert(all.end(), arguments.begin(), arguments.end());
  std::vector<char*> argv;
  argv.reserve(all.size() + 1);
  for (std::string& argument : all) argv.push_back(argument.data());
  argv.push_back(nullptr);
  const std::filesystem::path own_out = folder_ / "out.txt";
  const std::filesystem::path err = folder_ / "err.txt";
  write_text(own_out, "");  // there to be read before the child has opened it
  write_text(err, "");
  pid_ = ::fork();
  if (pid_ < 0) throw std::runtime_error("fork failed");
  if (pid_ == 0) {
    redirect(out.empty() ? own_out : out, STDOUT_FILENO);
    redirect(err, STDERR_FILENO);
    ::execv(OVERFLY_PROGRAM, argv.data());
    ::_exit(127);
  }
}

RunningProgram::~RunningProgram() {
  if (pid_ < 0) return;
  ::kill(pid_, SIGKILL);
  ::waitpid(pid_, &status_, 0);
}

void RunningProgram::signal(int number) const { ::kill(pid_, number); }

int RunningProgram::wait() {
  if (pid_ >= 0) ::waitpid(pid_, &status_, 0);
  pid_ = -1;
  return WIFEXITED(status_) ? WEXITSTATUS(status_) : -1;
}

bool RunningProgram::running() {
  if (pid_ >= 0 && ::waitpid(pid_, &status_, WNOHANG) == pid_) pid_ = -1;
  return pid_ >= 0;
}

std::string RunningProgram::out() const { return read_text(folder_ / "out.txt"); }
std::string RunningProgram::err() const { return read_text(folder_ / "err.txt"); }

Outcome overfly_program(const std::vector<std::string>& arguments,
                        const std::filesystem::path& out) {
  const TemporaryFolder folder;
  RunningProgram program(arguments, folder.path(), out);
  const int exit_code = program.wait();
  return {exit_code, program.out(), program.err()};
}

}  // namespace overfly::testing
