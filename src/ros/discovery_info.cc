#include "ros/discovery_info.h"

#include "ros/rmw_dds_common.h"

namespace rondo::ros {

const Message& kDiscoveryMessage = rmw_dds_common::ParticipantEntitiesInfo::kMessage;

namespace {

constexpr size_t kOldBytes = 24, kMostText = 256;

// The same message with identities of another size.
class Writer {
 public:
  explicit Writer(size_t size) : size_(size) {}
  void Put(const Gid& gid) {
    for (size_t i = 0; i < size_; ++i) cdr_.Value(i < gid.size() ? gid[i] : uint8_t{0});
  }
  void Put(const std::vector<Gid>& gids) {
    cdr_.Count(gids.size());
    for (const Gid& gid : gids) Put(gid);
  }
  CdrWriter& cdr() { return cdr_; }

 private:
  CdrWriter cdr_;
  size_t size_;
};

class Reader {
 public:
  Reader(std::string_view bytes, size_t size) : cdr_(bytes), size_(size) {}
  void Get(Gid& gid) {
    for (size_t i = 0; i < size_; ++i) {
      uint8_t byte = 0;
      cdr_.Value(byte);
      if (i < gid.size()) {
        gid[i] = byte;
      } else {
        padded_ &= byte == 0;
      }
    }
  }
  void Get(std::vector<Gid>& gids) {
    gids.resize(cdr_.Count(size_));
    for (Gid& gid : gids) Get(gid);
  }
  CdrReader& cdr() { return cdr_; }
  bool Complete() const { return cdr_.Complete() && padded_; }

 private:
  CdrReader cdr_;
  size_t size_;
  bool padded_ = true;
};

bool Read(std::string_view bytes, size_t size, DiscoveryInfo& info) {
  Reader reader(bytes, size);
  reader.Get(info.participant);
  info.nodes.resize(reader.cdr().Count(16));
  for (DiscoveryInfo::Node& node : info.nodes) {
    reader.cdr().Value(node.node_namespace, kMostText);
    reader.cdr().Value(node.name, kMostText);
    reader.Get(node.readers);
    reader.Get(node.writers);
  }
  return reader.Complete();
}

}  // namespace

std::string Encoded(const DiscoveryInfo& info, bool old_identities) {
  Writer writer(old_identities ? kOldBytes : info.participant.size());
  writer.Put(info.participant);
  writer.cdr().Count(info.nodes.size());
  for (const DiscoveryInfo::Node& node : info.nodes) {
    writer.cdr().Value(std::string_view(node.node_namespace).substr(0, kMostText));
    writer.cdr().Value(std::string_view(node.name).substr(0, kMostText));
    writer.Put(node.readers);
    writer.Put(node.writers);
  }
  return writer.cdr().Take();
}

bool Decode(std::string_view bytes, DiscoveryInfo& info) {
  return Read(bytes, info.participant.size(), info) || Read(bytes, kOldBytes, info);
}

}  // namespace rondo::ros
