#include "runs/children.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <signal.h>
#include <stdlib.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <cstring>
#include <thread>

namespace rondo::runs {

using Clock = std::chrono::steady_clock;

namespace {

constexpr std::chrono::seconds kGrace(5);  // from a request to stop until a process is ended

}  // namespace

base::Result<bool> Children::Start(const std::vector<std::string>& arguments, RobotEnd end) {
  const int out = ::open(end.output.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0644);
  if (out < 0) return base::Error{fmt::format("cannot write `{}`: {}", end.output, std::strerror(errno))};
  std::vector<char*> argv;
  for (const std::string& a : arguments)
    argv.push_back(const_cast<char*>(a.c_str()));  // NOLINT: exec does not write
  argv.push_back(nullptr);
  const pid_t parent = ::getpid();
  const pid_t pid = ::fork();
  if (pid == 0) {
    // Only what is allowed between fork and exec. Ctrl-C is for this process alone: it asks the others to stop.
    ::setpgid(0, 0);
    ::prctl(PR_SET_PDEATHSIG, SIGTERM);
    if (::getppid() != parent) ::_exit(127);
    ::dup2(out, STDOUT_FILENO);
    ::dup2(out, STDERR_FILENO);
    ::execv(argv[0], argv.data());
    ::_exit(127);
  }
  ::close(out);
  if (pid < 0) return base::Error{fmt::format("cannot start a process: {}", std::strerror(errno))};
  children_.push_back({pid, true, std::move(end)});
  return true;
}

size_t Children::Running() {
  size_t running = 0;
  for (Child& child : children_) {
    if (!child.runs) continue;
    int status = 0;
    if (::waitpid(child.pid, &status, WNOHANG) == child.pid) {
      child.runs = false;
      child.end.status = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
      child.end.signal = WIFSIGNALED(status) ? WTERMSIG(status) : 0;
    }
    running += child.runs ? 1 : 0;
  }
  return running;
}

void Children::End() {
  for (const Child& child : children_) {
    if (child.runs) ::kill(child.pid, SIGTERM);
  }
  const auto until = Clock::now() + kGrace;
  while (Running() > 0 && Clock::now() < until) std::this_thread::sleep_for(std::chrono::milliseconds(10));
  for (const Child& child : children_) {
    if (child.runs) ::kill(child.pid, SIGKILL);
  }
  while (Running() > 0) std::this_thread::sleep_for(std::chrono::milliseconds(10));
}

std::vector<RobotEnd> Children::Ends() const {
  std::vector<RobotEnd> ends;
  for (const Child& child : children_) ends.push_back(child.end);
  return ends;
}

void StayOnThisMachine() {
  ::setenv("ROS_LOCALHOST_ONLY", "1", 1);
  ::unsetenv("ROS_AUTOMATIC_DISCOVERY_RANGE");
}

}  // namespace rondo::runs
