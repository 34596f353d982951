#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <string_view>
#include <vector>

#include "base/result.h"
#include "dds/network.h"
#include "ros/message.h"
#include "ros/qos.h"

/// Robots as nodes of ROS 2: the usual tools list them, and their topics, as any others.
namespace rondo::dds {

/// Identifies a participant, reader or writer: the first twelve bytes are those of its participant.
using Guid = std::array<uint8_t, 16>;

/// Says of a message that arrived where it comes from.
struct Received {
  int64_t stamp = 0;    ///< when it was sent, on the sender's wall clock; nanoseconds since 1970
  uint64_t writer = 0;  ///< which writer, as this process numbers them
};
/// Receives messages, on a thread of the library: must not wait for anything.
using Receive = std::function<void(std::string_view bytes, const Received& from)>;

class Participant;

/// Names whose messages are received.
enum class From : uint8_t {
  kAll,  ///< also those of this participant
  kOthers,
};

/// Sends messages of one topic. Thread-safe.
class Publisher {
 public:
  Publisher(Participant& participant, int32_t writer) : participant_(participant), writer_(writer) {}
  Publisher(const Publisher&) = delete;
  Publisher& operator=(const Publisher&) = delete;
  ~Publisher();

  /// Sends a message in CDR; waits for nobody. @error in the words of the library.
  base::Result<bool> Write(std::string_view bytes);
  template <class M>
  base::Result<bool> Publish(const M& message) {
    return Write(ros::Serialised(message));
  }
  /// Returns how many readers are connected.
  size_t matched() const;

 private:
  Participant& participant_;
  int32_t writer_;
};

/// Receives messages of one topic while it lives.
class Subscription {
 public:
  Subscription(Participant& participant, Receive receives)
      : receive(std::move(receives)), participant_(participant) {}
  Subscription(const Subscription&) = delete;
  Subscription& operator=(const Subscription&) = delete;
  ~Subscription();

  /// Returns how many writers are connected.
  size_t matched() const;
  /// Says which reader of the library it stands for.
  void Adopt(int32_t reader) { reader_ = reader; }

  const Receive receive;

 private:
  Participant& participant_;
  int32_t reader_ = 0;
};

/// Is a node of ROS 2.
struct NodeName {
  std::string node_namespace;  ///< "/" or "/robot1"
  std::string name;
  friend auto operator<=>(const NodeName&, const NodeName&) = default;
};

/// Is a reader or writer that somebody has, as discovery tells of it.
struct Endpoint {
  Guid guid{}, participant{};
  bool writes = false;
  std::string topic, type;  ///< as in ROS; those of others are left out
  ros::Qos qos;
  std::string hash;  ///< RIHS01; empty: not said
};

/// Takes part in a domain: a process has one for each robot, or for some. Thread-safe.
class Participant {
 public:
  /// @error in the words of the library: an interface that does not exist, no free port, and so on.
  static base::Result<std::unique_ptr<Participant>> Open(const Network& network);
  Participant(const Participant&) = delete;
  Participant& operator=(const Participant&) = delete;
  /// Its publishers and subscriptions have to be gone.
  ~Participant();

  /// Adds a node, to which readers and writers belong. Returns its number.
  size_t AddNode(const NodeName& name);
  /// Begins to send, or to receive, messages of a type on a topic, whose full name begins with `/`.
  /// @error in the words of the library.
  base::Result<std::unique_ptr<Publisher>> Publish(size_t node, const std::string& topic,
                                                   const ros::Message& type, const ros::Qos& qos);
  base::Result<std::unique_ptr<Subscription>> Subscribe(size_t node, const std::string& topic,
                                                        const ros::Message& type, const ros::Qos& qos,
                                                        Receive receive, From from = From::kAll);

  /// Returns all readers and writers that are known, its own among them.
  std::vector<Endpoint> Endpoints();
  /// Returns the nodes that participants say they have, with their readers and writers.
  struct Node {
    NodeName name;
    Guid participant{};
    std::vector<Guid> readers, writers;
  };
  std::vector<Node> Nodes();
  Guid guid() const;

 private:
  friend class Publisher;
  friend class Subscription;
  Participant() = default;
  base::Result<int32_t> Topic(const std::string& wire, const std::string& type);
  void Begins(size_t node, int32_t endpoint, bool writes);
  void Ends(int32_t endpoint);
  void Announce();
  void Hear(std::string_view bytes);

  struct Own {
    NodeName name;
    std::vector<std::pair<int32_t, Guid>> readers, writers;
  };
  int32_t entity_ = 0;
  int32_t announcements_ = 0;
  bool old_identities_ = false;
  static constexpr size_t kMostParticipants = 10'000;
  std::mutex announce_mutex_;  // before the other
  std::mutex mutex_;
  std::vector<std::pair<std::string, int32_t>> topics_;  // by name and type on the wire
  std::vector<Own> nodes_;
  std::vector<std::pair<Guid, std::vector<Node>>> heard_;  // by participant
  std::unique_ptr<Subscription> graph_;
};

}  // namespace rondo::dds
