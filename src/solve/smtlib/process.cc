#include "solve/smtlib/process.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <thread>

extern char** environ;

namespace rondo::solve::smtlib {
namespace {

struct Pipe {
  std::array<int, 2> ends{-1, -1};
  bool Open() { return ::pipe2(ends.data(), O_CLOEXEC) == 0; }
  void Close(int i) {
    if (ends[i] >= 0) ::close(ends[i]);
    ends[i] = -1;
  }
  ~Pipe() {
    Close(0);
    Close(1);
  }
};

}  // namespace

base::Result<ProcessOutput> RunProcess(const std::vector<std::string>& command, const std::string& input,
                                       std::chrono::milliseconds limit, const base::StopToken& stop) {
  Pipe in;
  Pipe out;
  if (!in.Open() || !out.Open()) return base::Error{std::strerror(errno)};
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_adddup2(&actions, in.ends[0], 0);
  posix_spawn_file_actions_adddup2(&actions, out.ends[1], 1);
  posix_spawn_file_actions_addopen(&actions, 2, "/dev/null", O_WRONLY, 0);
  std::vector<char*> argv;
  for (const std::string& word : command) argv.push_back(const_cast<char*>(word.c_str()));
  argv.push_back(nullptr);
  pid_t child = 0;
  const int failure = ::posix_spawnp(&child, argv[0], &actions, nullptr, argv.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  if (failure != 0)
    return base::Error{fmt::format("cannot run `{}`: {}", command[0], std::strerror(failure))};
  in.Close(0);
  out.Close(1);
  ::fcntl(in.ends[1], F_SETFL, O_NONBLOCK);
  // A child that exits early must not kill us with SIGPIPE.
  sigset_t pipe_signal;
  sigset_t old_mask;
  sigemptyset(&pipe_signal);
  sigaddset(&pipe_signal, SIGPIPE);
  pthread_sigmask(SIG_BLOCK, &pipe_signal, &old_mask);

  ProcessOutput result;
  const auto deadline = std::chrono::steady_clock::now() + limit;
  size_t written = 0;
  bool open = true;
  while (open) {
    if (std::chrono::steady_clock::now() >= deadline || stop.StopRequested()) {
      result.timed_out = true;
      ::kill(child, SIGKILL);
      break;
    }
    if (written == input.size()) in.Close(1);
    std::array<pollfd, 2> fds{{{out.ends[0], POLLIN, 0}, {in.ends[1], POLLOUT, 0}}};
    if (::poll(fds.data(), in.ends[1] >= 0 ? 2 : 1, 50) < 0 && errno != EINTR) break;
    if (in.ends[1] >= 0 && (fds[1].revents & (POLLOUT | POLLERR | POLLHUP)) != 0) {
      const ssize_t n = ::write(in.ends[1], input.data() + written, input.size() - written);
      if (n > 0) written += static_cast<size_t>(n);
      if (n < 0 && errno != EAGAIN && errno != EINTR) in.Close(1);
    }
    if ((fds[0].revents & (POLLIN | POLLHUP)) != 0) {
      std::array<char, 4096> buffer;
      const ssize_t n = ::read(out.ends[0], buffer.data(), buffer.size());
      if (n > 0) result.text.append(buffer.data(), static_cast<size_t>(n));
      if (n == 0) open = false;
    }
  }
  // A program that has closed its output may go on for ever.
  int status = 0;
  while (::waitpid(child, &status, WNOHANG) == 0) {
    if (std::chrono::steady_clock::now() >= deadline || stop.StopRequested()) {
      result.timed_out = true;
      ::kill(child, SIGKILL);
      ::waitpid(child, &status, 0);
      break;
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  result.status = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  const timespec none{0, 0};
  while (::sigtimedwait(&pipe_signal, nullptr, &none) > 0) {
  }
  pthread_sigmask(SIG_SETMASK, &old_mask, nullptr);
  return result;
}

}  // namespace rondo::solve::smtlib
