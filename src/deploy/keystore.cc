#include "deploy/keystore.h"

#include <fmt/format.h>

#include <algorithm>
#include <ctime>
#include <filesystem>

#include "base/file.h"
#include "deploy/echo.h"
#include "platform/ports.h"
#include "platform/senses.h"
#include "ros/names.h"
#include "security/authority.h"
#include "transport/dds/way.h"

namespace rondo::deploy {

namespace fs = std::filesystem;
using platform::Topic;
using security::Authority;
using security::Enclave;

namespace {

constexpr const char* kDiscovery = "ros_discovery_info";

std::string OnWire(const std::string& topic) { return ros::WireTopic(topic); }

// Adds a topic, and those that lie beside it.
void Add(std::vector<std::string>& topics, const Topic& topic) {
  if (!topic.library.empty()) return;
  topics.push_back(OnWire(topic.name));
  for (const std::string& more : platform::TopicsBeside(topic)) topics.push_back(OnWire(more));
}

void Add(std::vector<std::string>& topics, std::initializer_list<std::string> names) {
  for (const std::string& name : names) topics.push_back(OnWire(name));
}

void Sort(std::vector<std::string>& topics) {
  std::ranges::sort(topics);
  topics.erase(std::unique(topics.begin(), topics.end()), topics.end());
}

// What has to be the same on all robots, as its owner signs it.
std::string ManifestOf(const RobotOptions& texts) {
  return fmt::format("rondo-files/1\nprogram {}\nspecification {}\nfleet {}\nfiles {}\n",
                     security::Sha256(texts.program), security::Sha256(texts.spec),
                     security::Sha256(texts.fleet), security::Sha256(texts.files.dump()));
}

// S/MIME ends lines as mails do.
std::string Plain(std::string text) {
  std::erase(text, '\r');
  return text;
}

// Files of one folder; the first failure stays.
class Folder {
 public:
  explicit Folder(fs::path path) : path_(std::move(path)) {}

  // A folder that is not there is made for its owner alone.
  void Make(const fs::path& folder) {
    std::error_code failed;
    const bool fresh = fs::create_directories(path_ / folder, failed);
    if (!failed && fresh) fs::permissions(path_ / folder, fs::perms::owner_all, failed);
    if (failed && why_.empty())
      why_ = fmt::format("cannot use the folder `{}`: {}", (path_ / folder).string(), failed.message());
  }
  bool Has(const fs::path& file) const {
    std::error_code ignored;
    return fs::exists(path_ / file, ignored);
  }
  std::string Read(const fs::path& file) {
    auto text = base::ReadFile((path_ / file).string());
    if (!text.ok() && why_.empty())
      why_ = fmt::format("cannot read `{}`: {}", (path_ / file).string(), text.error().message);
    return text.ok() ? std::move(text).value() : std::string();
  }
  void Write(const fs::path& file, const std::string& text) {
    if (!why_.empty()) return;
    const auto written = base::WriteFileAtomically((path_ / file).string(), text);
    if (!written.ok())
      why_ = fmt::format("cannot write `{}`: {}", (path_ / file).string(), written.error().message);
  }
  // A key, which nobody else may read.
  void WriteKey(const fs::path& file, const std::string& text) {
    Write(file, text);
    std::error_code failed;
    if (why_.empty()) fs::permissions(path_ / file, fs::perms::owner_read | fs::perms::owner_write, failed);
    if (failed && why_.empty())
      why_ = fmt::format("cannot keep `{}` from others: {}", (path_ / file).string(), failed.message());
  }
  void Sign(const Authority& authority, const fs::path& file, const std::string& text) {
    const auto signature = authority.Sign(text);
    if (!signature.ok() && why_.empty()) why_ = signature.error().message;
    if (signature.ok()) Write(file, signature.value());
  }
  const std::string& why() const { return why_; }

 private:
  fs::path path_;
  std::string why_;
};

base::Result<Authority> OwnerOf(Folder& folder, bool& fresh) {
  folder.Make("");
  folder.Make("public");
  folder.Make("private");
  fresh = !folder.Has("private/ca.key.pem");
  if (!fresh) {
    const security::Identity kept{folder.Read("public/ca.cert.pem"), folder.Read("private/ca.key.pem")};
    if (!folder.why().empty()) return base::Error{folder.why()};
    return Authority::Load(kept);
  }
  auto made = Authority::Make("owner of a fleet");
  if (!made.ok()) return made.error();
  const security::Identity& identity = made.value().identity();
  // What `ros2 security` looks for when it makes keys for nodes of ROS.
  for (const char* name : {"ca", "identity_ca", "permissions_ca"}) {
    folder.Write(fmt::format("public/{}.cert.pem", name), identity.certificate);
    folder.WriteKey(fmt::format("private/{}.key.pem", name), identity.key);
  }
  return made;
}

}  // namespace

std::string EnclaveOf(const sim::FleetRobot& robot) { return "/" + robot.node_namespace; }

std::vector<Enclave> EnclavesOf(const koord::Model& model, const sim::Fleet& fleet,
                                const std::string& program_name, diag::Diagnostics& diagnostics) {
  const std::vector<sim::Port> ports = platform::PortsOf(model, fleet, diagnostics);
  if (diagnostics.has_errors()) return {};
  Enclave bodies{kBodiesEnclave, {kDiscovery}, {kDiscovery}},
      doctor{kDoctorEnclave, {kDiscovery}, {kDiscovery}};
  const std::string name = ros::Plain(program_name);
  const auto frames = [&](const std::string& whom) { return transport::dds::FramesTopic(name, whom); };
  Add(bodies.publishes, {"/tf", "/clock"});
  Add(bodies.subscribes, {"/diagnostics"});
  Add(doctor.subscribes, {"/diagnostics"});
  std::vector<Enclave> all;
  for (size_t r = 0; r < fleet.robots.size(); ++r) {
    Enclave& robot = all.emplace_back();
    robot.name = EnclaveOf(fleet.robots[r]);
    robot.publishes = robot.subscribes = {kDiscovery};
    const EchoTopics echo = EchoTopicsOf(fleet, r);
    Add(robot.publishes, {"/diagnostics", "/rosout", echo.answers, frames("all")});
    Add(robot.subscribes,
        {"/tf", "/tf_static", "/clock", echo.questions, frames("all"), frames(fleet.robots[r].name)});
    for (const sim::FleetRobot& other : fleet.robots) Add(robot.publishes, {frames(other.name)});
    Add(doctor.publishes, {echo.questions});
    Add(doctor.subscribes, {echo.answers});
    std::vector<std::optional<size_t>> ignored;
    for (const Topic& topic : platform::SensedTopics(model, fleet, ports, r, ignored)) {
      Add(robot.subscribes, topic);
      Add(bodies.publishes, topic);
      Add(doctor.subscribes, topic);
    }
    const Topic odometry = platform::OdometryOf(fleet, r);
    Add(bodies.publishes, odometry);
    if (odometry.carries == platform::Carries::kPx4Odometry) Add(robot.subscribes, odometry);
    for (const sim::Port& port : ports) {
      const auto topic = platform::TopicOf(model, fleet, r, port);
      if (!topic || !sim::IsActuator(model, port)) continue;
      Add(robot.publishes, *topic);
      Add(bodies.subscribes, *topic);
    }
  }
  all.push_back(std::move(bodies));
  all.push_back(std::move(doctor));
  for (Enclave& enclave : all) {
    Sort(enclave.publishes);
    Sort(enclave.subscribes);
  }
  return all;
}

base::Result<Keystore> MakeKeystore(const std::string& path, const std::vector<Enclave>& enclaves,
                                    const RobotOptions& texts) {
  Keystore made;
  Folder folder(path);
  const auto authority = OwnerOf(folder, made.fresh);
  if (!authority.ok()) return base::Error{fmt::format("`{}`: {}", path, authority.error().message)};
  folder.Make("enclaves");
  const std::string& certificate = authority.value().identity().certificate;
  const std::string governance = security::Governance(), manifest = ManifestOf(texts);
  folder.Write("enclaves/governance.xml", governance);
  folder.Sign(authority.value(), "enclaves/governance.p7s", governance);
  for (const Enclave& enclave : enclaves) {
    const fs::path own = fs::path("enclaves") / enclave.name.substr(1);
    folder.Make(own);
    // Keys of an owner of before, or what is left of them, are good for nothing.
    const bool good =
        folder.Has(own / "key.pem") && folder.Has(own / "cert.pem") &&
        authority.value().Issued({folder.Read(own / "cert.pem"), folder.Read(own / "key.pem")}, enclave.name);
    if (!good) {
      const auto identity = authority.value().Issue(enclave.name);
      if (!identity.ok()) return identity.error();
      folder.Write(own / "cert.pem", identity.value().certificate);
      folder.WriteKey(own / "key.pem", identity.value().key);
      made.named.push_back(enclave.name);
    }
    const std::string permissions = security::Permissions(enclave, std::time(nullptr));
    folder.Write(own / "identity_ca.cert.pem", certificate);
    folder.Write(own / "permissions_ca.cert.pem", certificate);
    folder.Write(own / "permissions.xml", permissions);
    folder.Sign(authority.value(), own / "permissions.p7s", permissions);
    folder.Sign(authority.value(), own / "governance.p7s", governance);
    folder.Sign(authority.value(), own / "files.p7s", manifest);
  }
  if (!folder.why().empty()) return base::Error{folder.why()};
  return made;
}

base::Result<dds::Keys> KeysFor(const std::string& path, const std::string& enclave,
                                const RobotOptions& texts) {
  const fs::path own = fs::path(path) / "enclaves" / enclave.substr(1);
  Folder folder(own);
  if (!folder.Has("key.pem"))
    return base::Error{
        fmt::format("there is no key for `{}` in `{}`: `rondo keys` makes them", enclave, path)};
  const std::string signature = folder.Read("files.p7s"), certificate = folder.Read("identity_ca.cert.pem");
  if (!folder.why().empty()) return base::Error{folder.why()};
  const auto signed_files = security::Verified(signature, certificate);
  if (!signed_files.ok())
    return base::Error{fmt::format("`{}`: {}", (own / "files.p7s").string(), signed_files.error().message)};
  if (Plain(signed_files.value()) != ManifestOf(texts))
    return base::Error{fmt::format(
        "the program, the specification or the fleet is not what was signed in `{}`: if that is meant, sign it by "
        "`rondo keys`, and copy the keys to all robots",
        path)};
  return dds::Keys{own.string(), enclave};
}

}  // namespace rondo::deploy
