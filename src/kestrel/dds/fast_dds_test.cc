// SPDX-License-Identifier: BSD-3-Clause
// Against another implementation of DDS, which ROS 2 has by default: Fast DDS of Debian, that knows
// nothing of the types but their names.
#include <chrono>
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
#include <optional>
#include <set>
#include <string>
#include <thread>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "kestrel/bags/result_messages.h"
#include "kestrel/bags/serialization.h"
#include "kestrel/bags/type_hash.h"
#include "kestrel/dds/ros2_node.h"
#include "kestrel/dds/test_dds.h"

namespace kestrel {
namespace {

namespace fast = eprosima::fastdds::dds;
namespace rtps = eprosima::fastrtps::rtps;

constexpr Duration kPatience = std::chrono::seconds(10);
constexpr Duration kPause = std::chrono::milliseconds(10);

// Messages as they are on the wire, as std::string.
class RawType : public fast::TopicDataType {
 public:
  explicit RawType(const std::string& name) {
    constexpr std::uint32_t kMaxSize = 1 << 16;
    setName(name.c_str());
    m_typeSize = kMaxSize;
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

// What others say of themselves beside their names.
class UserDataListener : public fast::DomainParticipantListener {
 public:
  void on_participant_discovery(fast::DomainParticipant*,
                                rtps::ParticipantDiscoveryInfo&& info) override {
    Add(info.info.m_userData);
  }
  void on_publisher_discovery(fast::DomainParticipant*, rtps::WriterDiscoveryInfo&& info) override {
    Add(info.info.m_qos.m_userData);
  }
  void on_subscriber_discovery(fast::DomainParticipant*,
                               rtps::ReaderDiscoveryInfo&& info) override {
    Add(info.info.m_qos.m_userData);
  }
  std::set<std::string> heard() const {
    const std::lock_guard lock(mutex_);
    return heard_;
  }

 private:
  template <class UserData>
  void Add(const UserData& data) {
    const std::lock_guard lock(mutex_);
    heard_.emplace(data.begin(), data.end());
  }

  mutable std::mutex mutex_;
  std::set<std::string> heard_;
};

// A participant of Fast DDS that is found on this computer alone.
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

  const UserDataListener& others() const { return listener_; }

  fast::DataReader* Read(const std::string& topic, const std::string& type, bool is_kept) {
    fast::DataReaderQos qos;
    qos.reliability().kind = fast::RELIABLE_RELIABILITY_QOS;
    if (is_kept) qos.durability().kind = fast::TRANSIENT_LOCAL_DURABILITY_QOS;
    return participant_->create_subscriber(fast::SUBSCRIBER_QOS_DEFAULT)
        ->create_datareader(Topic(topic, type), qos);
  }
  fast::DataWriter* Write(const std::string& topic, const std::string& type) {
    fast::DataWriterQos qos;
    qos.endpoint().history_memory_policy = rtps::PREALLOCATED_WITH_REALLOC_MEMORY_MODE;
    qos.durability().kind = fast::TRANSIENT_LOCAL_DURABILITY_QOS;
    return participant_->create_publisher(fast::PUBLISHER_QOS_DEFAULT)
        ->create_datawriter(Topic(topic, type), qos);
  }

 private:
  fast::Topic* Topic(const std::string& topic, const std::string& type) {
    fast::TypeSupport(new RawType(type)).register_type(participant_);
    return participant_->create_topic(topic, type, fast::TOPIC_QOS_DEFAULT);
  }

  UserDataListener listener_;
  fast::DomainParticipant* participant_;
};

// The first message that comes, without what fills it up to four bytes.
std::string Hear(fast::DataReader* reader) {
  std::string bytes;
  fast::SampleInfo info;
  if (!reader->wait_for_unread_message({10, 0})) return "";
  reader->take_next_sample(&bytes, &info);
  bytes.resize(bytes.size() - static_cast<std::size_t>(bytes.at(3) & 3));
  bytes[3] = 0;
  return bytes;
}

OdometryMessage SomeOdometry() {
  OdometryMessage message;
  message.header = {0, TimeFromNanoseconds(1'700'000'000'123'456'789), "map"};
  message.child_frame_id = "target";
  message.pose.position = {1, 2, 3};
  message.pose_covariance[35] = 0.25;
  return message;
}

TEST(FastDds, HearsWhatANodePublishes) {
  const int domain = TestDomain();
  const std::string bytes = SerializeMessage(SomeOdometry(), WireFormat::kCdr);
  Ros2Node node(domain, {"kestrel"});
  const std::size_t track = node.Advertise("/kestrel/track", OdometryMessage::kType, kLatchedQos);
  ASSERT_TRUE(node.Publish(track, bytes));
  FastParticipant peer(domain);
  EXPECT_EQ(Hear(peer.Read("rt/kestrel/track", "nav_msgs::msg::dds_::Odometry_", true)), bytes);
}

TEST(FastDds, IsHeardByANode) {
  const int domain = TestDomain();
  std::string bytes = SerializeMessage(SomeOdometry(), WireFormat::kCdr);
  Ros2Node node(domain, {"kestrel"});
  node.Subscribe("/odom", OdometryMessage::kType, kLatchedQos);
  FastParticipant peer(domain);
  peer.Write("rt/odom", "nav_msgs::msg::dds_::Odometry_")->write(&bytes);
  std::optional<std::string> heard;
  for (const Time end = Now() + kPatience; !heard && Now() < end;) {
    node.Take(kPause, [&](std::size_t, std::string_view message) { heard = std::string(message); });
  }
  EXPECT_EQ(heard, bytes);
}

TEST(FastDds, IsToldTheHashesOfTypes) {
  const int domain = TestDomain();
  Ros2Node node(domain, {"kestrel"});
  node.Advertise("/image", ImageMessage::kType, kSensorDataQos);
  node.Subscribe("/tf", TfMessage::kType, kTransformsQos);
  const FastParticipant peer(domain);
  const std::vector<std::string> expected{
      "enclave=/;", "typehash=" + TypeHash("sensor_msgs/Image") + ";",
      "typehash=" + TypeHash("tf2_msgs/TFMessage") + ";",
      "typehash=" + TypeHash("rmw_dds_common/ParticipantEntitiesInfo") + ";"};
  for (const Time end = Now() + kPatience; peer.others().heard().size() < 4 && Now() < end;) {
    std::this_thread::sleep_for(kPause);
  }
  EXPECT_THAT(peer.others().heard(), ::testing::IsSupersetOf(expected));
}

// ParticipantEntitiesInfo, field by field, as Iron and later ones and as Humble have it.
TEST(FastDds, ListsTheNode) {
  for (const bool is_humble : {false, true}) {
    const int domain = TestDomain();
    Ros2Node node(domain, {"eyes", is_humble});
    node.Advertise("/a", TfMessage::kType, kDefaultQos);
    node.Subscribe("/b", TfMessage::kType, kDefaultQos);
    node.Subscribe("/c", TfMessage::kType, kDefaultQos);
    FastParticipant peer(domain);
    const std::string bytes =
        Hear(peer.Read("ros_discovery_info", "rmw_dds_common::msg::dds_::ParticipantEntitiesInfo_",
                       /*is_kept=*/true));
    const std::string name = "info";
    WireReader wire(bytes, WireFormat::kCdr, name);
    const auto gid = [&] {
      std::string read(is_humble ? 24 : 16, '\0');
      for (char& byte : read) wire(byte);
      return read;
    };
    const auto count = [&] {
      std::uint32_t number = 0;
      wire(number);
      return number;
    };
    const std::string participant = gid();
    ASSERT_EQ(count(), 1u);
    std::string name_space, node_name;
    wire(name_space);
    wire(node_name);
    EXPECT_EQ(name_space, "/");
    EXPECT_EQ(node_name, "eyes");
    ASSERT_EQ(count(), 2u);
    const std::vector<std::string> readers{gid(), gid()};
    ASSERT_EQ(count(), 1u);
    const std::string writer = gid();
    // The first twelve bytes are the participant's in all, the rest tells them apart.
    constexpr std::size_t kPrefix = 12;
    for (const std::string& endpoint : {readers[0], readers[1], writer}) {
      EXPECT_EQ(endpoint.substr(0, kPrefix), participant.substr(0, kPrefix));
      EXPECT_NE(endpoint, participant);
    }
    EXPECT_NE(readers[0], readers[1]);
  }
}

}  // namespace
}  // namespace kestrel
