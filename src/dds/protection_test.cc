#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <atomic>
#include <ctime>
#include <filesystem>
#include <fstream>

#include "dds/domain_test.h"
#include "dds/participant.h"
#include "ros/std_msgs.h"
#include "security/authority.h"
#include "security/rules.h"

namespace rondo::dds {
namespace {

namespace fs = std::filesystem;
using security::Authority;

// A folder with keys, as `rondo keys` makes them.
class Protection : public testing::Test {
 protected:
  Protection() : folder_(fs::temp_directory_path() / ("rondo_protection_" + std::to_string(::getpid()))) {}
  ~Protection() override { fs::remove_all(folder_); }

  static Authority Owner() { return Authority::Make("fleet").value(); }

  void Write(const fs::path& path, const std::string& text) {
    fs::create_directories(path.parent_path());
    std::ofstream(path) << text;
  }

  Network With(const Authority& owner, const security::Enclave& enclave) {
    const fs::path folder = folder_ / std::to_string(++made_);
    const auto identity = owner.Issue(enclave.name).value();
    Write(folder / "cert.pem", identity.certificate);
    Write(folder / "key.pem", identity.key);
    Write(folder / "identity_ca.cert.pem", owner.identity().certificate);
    Write(folder / "permissions_ca.cert.pem", owner.identity().certificate);
    Write(folder / "governance.p7s", owner.Sign(security::Governance()).value());
    Write(folder / "permissions.p7s", owner.Sign(security::Permissions(enclave, std::time(nullptr))).value());
    Network network = TestNetwork();
    network.keys = {folder.string(), enclave.name};
    return network;
  }

  fs::path folder_;
  int made_ = 0;
};

const security::Enclave kTalker{"/talker", {"rt/chatter", "ros_discovery_info"}, {"ros_discovery_info"}};
const security::Enclave kListener{"/listener", {"ros_discovery_info"}, {"rt/chatter", "ros_discovery_info"}};

// A process has one identity: each part is played by one of its own.
class Process {
 public:
  explicit Process(const std::function<bool()>& plays) : pid_(::fork()) {
    if (pid_ == 0) ::_exit(plays() ? 0 : 1);
  }
  Process(const Process&) = delete;
  Process& operator=(const Process&) = delete;
  ~Process() {
    if (pid_ <= 0) return;
    ::kill(pid_, SIGKILL);
    ::waitpid(pid_, nullptr, 0);
  }
  // Waits until it ends; returns whether all was well.
  bool Ended() {
    int status = 0;
    const bool good = ::waitpid(pid_, &status, 0) == pid_ && WIFEXITED(status) && WEXITSTATUS(status) == 0;
    pid_ = 0;
    return good;
  }

 private:
  pid_t pid_;
};

// Says who it is, again and again.
bool Talk(const Network& network, const std::string& name) {
  const auto opened = Participant::Open(network);
  if (!opened.ok()) return false;
  Participant& participant = *opened.value();
  const auto publisher = participant.Publish(participant.AddNode({"/talker", name}), "/chatter",
                                             ros::std_msgs::String::kMessage, ros::kDefault);
  if (!publisher.ok()) return false;
  ros::std_msgs::String message;
  message.data = name + std::string(100'000, 'x');
  for (int i = 0; i < 1000; ++i) {
    if (!publisher.value()->Publish(message).ok()) return false;
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  return true;
}

// Listens until it heard a friend a hundred times, so many seconds at most. Returns whether `good` is true of how often it heard a friend, and
// somebody else.
bool Listen(const Network& network, double seconds, const std::function<bool(int, int)>& good) {
  const auto opened = Participant::Open(network);
  if (!opened.ok()) return false;
  Participant& participant = *opened.value();
  std::atomic<int> friends = 0, others = 0;
  const auto subscription = participant.Subscribe(
      participant.AddNode({"/listener", "node"}), "/chatter", ros::std_msgs::String::kMessage, ros::kDefault,
      [&](std::string_view bytes, const Received&) {
        ros::std_msgs::String message;
        if (ros::Parse(bytes, message)) ++(message.data.starts_with("friend") ? friends : others);
      });
  if (!subscription.ok()) return false;
  for (int i = 0; i < 100 * seconds && friends < 100; ++i)
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  return good(friends, others);
}

TEST_F(Protection, WhoHasKeysOfTheOwnerIsHeardAndStrangersAreNot) {
  const Authority owner = Owner(), other = Owner();
  const Network talker = With(owner, kTalker), listener = With(owner, kListener),
                foreign = With(other, kTalker);
  Process hears([&] {
    return Listen(listener, 10, [](int friends, int others) { return friends >= 100 && others == 0; });
  });
  Process spies([&] { return Listen(TestNetwork(), 4, [](int friends, int) { return friends == 0; }); });
  const Process strange([&] { return Talk(TestNetwork(), "stranger"); });
  const Process of_others([&] { return Talk(foreign, "stranger"); });
  const Process says([&] { return Talk(talker, "friend"); });
  EXPECT_TRUE(hears.Ended());
  EXPECT_TRUE(spies.Ended());
}

TEST_F(Protection, NobodyDoesWhatItsPermissionsDoNotSay) {
  const Authority owner = Owner();
  const Network listener = With(owner, kListener);
  Process speaks([&] { return Talk(listener, "listener"); });
  EXPECT_FALSE(speaks.Ended());
  // What its own library would let it say, the others do not take: these permissions let it, and somebody else signed them.
  Network forged = With(owner, kListener);
  Write(fs::path(forged.keys.folder) / "permissions.p7s",
        Owner().Sign(security::Permissions({"/listener", {"*"}, {"*"}}, std::time(nullptr))).value());
  Process lies([&] { return Talk(forged, "liar"); });
  EXPECT_FALSE(lies.Ended());
}

TEST_F(Protection, KeysThatAreMissingAreAnErrorWithWords) {
  const Network network = With(Owner(), kTalker);
  fs::remove(fs::path(network.keys.folder) / "key.pem");
  Process fails([&] {
    const auto refused = Participant::Open(network);
    if (refused.ok()) return false;
    return refused.error().message.find("key.pem") != std::string::npos;
  });
  EXPECT_TRUE(fails.Ended());
}

}  // namespace
}  // namespace rondo::dds
