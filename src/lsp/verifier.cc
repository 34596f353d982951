#include "lsp/verifier.h"

#include <fcntl.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>

namespace rondo::lsp {

void Verifier::Start(const std::string& file, int64_t version) {
  Cancel();
  file_ = file;
  version_ = version;
  text_.clear();
  std::array<int, 2> ends{};
  if (executable_.empty() || ::pipe2(ends.data(), O_CLOEXEC) != 0) return;
  const pid_t parent = ::getpid();
  const pid_t pid = ::fork();
  if (pid == 0) {
    // Only what is allowed between fork and exec.
    ::setpgid(0, 0);
    ::prctl(PR_SET_PDEATHSIG, SIGKILL);
    if (::getppid() != parent) ::_exit(127);
    const int nothing = ::open("/dev/null", O_RDWR);
    ::dup2(nothing, STDIN_FILENO);
    ::dup2(ends[1], STDOUT_FILENO);
    ::dup2(nothing, STDERR_FILENO);
    ::execl(executable_.c_str(), executable_.c_str(), "prove", file_.c_str(), "--json", nullptr);
    ::_exit(127);
  }
  ::close(ends[1]);
  if (pid < 0) {
    ::close(ends[0]);
    return;
  }
  child_ = pid;
  pipe_ = ends[0];
}

void Verifier::Cancel() {
  if (pipe_ < 0) return;
  ::close(pipe_);
  pipe_ = -1;
  // With the solvers that it may have started.
  ::kill(-child_, SIGKILL);
  ::kill(child_, SIGKILL);
  ::waitpid(child_, nullptr, 0);
}

std::optional<nlohmann::json> Verifier::Read() {
  std::array<char, 65536> bytes{};
  const ssize_t count = ::read(pipe_, bytes.data(), bytes.size());
  if (count > 0) text_.append(bytes.data(), static_cast<size_t>(count));
  if (count > 0 || (count < 0 && errno == EINTR)) return std::nullopt;
  ::close(pipe_);
  pipe_ = -1;
  ::waitpid(child_, nullptr, 0);
  nlohmann::json result = nlohmann::json::parse(text_, nullptr, false);
  return result.is_object() ? result : nlohmann::json::object();
}

}  // namespace rondo::lsp
