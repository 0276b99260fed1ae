// SPDX-License-Identifier: BSD-3-Clause
// The parts of Fast DDS 3 that differ in version 2.
#pragma once

#include <cstdint>
#include <cstring>
#include <fastdds/dds/core/ReturnCode.hpp>
#include <fastdds/dds/domain/DomainParticipant.hpp>
#include <fastdds/dds/domain/DomainParticipantListener.hpp>
#include <fastdds/dds/topic/TopicDataType.hpp>
#include <fastdds/rtps/transport/UDPv4TransportDescriptor.hpp>
#include <fastdds/utils/IPLocator.hpp>
#include <string>

#include "kestrel/comms/dds/test_fast_entities.h"

namespace kestrel {

namespace fast = eprosima::fastdds::dds;
namespace rtps = eprosima::fastdds::rtps;

constexpr auto kFastOk = fast::RETCODE_OK;

// Messages as their bytes on the wire, in a std::string.
class RawType : public fast::TopicDataType {
 public:
  explicit RawType(const std::string& name) {
    constexpr std::uint32_t kUsualSize = 1 << 12;
    set_name(name);
    max_serialized_type_size = kUsualSize;
  }
  bool serialize(const void* data, rtps::SerializedPayload_t& payload,
                 fast::DataRepresentationId_t /*representation*/) override {
    const auto& bytes = *static_cast<const std::string*>(data);
    payload.encapsulation = CDR_LE;
    payload.length = static_cast<std::uint32_t>(bytes.size());
    std::memcpy(payload.data, bytes.data(), bytes.size());
    return true;
  }
  bool deserialize(rtps::SerializedPayload_t& payload, void* data) override {
    static_cast<std::string*>(data)->assign(reinterpret_cast<char*>(payload.data), payload.length);
    return true;
  }
  std::uint32_t calculate_serialized_size(
      const void* data, fast::DataRepresentationId_t /*representation*/) override {
    return static_cast<std::uint32_t>(static_cast<const std::string*>(data)->size());
  }
  void* create_data() override { return new std::string; }
  void delete_data(void* data) override { delete static_cast<std::string*>(data); }
  bool compute_key(rtps::SerializedPayload_t&, rtps::InstanceHandle_t&, bool) override {
    return false;
  }
  bool compute_key(const void*, rtps::InstanceHandle_t&, bool) override { return false; }
};

// Keeps what is discovered of others.
class FastListener : public fast::DomainParticipantListener, public FastEntities {
 public:
  void on_participant_discovery(fast::DomainParticipant*, rtps::ParticipantDiscoveryStatus what,
                                const fast::ParticipantBuiltinTopicData& info, bool&) override {
    if (what != rtps::ParticipantDiscoveryStatus::DISCOVERED_PARTICIPANT) return;
    Add({GidOf(info.guid), {info.user_data.begin(), info.user_data.end()}, "", "", false});
  }
  void on_data_writer_discovery(fast::DomainParticipant* self, rtps::WriterDiscoveryStatus what,
                                const fast::PublicationBuiltinTopicData& info, bool&) override {
    if (what == rtps::WriterDiscoveryStatus::DISCOVERED_WRITER) AddEndpoint(*self, info, true);
  }
  void on_data_reader_discovery(fast::DomainParticipant* self, rtps::ReaderDiscoveryStatus what,
                                const fast::SubscriptionBuiltinTopicData& info, bool&) override {
    if (what == rtps::ReaderDiscoveryStatus::DISCOVERED_READER) AddEndpoint(*self, info, false);
  }

 private:
  template <class Endpoint>
  void AddEndpoint(const fast::DomainParticipant& self, const Endpoint& info, bool is_writer) {
    if (info.guid.guidPrefix == self.guid().guidPrefix) return;
    Add({GidOf(info.guid),
         {info.user_data.begin(), info.user_data.end()},
         info.topic_name.to_string(),
         info.type_name.to_string(),
         is_writer});
  }
};

}  // namespace kestrel
