#pragma once

#include <dds/dds.h>

#include <ctime>
#include <string>

#include "dds/network.h"
#include "dds/raw_type.h"

/// What is measured against talks Cyclone DDS by hand.
namespace bench {

/// Are the ends of one process in a topic on which all write and all read, best effort.
struct Ends {
  dds_entity_t reader = 0, writer = 0, waitset = 0;

  /// Returns when so many others are connected.
  Ends(const rondo::dds::Network& network, const char* topic_name, uint32_t others) {
    const std::string configuration = rondo::dds::Configuration(network);
    dds_create_domain(network.domain, configuration.c_str());
    const dds_entity_t participant = dds_create_participant(network.domain, nullptr, nullptr);
    const dds_entity_t topic = rondo::dds::CreateRawTopic(participant, topic_name, "Raw", nullptr);
    dds_qos_t* qos = dds_create_qos();
    dds_qset_reliability(qos, DDS_RELIABILITY_BEST_EFFORT, 0);
    dds_qset_history(qos, DDS_HISTORY_KEEP_LAST, 256);
    dds_qset_ignorelocal(qos, DDS_IGNORELOCAL_PARTICIPANT);
    reader = dds_create_reader(participant, topic, qos, nullptr);
    writer = dds_create_writer(participant, topic, qos, nullptr);
    dds_delete_qos(qos);
    waitset = dds_create_waitset(participant);
    dds_waitset_attach(waitset, dds_create_readcondition(reader, DDS_ANY_STATE), 0);
    dds_publication_matched_status_t status{};
    do {
      const timespec nap{0, 10'000'000};
      ::nanosleep(&nap, nullptr);
      dds_get_publication_matched_status(writer, &status);
    } while (status.current_count < others);
  }
};

}  // namespace bench
