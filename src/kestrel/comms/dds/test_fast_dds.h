// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <cstring>
#include <fastdds/dds/domain/DomainParticipant.hpp>
#include <fastdds/dds/domain/DomainParticipantFactory.hpp>
#include <fastdds/dds/domain/DomainParticipantListener.hpp>
#include <fastdds/dds/publisher/DataWriter.hpp>
#include <fastdds/dds/publisher/Publisher.hpp>
#include <fastdds/dds/subscriber/DataReader.hpp>
#include <fastdds/dds/subscriber/SampleInfo.hpp>
#include <fastdds/dds/subscriber/Subscriber.hpp>
#include <fastdds/dds/topic/TopicDataType.hpp>
#include <fastdds/dds/topic/TypeSupport.hpp>
#include <fastdds/rtps/transport/UDPv4TransportDescriptor.h>
#include <fastrtps/utils/IPLocator.h>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

namespace kestrel {

namespace fast = eprosima::fastdds::dds;
namespace rtps = eprosima::fastrtps::rtps;

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

// Properties that identify another's entity.
struct FastEntity {
  std::string gid;  // 16 bytes
  std::string user_data;
  // These are empty for a participant.
  std::string topic;
  std::string type;
  bool is_writer = false;
};

// Keeps what was discovered of others, in the order of discovery.
class FastListener : public fast::DomainParticipantListener {
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
  std::vector<FastEntity> heard() const {
    const std::lock_guard lock(mutex_);
    return heard_;
  }

 private:
  static std::string GidOf(const rtps::GUID_t& guid) {
    std::string gid(reinterpret_cast<const char*>(guid.guidPrefix.value), rtps::GuidPrefix_t::size);
    return gid.append(reinterpret_cast<const char*>(guid.entityId.value), rtps::EntityId_t::size);
  }
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
  void Add(FastEntity entity) {
    const std::lock_guard lock(mutex_);
    heard_.push_back(std::move(entity));
  }

  mutable std::mutex mutex_;
  std::vector<FastEntity> heard_;
};

// Delivery that a reader requests or a writer offers.
struct FastQos {
  bool is_reliable = true;
  bool is_kept = false;  // transient local
  int deadline_s = 0;    // 0: none
  fast::LivelinessQosPolicyKind liveliness = fast::AUTOMATIC_LIVELINESS_QOS;
  int lease_s = 0;  // 0: none

  template <class EndpointQos>
  EndpointQos Of() const {
    EndpointQos qos;
    qos.endpoint().history_memory_policy = rtps::PREALLOCATED_WITH_REALLOC_MEMORY_MODE;
    qos.reliability().kind =
        is_reliable ? fast::RELIABLE_RELIABILITY_QOS : fast::BEST_EFFORT_RELIABILITY_QOS;
    qos.durability().kind =
        is_kept ? fast::TRANSIENT_LOCAL_DURABILITY_QOS : fast::VOLATILE_DURABILITY_QOS;
    qos.liveliness().kind = liveliness;
    if (deadline_s > 0) qos.deadline().period = {deadline_s, 0};
    if (lease_s > 0) {
      qos.liveliness().lease_duration = {lease_s, 0};
      qos.liveliness().announcement_period = {0, 100'000'000};
    }
    return qos;
  }
};

// A participant of Fast DDS that is found on this computer only.
class FastParticipant {
 public:
  explicit FastParticipant(int domain) {
    constexpr std::uint32_t kFirstPort = 7410, kPerDomain = 250, kParticipants = 10;
    fast::DomainParticipantQos qos;
    const auto udp = std::make_shared<eprosima::fastdds::rtps::UDPv4TransportDescriptor>();
    udp->interfaceWhiteList.emplace_back("127.0.0.1");
    qos.transport().use_builtin_transports = false;
    qos.transport().user_transports.push_back(udp);
    for (std::uint32_t i = 0; i < kParticipants; ++i) {
      rtps::Locator_t peer;
      rtps::IPLocator::setIPv4(peer, "127.0.0.1");
      peer.port = kFirstPort + kPerDomain * static_cast<std::uint32_t>(domain) + 2 * i;
      qos.wire_protocol().builtin.initialPeersList.push_back(peer);
    }
    participant_ = fast::DomainParticipantFactory::get_instance()->create_participant(
        static_cast<std::uint32_t>(domain), qos, &listener_, fast::StatusMask::none());
  }
  ~FastParticipant() {
    participant_->delete_contained_entities();
    fast::DomainParticipantFactory::get_instance()->delete_participant(participant_);
  }
  FastParticipant(const FastParticipant&) = delete;
  FastParticipant& operator=(const FastParticipant&) = delete;

  const FastListener& others() const { return listener_; }

  // Call it once for each topic.
  fast::DataReader* Read(const std::string& topic, const std::string& type,
                         const FastQos& asked = {}) {
    auto qos = asked.Of<fast::DataReaderQos>();
    qos.history().kind = fast::KEEP_ALL_HISTORY_QOS;
    return participant_->create_subscriber(fast::SUBSCRIBER_QOS_DEFAULT)
        ->create_datareader(Topic(topic, type), qos);
  }
  fast::DataWriter* Write(const std::string& topic, const std::string& type,
                          const FastQos& offered = {}) {
    auto qos = offered.Of<fast::DataWriterQos>();
    qos.publish_mode().kind = fast::ASYNCHRONOUS_PUBLISH_MODE;  // for messages above 64 kB
    return participant_->create_publisher(fast::PUBLISHER_QOS_DEFAULT)
        ->create_datawriter(Topic(topic, type), qos);
  }

 private:
  fast::Topic* Topic(const std::string& topic, const std::string& type) {
    fast::TypeSupport(new RawType(type)).register_type(participant_);
    return participant_->create_topic(topic, type, fast::TOPIC_QOS_DEFAULT);
  }

  FastListener listener_;
  fast::DomainParticipant* participant_;
};

// Returns the next message without its padding to four bytes. False where there is none.
inline bool TakeRaw(fast::DataReader* reader, std::string* bytes) {
  fast::SampleInfo info;
  while (reader->take_next_sample(bytes, &info) == ReturnCode_t::RETCODE_OK) {
    if (!info.valid_data) continue;
    bytes->resize(bytes->size() - static_cast<std::size_t>(bytes->at(3) & 3));
    (*bytes)[3] = 0;
    return true;
  }
  return false;
}

}  // namespace kestrel
