#include "dds/participant.h"

#include <dds/dds.h>
#include <dds/ddsrt/log.h>
#include <fmt/format.h>

#include <algorithm>

#include "dds/protection.h"
#include "dds/raw_type.h"
#include "dds/sockets.h"
#include "ros/discovery_info.h"
#include "ros/names.h"

namespace rondo::dds {
namespace {

// What the library says of errors, since the last look.
class Words {
 public:
  static Words& Get() {
    static Words words;
    return words;
  }
  std::string Take() {
    const std::lock_guard lock(mutex_);
    return std::exchange(text_, {});
  }

 private:
  Words() {
    dds_set_log_sink(&Words::Hear, this);
    dds_set_trace_sink([](void*, const dds_log_data_t*) {}, nullptr);
  }
  static void Hear(void* self, const dds_log_data_t* data) {
    if ((data->priority & (DDS_LC_ERROR | DDS_LC_FATAL | DDS_LC_WARNING | DDS_LC_CONFIG)) == 0) return;
    Words& words = *static_cast<Words*>(self);
    const std::lock_guard lock(words.mutex_);
    if (words.text_.size() > 1000) return;
    std::string line(data->message, data->size);
    while (!line.empty() && (line.back() == '\n' || line.back() == ' ')) line.pop_back();
    words.text_ += (words.text_.empty() ? "" : "; ") + line;
  }
  std::mutex mutex_;
  std::string text_;
};

base::Error Failed(const std::string& what, dds_return_t code) {
  const std::string words = Words::Get().Take();
  return {fmt::format("{}: {}", what, words.empty() ? dds_strretcode(code) : words)};
}

// The library is there as long as somebody takes part.
std::mutex& LibraryMutex() {
  static std::mutex mutex;
  return mutex;
}
int& Users() {
  static int users = 0;
  return users;
}

struct QosDeleter {
  void operator()(dds_qos_t* qos) const { dds_delete_qos(qos); }
};
using QosPointer = std::unique_ptr<dds_qos_t, QosDeleter>;

QosPointer Policies(const ros::Qos& qos, const std::string& hash) {
  QosPointer q(dds_create_qos());
  const auto history = qos.depth == 0 ? DDS_HISTORY_KEEP_ALL : DDS_HISTORY_KEEP_LAST;
  const auto depth = static_cast<int32_t>(std::max<uint32_t>(qos.depth, 1));
  dds_qset_reliability(q.get(), qos.reliable ? DDS_RELIABILITY_RELIABLE : DDS_RELIABILITY_BEST_EFFORT,
                       DDS_SECS(1));
  dds_qset_history(q.get(), history, depth);
  if (qos.transient_local) {
    dds_qset_durability(q.get(), DDS_DURABILITY_TRANSIENT_LOCAL);
    dds_qset_durability_service(q.get(), 0, history, depth, DDS_LENGTH_UNLIMITED, DDS_LENGTH_UNLIMITED,
                                DDS_LENGTH_UNLIMITED);
  }
  if (qos.lifespan > 0) dds_qset_lifespan(q.get(), DDS_SECS(qos.lifespan));
  dds_qset_writer_data_lifecycle(q.get(), false);
  const dds_data_representation_id_t representation = DDS_DATA_REPRESENTATION_XCDR1;
  dds_qset_data_representation(q.get(), 1, &representation);
  const std::string data = fmt::format("typehash={};", hash);
  dds_qset_userdata(q.get(), data.data(), data.size());
  return q;
}

Guid GuidOf(const dds_guid_t& guid) {
  Guid result;
  std::copy_n(guid.v, result.size(), result.begin());
  return result;
}

Guid GuidOf(dds_entity_t entity) {
  dds_guid_t guid{};
  dds_get_guid(entity, &guid);
  return GuidOf(guid);
}

// Visits what discovery knows of a kind.
template <class T, class Visit>
void ForEachKnown(dds_entity_t participant, dds_entity_t kind, const Visit& visit) {
  const dds_entity_t reader = dds_create_reader(participant, kind, nullptr, nullptr);
  if (reader < 0) return;
  std::array<void*, 64> samples{};
  std::array<dds_sample_info_t, 64> infos;
  for (;;) {
    const int count = dds_take(reader, samples.data(), infos.data(), samples.size(), samples.size());
    if (count <= 0) break;
    for (size_t i = 0; i < static_cast<size_t>(count); ++i) {
      if (infos[i].valid_data) visit(*static_cast<const T*>(samples[i]));
    }
    dds_return_loan(reader, samples.data(), count);
  }
  dds_delete(reader);
}

void Arrive(dds_entity_t reader, void* subscription) {
  // Its memory is kept. Who is called may write, and be called again in this thread.
  thread_local std::string kept;
  std::string bytes = std::exchange(kept, {});
  dds_sample_info_t info;
  while (TakeRaw(reader, bytes, info)) {
    if (info.valid_data)
      static_cast<Subscription*>(subscription)
          ->receive(bytes, {info.source_timestamp, info.publication_handle});
  }
  kept = std::move(bytes);
}

ros::Qos QosOf(const dds_qos_t* q) {
  ros::Qos qos;
  dds_reliability_kind_t reliability = DDS_RELIABILITY_BEST_EFFORT;
  dds_durability_kind_t durability = DDS_DURABILITY_VOLATILE;
  dds_history_kind_t history = DDS_HISTORY_KEEP_LAST;
  dds_duration_t blocking = 0;
  int32_t depth = 1;
  dds_qget_reliability(q, &reliability, &blocking);
  dds_qget_durability(q, &durability);
  dds_qget_history(q, &history, &depth);
  qos.reliable = reliability == DDS_RELIABILITY_RELIABLE;
  qos.transient_local = durability != DDS_DURABILITY_VOLATILE;
  qos.depth = history == DDS_HISTORY_KEEP_ALL ? 0 : static_cast<uint32_t>(depth);
  return qos;
}

std::string HashOf(const dds_qos_t* q) {
  void* data = nullptr;
  size_t size = 0;
  if (!dds_qget_userdata(q, &data, &size) || data == nullptr) return {};
  const std::string text(static_cast<const char*>(data), size);
  dds_free(data);
  const size_t at = text.find("typehash=");
  return at == std::string::npos ? "" : text.substr(at + 9, text.find(';', at) - at - 9);
}

}  // namespace

Publisher::~Publisher() {
  participant_.Ends(writer_);
  dds_delete(writer_);
}

base::Result<bool> Publisher::Write(std::string_view bytes) {
  const dds_return_t code = dds_write(writer_, &bytes);
  if (code < 0) return Failed("cannot send", code);
  return true;
}

size_t Publisher::matched() const {
  dds_publication_matched_status_t status{};
  dds_get_publication_matched_status(writer_, &status);
  return status.current_count;
}

Subscription::~Subscription() {
  participant_.Ends(reader_);
  dds_delete(reader_);
}

size_t Subscription::matched() const {
  dds_subscription_matched_status_t status{};
  dds_get_subscription_matched_status(reader_, &status);
  return status.current_count;
}

base::Result<std::unique_ptr<Participant>> Participant::Open(const Network& network) {
  std::unique_ptr<Participant> p(new Participant);
  {
    const std::lock_guard lock(LibraryMutex());
    Words::Get().Take();
    const std::set<int> others = DatagramSockets();
    // What the user configures comes first.
    if (std::getenv("CYCLONEDDS_URI") == nullptr) {
      const dds_entity_t domain = dds_create_domain(network.domain, Configuration(network).c_str());
      if (domain < 0 && domain != DDS_RETCODE_PRECONDITION_NOT_MET)
        return Failed("cannot take part in the network", domain);
    }
    const QosPointer qos(dds_create_qos());
    const std::string enclave = fmt::format("enclave={};", network.keys.enclave);
    dds_qset_userdata(qos.get(), enclave.data(), enclave.size());
    Protect(qos.get(), network.keys);
    p->entity_ = dds_create_participant(network.domain, qos.get(), nullptr);
    if (p->entity_ < 0) {
      base::Error error = Failed("cannot take part in the network", p->entity_);
      p->entity_ = 0;
      if (Users() == 0) dds_delete(DDS_CYCLONEDDS_HANDLE);
      return error;
    }
    LimitSending(others);
    ++Users();
  }
  p->old_identities_ = network.old_identities;
  const std::string topic(ros::kDiscoveryTopic);
  const std::string hash(ros::kDiscoveryMessage.hash);
  const auto entity = p->Topic(topic, ros::WireType(ros::kDiscoveryMessage.name));
  if (!entity.ok()) return entity.error();
  QosPointer qos = Policies({.transient_local = true, .depth = 1}, hash);
  p->announcements_ = dds_create_writer(p->entity_, entity.value(), qos.get(), nullptr);
  if (p->announcements_ < 0) return Failed("cannot tell of nodes", p->announcements_);
  p->graph_ = std::make_unique<Subscription>(
      *p, [self = p.get()](std::string_view bytes, const Received&) { self->Hear(bytes); });
  qos = Policies({.transient_local = true, .depth = 0}, hash);
  dds_qset_ignorelocal(qos.get(), DDS_IGNORELOCAL_PARTICIPANT);
  dds_listener_t* listener = dds_create_listener(p->graph_.get());
  dds_lset_data_available(listener, Arrive);
  const dds_entity_t reader = dds_create_reader(p->entity_, entity.value(), qos.get(), listener);
  dds_delete_listener(listener);
  if (reader < 0) return Failed("cannot hear of nodes", reader);
  p->graph_->Adopt(reader);
  return p;
}

Participant::~Participant() {
  graph_.reset();
  const std::lock_guard lock(LibraryMutex());
  if (entity_ <= 0) return;
  dds_delete(entity_);
  if (--Users() == 0) dds_delete(DDS_CYCLONEDDS_HANDLE);
}

Guid Participant::guid() const { return GuidOf(entity_); }

size_t Participant::AddNode(const NodeName& name) {
  size_t number = 0;
  {
    const std::lock_guard lock(mutex_);
    nodes_.push_back({name, {}, {}});
    number = nodes_.size() - 1;
  }
  Announce();
  return number;
}

base::Result<int32_t> Participant::Topic(const std::string& wire, const std::string& type) {
  const std::string key = fmt::format("{} {}", wire, type);
  const std::lock_guard lock(mutex_);
  for (const auto& [name, entity] : topics_) {
    if (name == key) return entity;
  }
  const dds_entity_t topic = CreateRawTopic(entity_, wire, type, nullptr);
  if (topic < 0) return Failed(fmt::format("cannot use the topic `{}`", wire), topic);
  topics_.emplace_back(key, topic);
  return topic;
}

base::Result<std::unique_ptr<Publisher>> Participant::Publish(size_t node, const std::string& topic,
                                                              const ros::Message& type, const ros::Qos& qos) {
  const auto entity = Topic(ros::WireTopic(topic), ros::WireType(type.name));
  if (!entity.ok()) return entity.error();
  const QosPointer policies = Policies(qos, std::string(type.hash));
  const dds_entity_t writer = dds_create_writer(entity_, entity.value(), policies.get(), nullptr);
  if (writer < 0) return Failed(fmt::format("cannot send on `{}`", topic), writer);
  Begins(node, writer, true);
  return std::make_unique<Publisher>(*this, writer);
}

base::Result<std::unique_ptr<Subscription>> Participant::Subscribe(size_t node, const std::string& topic,
                                                                   const ros::Message& type,
                                                                   const ros::Qos& qos, Receive receive,
                                                                   From from) {
  const auto entity = Topic(ros::WireTopic(topic), ros::WireType(type.name));
  if (!entity.ok()) return entity.error();
  const QosPointer policies = Policies(qos, std::string(type.hash));
  if (from == From::kOthers) dds_qset_ignorelocal(policies.get(), DDS_IGNORELOCAL_PARTICIPANT);
  auto subscription = std::make_unique<Subscription>(*this, std::move(receive));
  // A listener that comes later misses what came before it.
  dds_listener_t* listener = dds_create_listener(subscription.get());
  dds_lset_data_available(listener, Arrive);
  const dds_entity_t reader = dds_create_reader(entity_, entity.value(), policies.get(), listener);
  dds_delete_listener(listener);
  if (reader < 0) return Failed(fmt::format("cannot receive on `{}`", topic), reader);
  subscription->Adopt(reader);
  Begins(node, reader, false);
  return subscription;
}

void Participant::Begins(size_t node, int32_t endpoint, bool writes) {
  {
    const std::lock_guard lock(mutex_);
    (writes ? nodes_[node].writers : nodes_[node].readers).emplace_back(endpoint, GuidOf(endpoint));
  }
  Announce();
}

void Participant::Ends(int32_t endpoint) {
  size_t gone = 0;
  {
    const std::lock_guard lock(mutex_);
    for (Own& node : nodes_) {
      for (auto* list : {&node.readers, &node.writers})
        gone += std::erase_if(*list, [&](const auto& e) { return e.first == endpoint; });
    }
  }
  if (gone > 0) Announce();
}

// Everything again after each change, as ROS does. Nothing is locked while the library delivers to participants of this
// process but the order of announcements.
void Participant::Announce() {
  const std::lock_guard order(announce_mutex_);
  ros::DiscoveryInfo info;
  {
    const std::lock_guard lock(mutex_);
    info.participant = GuidOf(entity_);
    for (const Own& own : nodes_) {
      auto& node = info.nodes.emplace_back();
      node.node_namespace = own.name.node_namespace;
      node.name = own.name.name;
      for (const auto& [_, guid] : own.readers) node.readers.push_back(guid);
      for (const auto& [_, guid] : own.writers) node.writers.push_back(guid);
    }
  }
  const std::string bytes = ros::Encoded(info, old_identities_);
  const std::string_view view = bytes;
  dds_write(announcements_, &view);
}

void Participant::Hear(std::string_view bytes) {
  ros::DiscoveryInfo info;
  if (!ros::Decode(bytes, info)) return;
  std::vector<Node> nodes;
  for (auto& node : info.nodes)
    nodes.push_back({{std::move(node.node_namespace), std::move(node.name)},
                     info.participant,
                     std::move(node.readers),
                     std::move(node.writers)});
  const std::lock_guard lock(mutex_);
  const auto known = std::ranges::find(heard_, info.participant, &std::pair<Guid, std::vector<Node>>::first);
  if (known != heard_.end()) {
    known->second = std::move(nodes);
  } else if (heard_.size() < kMostParticipants) {
    heard_.emplace_back(info.participant, std::move(nodes));
  }
}

std::vector<Endpoint> Participant::Endpoints() {
  std::vector<Endpoint> all;
  for (const bool writes : {true, false}) {
    ForEachKnown<dds_builtintopic_endpoint_t>(
        entity_, writes ? DDS_BUILTIN_TOPIC_DCPSPUBLICATION : DDS_BUILTIN_TOPIC_DCPSSUBSCRIPTION,
        [&](const dds_builtintopic_endpoint_t& found) {
          Endpoint e;
          e.guid = GuidOf(found.key);
          e.participant = GuidOf(found.participant_key);
          e.writes = writes;
          e.topic = ros::TopicOfWire(found.topic_name);
          e.type = ros::TypeOfWire(found.type_name);
          e.qos = QosOf(found.qos);
          e.hash = HashOf(found.qos);
          if (!e.topic.empty() && !e.type.empty()) all.push_back(std::move(e));
        });
  }
  return all;
}

std::vector<Participant::Node> Participant::Nodes() {
  std::vector<Node> all;
  std::vector<Guid> alive;
  ForEachKnown<dds_builtintopic_participant_t>(
      entity_, DDS_BUILTIN_TOPIC_DCPSPARTICIPANT,
      [&](const dds_builtintopic_participant_t& found) { alive.push_back(GuidOf(found.key)); });
  const std::lock_guard lock(mutex_);
  // Who is gone says so to the library, not in what was heard.
  std::erase_if(heard_, [&](const auto& h) { return std::ranges::find(alive, h.first) == alive.end(); });
  for (const auto& [_, nodes] : heard_) all.insert(all.end(), nodes.begin(), nodes.end());
  for (const Own& own : nodes_) {
    Node node{own.name, GuidOf(entity_), {}, {}};
    for (const auto& [_, guid] : own.readers) node.readers.push_back(guid);
    for (const auto& [_, guid] : own.writers) node.writers.push_back(guid);
    all.push_back(std::move(node));
  }
  return all;
}

}  // namespace rondo::dds
