#pragma once

#include <dds/dds.h>

#include <string>
#include <string_view>

/// Types whose samples are bytes, whatever they mean.
namespace rondo::dds {

/// Creates a topic of a type that is known by its name alone. Samples are messages in CDR with their header; what is
/// written is a `std::string_view`. Returns the topic, or an error of the library.
dds_entity_t CreateRawTopic(dds_entity_t participant, const std::string& topic, const std::string& type,
                            const dds_qos_t* qos);

/// Takes the next message of a reader of such a topic into `bytes`. Returns false if there is none; `info` says whether
/// there is data in it.
bool TakeRaw(dds_entity_t reader, std::string& bytes, dds_sample_info_t& info);

}  // namespace rondo::dds
