// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <fastdds/dds/domain/DomainParticipantFactory.hpp>
#include <fastdds/dds/publisher/DataWriter.hpp>
#include <fastdds/dds/publisher/Publisher.hpp>
#include <fastdds/dds/subscriber/DataReader.hpp>
#include <fastdds/dds/subscriber/SampleInfo.hpp>
#include <fastdds/dds/subscriber/Subscriber.hpp>
#include <fastdds/dds/topic/TypeSupport.hpp>
#include <memory>
#include <string>

#if __has_include(<fastdds/utils/IPLocator.hpp>)
#include "kestrel/comms/dds/test_fast_dds_3.h"
#else
#include "kestrel/comms/dds/test_fast_dds_2.h"
#endif

namespace kestrel {

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
                         const FastQos& requested = {}) {
    auto qos = requested.Of<fast::DataReaderQos>();
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
  while (reader->take_next_sample(bytes, &info) == kFastOk) {
    if (!info.valid_data) continue;
    bytes->resize(bytes->size() - static_cast<std::size_t>(bytes->at(3) & 3));
    (*bytes)[3] = 0;
    return true;
  }
  return false;
}

}  // namespace kestrel
