// SPDX-License-Identifier: BSD-3-Clause
// Tests against another implementation of DDS, the default of ROS 2: Debian's Fast DDS, which knows
// only the names of the types.
#include <algorithm>
#include <chrono>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "kestrel/comms/dds/ros2_node.h"
#include "kestrel/comms/dds/test_dds.h"
#include "kestrel/comms/dds/test_fast_dds.h"
#include "kestrel/core/base/test_eventually.h"
#include "kestrel/io/ros_messages/message_definitions.h"
#include "kestrel/io/ros_messages/node_messages.h"
#include "kestrel/io/ros_messages/result_messages.h"
#include "kestrel/io/ros_messages/serialization.h"

namespace kestrel {
namespace {

constexpr Duration kPatience = std::chrono::seconds(10);
constexpr Duration kPause = std::chrono::milliseconds(10);
constexpr FastQos kKept{.is_kept = true};

// Returns the first message that comes; empty when none does.
std::string Hear(fast::DataReader* reader) {
  std::string bytes;
  Eventually([&] { return TakeRaw(reader, &bytes); });
  return bytes;
}

OdometryMessage SomeOdometry() {
  OdometryMessage message;
  message.header = {0, TimeFromNanoseconds(1'700'000'000'123'456'789), "map"};
  message.child_frame_id = "target";
  message.pose.pose.position = {1, 2, 3};
  message.pose.covariance[35] = 0.25;
  return message;
}

TEST(FastDds, ReceivesMessagesOfNode) {
  const int domain = TestDomain();
  const std::string bytes = SerializeMessage(SomeOdometry(), WireFormat::kCdr);
  Ros2Node node(domain, {"kestrel"});
  const std::size_t track = node.Advertise("/kestrel/track", OdometryMessage::kType, kLatchedQos);
  ASSERT_TRUE(node.Publish(track, bytes));
  FastParticipant peer(domain);
  EXPECT_EQ(Hear(peer.Read("rt/kestrel/track", "nav_msgs::msg::dds_::Odometry_", kKept)), bytes);
}

TEST(FastDds, SendsMessagesToNode) {
  const int domain = TestDomain();
  std::string bytes = SerializeMessage(SomeOdometry(), WireFormat::kCdr);
  Ros2Node node(domain, {"kestrel"});
  node.Subscribe("/odom", OdometryMessage::kType, kLatchedQos);
  FastParticipant peer(domain);
  peer.Write("rt/odom", "nav_msgs::msg::dds_::Odometry_", kKept)->write(&bytes);
  std::optional<std::string> heard;
  for (const Time end = Now() + kPatience; !heard && Now() < end;) {
    node.Take(kPause, [&](std::size_t, std::string_view message) { heard = std::string(message); });
  }
  EXPECT_EQ(heard, bytes);
}

TEST(FastDds, ReceivesTypeHashes) {
  const int domain = TestDomain();
  Ros2Node node(domain, {"kestrel"});
  node.Advertise("/image", ImageMessage::kType, kSensorDataQos);
  node.Subscribe("/tf", TfMessage::kType, kTransformsQos);
  const FastParticipant peer(domain);
  const std::set<std::string> expected{
      "enclave=/;", "typehash=" + TypeHash("sensor_msgs/Image") + ";",
      "typehash=" + TypeHash("tf2_msgs/TFMessage") + ";",
      "typehash=" + TypeHash("rmw_dds_common/ParticipantEntitiesInfo") + ";"};
  std::set<std::string> heard;
  Eventually([&] {
    for (const FastEntity& entity : peer.others().heard()) heard.insert(entity.user_data);
    return heard.size() >= expected.size();
  });
  EXPECT_EQ(heard, expected);
}

// Returns the 16 bytes by which 'peer' knows the endpoint of a topic, or with "" the participant;
// empty when it does not discover it.
std::string GidHeard(const FastParticipant& peer, const std::string& topic) {
  std::string gid;
  Eventually([&] {
    for (const FastEntity& entity : peer.others().heard()) {
      if (entity.topic == topic) gid = entity.gid;
    }
    return !gid.empty();
  });
  return gid;
}

template <std::size_t kSize>
void ExpectGid(const GidMessage<kSize>& gid, const FastParticipant& peer,
               const std::string& topic) {
  const std::string heard = GidHeard(peer, topic);
  EXPECT_EQ(heard.size(), kGidSize) << topic;
  EXPECT_EQ(std::string(gid.data.begin(), gid.data.end()),
            heard + std::string(kSize - heard.size(), '\0'))
      << topic;
}

// The Gids are those by which the other side knows the endpoints; for Humble zeros fill them up.
template <std::size_t kSize>
void ExpectListed(const std::string& bytes, const FastParticipant& peer) {
  const auto info =
      ParseMessage<ParticipantEntitiesMessage<kSize>>(bytes, WireFormat::kCdr, "info");
  ExpectGid(info.participant, peer, "");
  ASSERT_EQ(info.nodes.size(), 1u);
  const NodeEntitiesMessage<kSize>& node = info.nodes[0];
  EXPECT_EQ(node.name_space, "/");
  EXPECT_EQ(node.name, "eyes");
  ASSERT_EQ(node.readers.size(), 2u);
  ExpectGid(node.readers[0], peer, "rt/b");
  ExpectGid(node.readers[1], peer, "rt/c");
  ASSERT_EQ(node.writers.size(), 1u);
  ExpectGid(node.writers[0], peer, "rt/a");
}

// As Iron and later, and as Humble have it.
TEST(FastDds, ListsNode) {
  for (const bool is_humble : {false, true}) {
    const int domain = TestDomain();
    Ros2Node node(domain, {"eyes", is_humble});
    node.Advertise("/a", TfMessage::kType, kDefaultQos);
    node.Subscribe("/b", TfMessage::kType, kDefaultQos);
    node.Subscribe("/c", TfMessage::kType, kDefaultQos);
    FastParticipant peer(domain);
    const std::string bytes = Hear(peer.Read(
        "ros_discovery_info", "rmw_dds_common::msg::dds_::ParticipantEntitiesInfo_", kKept));
    if (is_humble) {
      ExpectListed<kHumbleGidSize>(bytes, peer);
    } else {
      ExpectListed<kGidSize>(bytes, peer);
    }
  }
}

// As docs.ros.org has it: a subscriber hears a publisher that offers at least what it requests.
// Kestrel offers no deadline and no lease, and requests none.
struct QosPair {
  const char* what;
  Ros2Qos own;
  FastQos other;
  // Policy that does not match when the other subscribes, and when it publishes; 0 where all match.
  fast::QosPolicyId_t subscribing, publishing;
};

constexpr fast::QosPolicyId_t kMatch{};
constexpr Ros2Qos kBestEffort{false, false, 5};
constexpr Ros2Qos kBestEffortKept{false, true, 5};

const QosPair kQosPairs[] = {
    {"alike", kDefaultQos, {}, kMatch, kMatch},
    {"the other best effort",
     kDefaultQos,
     {.is_reliable = false},
     kMatch,
     fast::RELIABILITY_QOS_POLICY_ID},
    {"the other reliable", kBestEffort, {}, fast::RELIABILITY_QOS_POLICY_ID, kMatch},
    {"both best effort", kBestEffort, {.is_reliable = false}, kMatch, kMatch},
    {"the other kept", kDefaultQos, kKept, fast::DURABILITY_QOS_POLICY_ID, kMatch},
    {"the other volatile", kLatchedQos, {}, kMatch, fast::DURABILITY_QOS_POLICY_ID},
    {"both kept", kLatchedQos, kKept, kMatch, kMatch},
    {"both kept, best effort",
     kBestEffortKept,
     {.is_reliable = false, .is_kept = true},
     kMatch,
     kMatch},
    {"a deadline", kDefaultQos, {.deadline_s = 1}, fast::DEADLINE_QOS_POLICY_ID, kMatch},
    {"alive by the topic",
     kDefaultQos,
     {.liveliness = fast::MANUAL_BY_TOPIC_LIVELINESS_QOS},
     fast::LIVELINESS_QOS_POLICY_ID,
     kMatch},
    {"alive by the participant",
     kDefaultQos,
     {.liveliness = fast::MANUAL_BY_PARTICIPANT_LIVELINESS_QOS},
     fast::LIVELINESS_QOS_POLICY_ID,
     kMatch},
    {"a lease", kDefaultQos, {.lease_s = 5}, fast::LIVELINESS_QOS_POLICY_ID, kMatch},
};

// True when the other reports for a pair what is expected: a match, or the policy that differs.
bool IsAsExpected(int matches, const fast::IncompatibleQosStatus& refused,
                  fast::QosPolicyId_t expected) {
  if (expected == kMatch) return matches == 1 && refused.total_count == 0;
  return matches == 0 && refused.total_count > 0 && refused.last_policy_id == expected;
}

TEST(FastDds, MatchesQosLikeRos) {
  const int domain = TestDomain();
  const std::string type = "tf2_msgs::msg::dds_::TFMessage_";
  Ros2Node node(domain, {});
  FastParticipant peer(domain);
  for (const QosPair& pair : kQosPairs) {
    const std::string name = pair.what;
    const std::string topic = "q" + std::to_string(&pair - kQosPairs);
    node.Advertise("/to_" + topic, TfMessage::kType, pair.own);
    node.Subscribe("/from_" + topic, TfMessage::kType, pair.own);
    fast::DataReader* const reader = peer.Read("rt/to_" + topic, type, pair.other);
    fast::DataWriter* const writer = peer.Write("rt/from_" + topic, type, pair.other);
    EXPECT_TRUE(Eventually([&] {
      fast::SubscriptionMatchedStatus matched;
      fast::IncompatibleQosStatus refused;
      reader->get_subscription_matched_status(matched);
      reader->get_requested_incompatible_qos_status(refused);
      return IsAsExpected(matched.current_count, refused, pair.subscribing);
    })) << name
        << ", the other subscribes";
    EXPECT_TRUE(Eventually([&] {
      fast::PublicationMatchedStatus matched;
      fast::IncompatibleQosStatus refused;
      writer->get_publication_matched_status(matched);
      writer->get_offered_incompatible_qos_status(refused);
      return IsAsExpected(matched.current_count, refused, pair.publishing);
    })) << name
        << ", the other publishes";
  }
}

}  // namespace
}  // namespace kestrel
