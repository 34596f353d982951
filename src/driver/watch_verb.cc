#include <fmt/chrono.h>
#include <fmt/format.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <ctime>
#include <filesystem>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <thread>
#include <vector>

#include "base/stop.h"
#include "driver/command.h"
#include "driver/terminal.h"
#include "driver/verbs.h"
#include "workspace/checks.h"
#include "workspace/module_files.h"

namespace rondo::driver {

using verdict::ExitStatus;

namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

// What can be done again and again with files.
constexpr const char* kVerbs[] = {"check", "prove",   "explore", "simulate", "reach", "campaign",
                                  "fmt",   "infer",   "graph",   "project",  "plot",  "build",
                                  "solve", "certify", "replay",  "view"};
constexpr auto kLook = std::chrono::milliseconds(100);
constexpr auto kPatience = std::chrono::seconds(2);  // with a run that was asked to end

// What a file looks like from outside: no contents. Editors write a new file and give it the name of the old one.
struct Look {
  bool there = false;
  fs::file_time_type time;
  uintmax_t size = 0;
  friend bool operator==(const Look&, const Look&) = default;
};
using Looks = std::map<std::string, Look>;

Look LookAt(const std::string& path) {
  std::error_code wrong;
  Look look;
  look.time = fs::last_write_time(path, wrong);
  look.there = !wrong;
  if (look.there) look.size = fs::file_size(path, wrong);
  return look.there ? look : Look();
}

// The files that the command names, and what belongs to them.
std::set<std::string> FilesOf(const std::vector<std::string>& words) {
  std::set<std::string> files;
  for (const std::string& word : words) {
    std::error_code wrong;
    if (!fs::is_regular_file(word, wrong)) continue;
    files.insert(word);
    const std::string extension = fs::path(word).extension().string();
    if (extension != ".koord" && extension != ".spec" && !workspace::IsModuleFile(word)) continue;
    if (extension == ".koord") files.insert(fs::path(word).replace_extension(".spec").string());
    workspace::Session session;
    workspace::CheckFile(word, session);
    for (size_t f = 0; f < session.sources.size(); ++f) files.emplace(session.sources.path(diag::FileId(f)));
  }
  return files;
}

Looks LookAtAll(const std::set<std::string>& files) {
  Looks looks;
  for (const std::string& file : files) looks.emplace(file, LookAt(file));
  return looks;
}

// A run of another verb, in a process of its own.
class Child {
 public:
  explicit Child(std::vector<std::string> words) {
    const std::string self = fs::read_symlink("/proc/self/exe").string();
    std::vector<char*> arguments{const_cast<char*>("rondo")};  // NOLINT: exec does not write
    for (std::string& word : words) arguments.push_back(word.data());
    arguments.push_back(nullptr);
    const pid_t parent = ::getpid();
    pid_ = ::fork();
    if (pid_ != 0) return;
    // Only what is allowed between fork and exec.
    ::prctl(PR_SET_PDEATHSIG, SIGTERM);
    if (::getppid() != parent) ::_exit(127);
    ::execv(self.c_str(), arguments.data());
    ::_exit(127);
  }
  Child(const Child&) = delete;
  Child& operator=(const Child&) = delete;
  ~Child() {
    if (Ended()) return;
    ::kill(pid_, SIGINT);
    for (const auto end = Clock::now() + kPatience; Clock::now() < end;
         std::this_thread::sleep_for(kLook / 10)) {
      if (Ended()) return;
    }
    ::kill(pid_, SIGKILL);
    ::waitpid(pid_, nullptr, 0);
  }
  bool Ended() {
    ended_ = ended_ || pid_ <= 0 || ::waitpid(pid_, nullptr, WNOHANG) != 0;
    return ended_;
  }

 private:
  pid_t pid_ = -1;
  bool ended_ = false;
};

void Announce(const std::vector<std::string>& words) {
  // What was said of the text before is no longer true.
  if (::isatty(STDOUT_FILENO) != 0) Print("\x1b[2J\x1b[3J\x1b[H");
  Print(
      fmt::format("-- rondo {} ({:%H:%M:%S})\n", fmt::join(words, " "), fmt::localtime(std::time(nullptr))));
}

ExitStatus Watch(const std::vector<std::string>& words) {
  base::StopToken stop;
  const InterruptScope interrupt(stop);
  // Who was read once is watched from then on: a file may be away for a moment.
  std::set<std::string> files;
  while (!stop.cancelled() && std::ferror(stdout) == 0) {
    files.merge(FilesOf(words));
    const Looks before = LookAtAll(files);
    Announce(words);
    std::fflush(stdout);
    Child child(words);
    bool said = false;
    while (!stop.cancelled() && std::ferror(stdout) == 0 && LookAtAll(files) == before) {
      std::this_thread::sleep_for(kLook);
      if (said || !child.Ended()) continue;
      said = true;
      Print(fmt::format("-- waiting for a change of {}\n", fmt::join(files, ", ")));
      std::fflush(stdout);
    }
    // Several files may be on their way, or one half written.
    std::this_thread::sleep_for(stop.cancelled() ? Clock::duration() : kLook);
  }
  return ExitStatus::kEstablished;
}

}  // namespace

void AddWatchVerb(CLI::App& app, ExitStatus& status) {
  auto verb = std::make_shared<Command>(app, "watch", "do something again whenever a file changes");
  verb->TakeRest();
  verb->Footer(
      "examples:\n"
      "  rondo watch fleet.koord                        # prove it again on each save\n"
      "  rondo watch check cell.rondo\n"
      "  rondo watch simulate fleet.koord --robots 4\n"
      "\n"
      "rondo watch [VERB] FILE... [OPTIONS]: the rest of the command is what is done; without a verb, `prove`. What belongs to\n"
      "a file is watched, too: its specification, its imports. A run that has not ended is stopped when a file changes. What was\n"
      "proved before is not proved again (docs/architecture.md, the proof cache). Ctrl-C ends it.\n"
      "exit status: 0 it was ended, 2 usage");
  verb->Run([verb, &status] {
    std::vector<std::string> words = verb->Rest();
    if (words.empty()) RefuseOption("FILE", "what should be watched?");
    const bool named = std::ranges::find(kVerbs, words[0]) != std::end(kVerbs);
    std::error_code wrong;
    if (!named && !fs::is_regular_file(words[0], wrong))
      RefuseOption(words[0], "is no file, and no verb that can be done again and again");
    if (!named) words.insert(words.begin(), "prove");
    if (std::ranges::none_of(words,
                             [&](const std::string& word) { return fs::is_regular_file(word, wrong); }))
      RefuseOption("FILE", "nothing in this command is a file");
    status = Watch(words);
  });
}

}  // namespace rondo::driver
