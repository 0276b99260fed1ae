// SPDX-License-Identifier: BSD-3-Clause
// The parts of Fast DDS 2 that differ in version 3.
#pragma once

#include <cstdint>
#include <cstring>
#include <fastdds/dds/domain/DomainParticipant.hpp>
#include <fastdds/dds/domain/DomainParticipantListener.hpp>
#include <fastdds/dds/topic/TopicDataType.hpp>
#include <fastdds/rtps/transport/UDPv4TransportDescriptor.h>
#include <fastrtps/utils/IPLocator.h>
#include <functional>
#include <string>

#include "kestrel/comms/dds/test_fast_entities.h"

namespace kestrel {

namespace fast = eprosima::fastdds::dds;
namespace rtps = eprosima::fastrtps::rtps;

inline const auto kFastOk = ReturnCode_t::RETCODE_OK;

// Messages as their bytes on the wire, in a std::string.
class RawType : public fast::TopicDataType {
 public:
  explicit RawType(const std::string& name) {
    constexpr std::uint32_t kUsualSize = 1 << 12;
    setName(name.c_str());
    m_typeSize = kUsualSize;
    m_isGetKeyDefined = false;
    auto_fill_type_information(false);
    auto_fill_type_object(false);
  }
  bool serialize(void* data, rtps::SerializedPayload_t* payload) override {
    const auto& bytes = *static_cast<std::string*>(data);
    payload->encapsulation = CDR_LE;
    payload->length = static_cast<std::uint32_t>(bytes.size());
    std::memcpy(payload->data, bytes.data(), bytes.size());
    return true;
  }
  bool deserialize(rtps::SerializedPayload_t* payload, void* data) override {
    static_cast<std::string*>(data)->assign(reinterpret_cast<char*>(payload->data),
                                            payload->length);
    return true;
  }
  std::function<std::uint32_t()> getSerializedSizeProvider(void* data) override {
    return [data] { return static_cast<std::uint32_t>(static_cast<std::string*>(data)->size()); };
  }
  void* createData() override { return new std::string; }
  void deleteData(void* data) override { delete static_cast<std::string*>(data); }
  bool getKey(void*, rtps::InstanceHandle_t*, bool) override { return false; }
};

// Keeps what is discovered of others.
class FastListener : public fast::DomainParticipantListener, public FastEntities {
 public:
  void on_participant_discovery(fast::DomainParticipant*,
                                rtps::ParticipantDiscoveryInfo&& info) override {
    if (info.status != rtps::ParticipantDiscoveryInfo::DISCOVERED_PARTICIPANT) return;
    const auto& data = info.info.m_userData;
    Add({GidOf(info.info.m_guid), {data.begin(), data.end()}, "", "", false});
  }
  void on_publisher_discovery(fast::DomainParticipant* self,
                              rtps::WriterDiscoveryInfo&& info) override {
    if (info.status != rtps::WriterDiscoveryInfo::DISCOVERED_WRITER) return;
    AddEndpoint(*self, info.info, true);
  }
  void on_subscriber_discovery(fast::DomainParticipant* self,
                               rtps::ReaderDiscoveryInfo&& info) override {
    if (info.status != rtps::ReaderDiscoveryInfo::DISCOVERED_READER) return;
    AddEndpoint(*self, info.info, false);
  }

 private:
  template <class Endpoint>
  void AddEndpoint(const fast::DomainParticipant& self, const Endpoint& info, bool is_writer) {
    if (info.guid().guidPrefix == self.guid().guidPrefix) return;
    const auto& data = info.m_qos.m_userData;
    Add({GidOf(info.guid()),
         {data.begin(), data.end()},
         info.topicName().to_string(),
         info.typeName().to_string(),
         is_writer});
  }
};

}  // namespace kestrel
