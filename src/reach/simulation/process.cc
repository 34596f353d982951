#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>

#include "reach/simulation/simulator.h"

namespace rondo::reach {

namespace {

class Process final : public Simulator {
 public:
  Process(pid_t child, FILE* in, int out, size_t dimension)
      : child_(child), in_(in), out_(out), dimension_(dimension) {}
  Process(const Process&) = delete;
  Process& operator=(const Process&) = delete;
  ~Process() override {
    std::fclose(in_);
    ::close(out_);
    ::kill(child_, SIGTERM);
    int status = 0;
    ::waitpid(child_, &status, 0);
  }

  size_t dimension() const override { return dimension_; }

  base::Result<Trace> Run(std::span<const double> start, double dt, size_t steps) override {
    fmt::print(in_, "{} {:.17g}", steps, dt);
    for (const double x : start) fmt::print(in_, " {:.17g}", x);
    fmt::print(in_, "\n");
    if (std::fflush(in_) != 0) return base::Error{"the simulator does not read any more"};
    Trace trace;
    trace.reserve((steps + 1) * dimension_);
    for (size_t row = 0; row <= steps; ++row) {
      auto line = Line();
      if (!line.ok())
        return base::Error{fmt::format("{}, in line {} of a run", line.error().message, row + 1)};
      const char* at = line.value().c_str();
      for (size_t i = 0; i < dimension_; ++i) {
        char* end = nullptr;
        const double x = std::strtod(at, &end);
        if (end == at || !std::isfinite(x))
          return base::Error{fmt::format("line {} of a run has fewer than {} numbers", row + 1, dimension_)};
        at = end;
        trace.push_back(x);
      }
    }
    return trace;
  }

 private:
  // Up to the next line end; a program that says nothing for ten seconds will not.
  base::Result<std::string> Line() {
    while (true) {
      if (const size_t end = read_.find('\n'); end != std::string::npos) {
        std::string line = read_.substr(0, end);
        read_.erase(0, end + 1);
        return line;
      }
      pollfd ready{out_, POLLIN, 0};
      if (::poll(&ready, 1, 10'000) <= 0) return base::Error{"the simulator does not answer"};
      char chunk[4096];
      const ssize_t got = ::read(out_, chunk, sizeof chunk);
      if (got <= 0) return base::Error{"the simulator has ended"};
      read_.append(chunk, static_cast<size_t>(got));
    }
  }

  pid_t child_;
  FILE* in_;
  int out_;
  std::string read_;
  size_t dimension_;
};

}  // namespace

base::Result<std::unique_ptr<Simulator>> ProcessSimulator(const std::string& command, size_t dimension) {
  int to[2];
  int from[2];
  if (::pipe2(to, O_CLOEXEC) != 0)
    return base::Error{fmt::format("cannot start `{}`: {}", command, std::strerror(errno))};
  if (::pipe2(from, O_CLOEXEC) != 0) {
    ::close(to[0]);
    ::close(to[1]);
    return base::Error{fmt::format("cannot start `{}`: {}", command, std::strerror(errno))};
  }
  const pid_t child = ::fork();
  if (child == 0) {
    ::dup2(to[0], STDIN_FILENO);
    ::dup2(from[1], STDOUT_FILENO);
    ::execl("/bin/sh", "sh", "-c", command.c_str(), static_cast<char*>(nullptr));
    ::_exit(127);
  }
  ::close(to[0]);
  ::close(from[1]);
  if (child < 0) {
    ::close(to[1]);
    ::close(from[0]);
    return base::Error{fmt::format("cannot start `{}`: {}", command, std::strerror(errno))};
  }
  return std::unique_ptr<Simulator>(
      std::make_unique<Process>(child, ::fdopen(to[1], "w"), from[0], dimension));
}

}  // namespace rondo::reach
