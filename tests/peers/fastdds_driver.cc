// The driver of a robot by another vendor: Fast DDS, with the code that its own generator makes of messages.idl. It says where
// the robot is, twenty times a second, goes where it is told, and prints what it heard when its time is over.
//
//   fastdds_driver DOMAIN NAMESPACE SECONDS

#include <fastdds/rtps/transport/UDPv4TransportDescriptor.h>
#include <fastrtps/utils/IPLocator.h>

#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <fastdds/dds/domain/DomainParticipant.hpp>
#include <fastdds/dds/domain/DomainParticipantFactory.hpp>
#include <fastdds/dds/publisher/DataWriter.hpp>
#include <fastdds/dds/publisher/Publisher.hpp>
#include <fastdds/dds/subscriber/DataReader.hpp>
#include <fastdds/dds/subscriber/SampleInfo.hpp>
#include <fastdds/dds/subscriber/Subscriber.hpp>
#include <fastdds/dds/topic/Topic.hpp>
#include <memory>
#include <set>
#include <string>
#include <thread>

#include "messagesPubSubTypes.h"

namespace fdds = eprosima::fastdds::dds;
namespace rtps = eprosima::fastrtps::rtps;

namespace {

// As ROS 2 does: final types, no descriptions of types on the wire.
template <class Type>
fdds::TypeSupport Plain() {
  fdds::TypeSupport type(new Type);
  type->auto_fill_type_object(false);
  type->auto_fill_type_information(false);
  return type;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 4) return 2;
  const std::string space = std::string("/") + argv[2];
  fdds::DomainParticipantQos qos;
  const std::string enclave = "enclave=/;";
  qos.user_data().data_vec({enclave.begin(), enclave.end()});
  qos.transport().use_builtin_transports = false;
  auto udp = std::make_shared<eprosima::fastdds::rtps::UDPv4TransportDescriptor>();
  udp->maxInitialPeersRange = 120;
  udp->interfaceWhiteList.push_back("127.0.0.1");
  qos.transport().user_transports.push_back(udp);
  rtps::Locator_t any, peer;
  qos.wire_protocol().builtin.metatrafficUnicastLocatorList.push_back(any);
  rtps::IPLocator::setIPv4(peer, "127.0.0.1");
  qos.wire_protocol().builtin.initialPeersList.push_back(peer);
  auto* factory = fdds::DomainParticipantFactory::get_instance();
  auto* participant = factory->create_participant(static_cast<uint32_t>(std::atoi(argv[1])), qos);
  if (participant == nullptr) return 1;
  const auto odometry = Plain<nav_msgs::msg::dds_::Odometry_PubSubType>();
  const auto goal = Plain<geometry_msgs::msg::dds_::PoseStamped_PubSubType>();
  const auto graph = Plain<rmw_dds_common::msg::dds_::ParticipantEntitiesInfo_PubSubType>();
  for (const auto* type : {&odometry, &goal, &graph}) type->register_type(participant);
  const auto topic = [&](const std::string& name, const fdds::TypeSupport& type) {
    return participant->create_topic(name, type.get_type_name(), fdds::TOPIC_QOS_DEFAULT);
  };
  auto* publisher = participant->create_publisher(fdds::PUBLISHER_QOS_DEFAULT);
  auto* subscriber = participant->create_subscriber(fdds::SUBSCRIBER_QOS_DEFAULT);
  fdds::DataWriterQos writes = fdds::DATAWRITER_QOS_DEFAULT;
  writes.reliability().kind = fdds::RELIABLE_RELIABILITY_QOS;
  writes.durability().kind = fdds::VOLATILE_DURABILITY_QOS;
  writes.endpoint().history_memory_policy = rtps::PREALLOCATED_WITH_REALLOC_MEMORY_MODE;
  fdds::DataReaderQos reads = fdds::DATAREADER_QOS_DEFAULT;
  reads.reliability().kind = fdds::RELIABLE_RELIABILITY_QOS;
  reads.endpoint().history_memory_policy = rtps::PREALLOCATED_WITH_REALLOC_MEMORY_MODE;
  auto* says = publisher->create_datawriter(topic("rt" + space + "/odom", odometry), writes);
  auto* hears = subscriber->create_datareader(topic("rt" + space + "/goal_pose", goal), reads);
  reads.durability().kind = fdds::TRANSIENT_LOCAL_DURABILITY_QOS;
  reads.history().kind = fdds::KEEP_ALL_HISTORY_QOS;
  auto* nodes = subscriber->create_datareader(topic("ros_discovery_info", graph), reads);
  double x = 0, y = 0;
  int goals = 0;
  std::string frame;
  std::set<std::string> names;
  const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(std::atoi(argv[3]));
  while (std::chrono::steady_clock::now() < end) {
    fdds::SampleInfo info;
    geometry_msgs::msg::dds_::PoseStamped_ told;
    while (hears->take_next_sample(&told, &info) == ReturnCode_t::RETCODE_OK) {
      if (!info.valid_data) continue;
      x = told.pose().position().x();
      y = told.pose().position().y();
      frame = told.header().frame_id();
      ++goals;
    }
    rmw_dds_common::msg::dds_::ParticipantEntitiesInfo_ who;
    while (nodes->take_next_sample(&who, &info) == ReturnCode_t::RETCODE_OK) {
      if (!info.valid_data) continue;
      for (const auto& node : who.node_entities_info_seq()) {
        if (!node.reader_gid_seq().empty())
          names.insert(std::string(node.node_namespace().c_str()) + "/" + node.node_name().c_str());
      }
    }
    nav_msgs::msg::dds_::Odometry_ where;
    const auto now = std::chrono::system_clock::now().time_since_epoch();
    where.header().stamp().sec(
        static_cast<int32_t>(std::chrono::duration_cast<std::chrono::seconds>(now).count()));
    where.header().frame_id("map");
    where.child_frame_id("base");
    where.pose().pose().position().x(x);
    where.pose().pose().position().y(y);
    where.pose().pose().orientation().w(1);
    says->write(&where);
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
  }
  std::printf("goals %d at %.3f %.3f in %s; nodes", goals, x, y, frame.c_str());
  for (const std::string& name : names) std::printf(" %s", name.c_str());
  std::printf("\n");
  participant->delete_contained_entities();
  factory->delete_participant(participant);
  return 0;
}
