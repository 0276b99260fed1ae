// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/comms/dds/ros2_node.h"

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <dds/dds.h>
#include <map>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include "kestrel/comms/dds/cyclone_cdr.h"
#include "kestrel/comms/dds/dds_domain.h"
#include "kestrel/comms/dds/opened_domain.h"
#include "kestrel/core/base/error.h"
#include "kestrel/io/ros_messages/message_definitions.h"
#include "kestrel/io/ros_messages/node_messages.h"
#include "kestrel/io/ros_messages/serialization.h"
#include "ros2_types.h"

namespace kestrel {
namespace {

constexpr std::string_view kDiscoveryInfo = ParticipantEntitiesMessage<kGidSize>::kType;
constexpr std::string_view kTypeMiddle = "::msg::dds_::";
constexpr std::string_view kTopicPrefix = "rt/";

const dds_topic_descriptor_t* const kTypes[] = {
    &sensor_msgs_msg_dds__Image__desc,
    &sensor_msgs_msg_dds__CompressedImage__desc,
    &sensor_msgs_msg_dds__CameraInfo__desc,
    &geometry_msgs_msg_dds__PoseStamped__desc,
    &geometry_msgs_msg_dds__PoseWithCovarianceStamped__desc,
    &geometry_msgs_msg_dds__TransformStamped__desc,
    &tf2_msgs_msg_dds__TFMessage__desc,
    &nav_msgs_msg_dds__Odometry__desc,
    &nav_msgs_msg_dds__Path__desc,
    &visualization_msgs_msg_dds__MarkerArray__desc,
    &diagnostic_msgs_msg_dds__DiagnosticArray__desc,
    &vision_msgs_msg_dds__Detection3DArray__desc,
    &apriltag_msgs_msg_dds__AprilTagDetectionArray__desc,
    &rmw_dds_common_msg_dds__ParticipantEntitiesInfo__desc,
};

// Returns "sensor_msgs/Image" for "sensor_msgs::msg::dds_::Image_"; nothing for a type that is not
// of ROS.
std::optional<std::string> RosTypeOf(std::string_view dds_type) {
  const std::size_t middle = dds_type.find(kTypeMiddle);
  if (middle == std::string_view::npos || !dds_type.ends_with('_')) return std::nullopt;
  std::string_view name = dds_type.substr(middle + kTypeMiddle.size());
  name.remove_suffix(1);
  return fmt::format("{}/{}", dds_type.substr(0, middle), name);
}

const dds_topic_descriptor_t* DescriptorOf(std::string_view type) {
  const auto* const known = std::find_if(
      std::begin(kTypes), std::end(kTypes),
      [&](const dds_topic_descriptor_t* each) { return RosTypeOf(each->m_typename) == type; });
  return known == std::end(kTypes) ? nullptr : *known;
}

struct QosDeleter {
  void operator()(dds_qos_t* qos) const { dds_delete_qos(qos); }
};
using QosPointer = std::unique_ptr<dds_qos_t, QosDeleter>;

QosPointer MakeQos(const Ros2Qos& qos, const std::string& user_data) {
  QosPointer made(dds_create_qos());
  dds_qset_reliability(made.get(),
                       qos.is_reliable ? DDS_RELIABILITY_RELIABLE : DDS_RELIABILITY_BEST_EFFORT, 0);
  dds_qset_durability(made.get(),
                      qos.is_kept ? DDS_DURABILITY_TRANSIENT_LOCAL : DDS_DURABILITY_VOLATILE);
  dds_qset_history(made.get(), DDS_HISTORY_KEEP_LAST, qos.depth);
  dds_qset_durability_service(made.get(), 0, DDS_HISTORY_KEEP_LAST, qos.depth, DDS_LENGTH_UNLIMITED,
                              DDS_LENGTH_UNLIMITED, DDS_LENGTH_UNLIMITED);
  dds_qset_writer_data_lifecycle(made.get(), /*autodispose=*/false);
  dds_qset_ignorelocal(made.get(), DDS_IGNORELOCAL_PARTICIPANT);
  dds_qset_userdata(made.get(), user_data.data(), user_data.size());
  return made;
}

// The type of the same name as in Humble.
const dds_topic_descriptor_t& HumbleInfo() {
  static const dds_topic_descriptor_t kType = [] {
    dds_topic_descriptor_t type = rmw_dds_common_humble_msg_dds__ParticipantEntitiesInfo__desc;
    type.m_typename = rmw_dds_common_msg_dds__ParticipantEntitiesInfo__desc.m_typename;
    return type;
  }();
  return kType;
}

const dds_topic_descriptor_t* KnownType(std::string_view type) {
  if (const auto* const known = DescriptorOf(type)) return known;
  throw InputError(fmt::format("the type {} is not spoken over DDS", type));
}

// Bytes beyond those of DDS are zeros.
template <std::size_t kSize>
GidMessage<kSize> GidMessageOf(const dds_guid_t& guid) {
  GidMessage<kSize> message;
  std::copy(std::begin(guid.v), std::end(guid.v), message.data.begin());
  return message;
}

// Returns "rt/tf" for "/tf" and "tf".
std::string DdsTopicName(std::string_view topic) {
  return fmt::format("{}{}", kTopicPrefix, topic.substr(topic.starts_with('/')));
}

std::string HashOf(std::string_view type) { return fmt::format("typehash={};", TypeHash(type)); }

}  // namespace

struct Ros2Node::Entities {
  // Lists a node's publishers and subscribers for others.
  struct NodeInfo {
    std::string name;
    dds_guid_t participant{};
    std::vector<dds_guid_t> readers;
    std::vector<dds_guid_t> writers;
  };

  // Deletes all its entities, too.
  struct Participant {
    Participant() = default;
    ~Participant() {
      if (id > 0) dds_delete(id);
    }
    Participant(const Participant&) = delete;
    Participant& operator=(const Participant&) = delete;

    dds_entity_t id = 0;
  };

  struct Publisher {
    dds_entity_t writer;
    const dds_topic_descriptor_t* type;
  };

  struct Inbox {
    dds_entity_t waitset;
    std::vector<dds_entity_t> readers;
  };

  Entities(int domain_number, Ros2NodeOptions node_options)
      : domain(domain_number), options(std::move(node_options)), opened(OpenDdsDomain(domain)) {
    constexpr std::string_view kEnclave = "enclave=/;";
    const QosPointer qos(dds_create_qos());
    dds_qset_userdata(qos.get(), kEnclave.data(), kEnclave.size());
    participant.id =
        Require(dds_create_participant(static_cast<dds_domainid_t>(domain), qos.get(), nullptr),
                "participant (is there a network?)");
    discovery = Require(
        dds_create_reader(participant.id, DDS_BUILTIN_TOPIC_DCPSPUBLICATION, nullptr, nullptr),
        "reader");
    info.participant = GuidOf(participant.id);
    info.name = options.name;
    const dds_topic_descriptor_t* const type =
        options.is_humble ? &HumbleInfo() : DescriptorOf(kDiscoveryInfo);
    constexpr Ros2Qos kInfoQos{true, true, 1};
    info_publisher = {Write("ros_discovery_info", type, kInfoQos, kDiscoveryInfo), type};
    PublishInfo();
  }

  dds_entity_t Require(dds_entity_t entity, const char* what) const {
    if (entity >= 0) return entity;
    throw InputError(
        fmt::format("DDS domain {}: no {}: {}", domain, what, dds_strretcode(-entity)));
  }

  dds_entity_t TopicOf(const std::string& name, const dds_topic_descriptor_t* type) const {
    return Require(dds_create_topic(participant.id, type, name.c_str(), nullptr, nullptr),
                   ("topic " + name).c_str());
  }
  dds_entity_t Write(const std::string& name, const dds_topic_descriptor_t* type,
                     const Ros2Qos& qos, std::string_view ros_type) const {
    return Require(dds_create_writer(participant.id, TopicOf(name, type),
                                     MakeQos(qos, HashOf(ros_type)).get(), nullptr),
                   "writer");
  }

  static dds_guid_t GuidOf(dds_entity_t entity) {
    dds_guid_t guid{};
    dds_get_guid(entity, &guid);
    return guid;
  }

  template <std::size_t kSize>
  static std::string BytesOf(const NodeInfo& info) {
    ParticipantEntitiesMessage<kSize> message{GidMessageOf<kSize>(info.participant), {}};
    auto& node = message.nodes.emplace_back();
    node.name_space.push_back('/');
    node.name.assign(info.name);
    for (const dds_guid_t& reader : info.readers)
      node.readers.push_back(GidMessageOf<kSize>(reader));
    for (const dds_guid_t& writer : info.writers)
      node.writers.push_back(GidMessageOf<kSize>(writer));
    return SerializeMessage(message, WireFormat::kCdr);
  }

  void PublishInfo() const {
    static_cast<void>(Publish(info_publisher, options.is_humble ? BytesOf<kHumbleGidSize>(info)
                                                                : BytesOf<kGidSize>(info)));
  }

  Inbox& InboxOf(std::size_t index) {
    while (inboxes.size() <= index) {
      inboxes.push_back({Require(dds_create_waitset(participant.id), "waitset"), {}});
    }
    return inboxes[index];
  }

  static bool Publish(const Publisher& publisher, std::string_view bytes) {
    return WriteCdr(publisher.writer, *publisher.type, bytes);
  }

  int domain;
  Ros2NodeOptions options;
  std::shared_ptr<const void> opened;
  Participant participant;
  dds_entity_t discovery = 0;  // receives what others publish
  Publisher info_publisher{};
  NodeInfo info;
  std::vector<Publisher> publishers;
  std::vector<Inbox> inboxes;
};

Ros2Node::Ros2Node(int domain, const Ros2NodeOptions& options)
    : entities_(std::make_unique<Entities>(DdsDomain(domain), options)) {}

Ros2Node::~Ros2Node() = default;

bool Ros2Node::Knows(std::string_view type) { return DescriptorOf(type) != nullptr; }

std::size_t Ros2Node::Advertise(const std::string& topic, std::string_view type,
                                const Ros2Qos& qos) {
  const dds_topic_descriptor_t* const known = KnownType(type);
  const dds_entity_t writer = entities_->Write(DdsTopicName(topic), known, qos, type);
  entities_->publishers.push_back({writer, known});
  entities_->info.writers.push_back(Entities::GuidOf(writer));
  entities_->PublishInfo();
  return entities_->publishers.size() - 1;
}

bool Ros2Node::HasSubscribers(std::size_t publisher) const {
  dds_publication_matched_status_t status{};
  dds_get_publication_matched_status(entities_->publishers[publisher].writer, &status);
  return status.current_count > 0;
}

bool Ros2Node::Publish(std::size_t publisher, std::string_view bytes) {
  return Entities::Publish(entities_->publishers[publisher], bytes);
}

void Ros2Node::Flush(Duration timeout) const {
  const Time end = Now() + timeout;
  for (const Entities::Publisher& publisher : entities_->publishers) {
    dds_wait_for_acks(publisher.writer, std::max(end - Now(), Duration::zero()).count());
  }
}

std::size_t Ros2Node::Subscribe(const std::string& topic, std::string_view type, const Ros2Qos& qos,
                                std::size_t inbox) {
  Entities::Inbox& subscribers = entities_->InboxOf(inbox);
  const dds_entity_t participant = entities_->participant.id;
  const dds_entity_t reader = entities_->Require(
      dds_create_reader(participant, entities_->TopicOf(DdsTopicName(topic), KnownType(type)),
                        MakeQos(qos, HashOf(type)).get(), nullptr),
      "reader");
  dds_set_status_mask(reader, DDS_DATA_AVAILABLE_STATUS);
  entities_->Require(dds_waitset_attach(subscribers.waitset, reader,
                                        static_cast<dds_attach_t>(subscribers.readers.size())),
                     "waiting for messages");
  subscribers.readers.push_back(reader);
  entities_->info.readers.push_back(Entities::GuidOf(reader));
  entities_->PublishInfo();
  return subscribers.readers.size() - 1;
}

void Ros2Node::Take(Duration timeout, const TakeMessage& take, std::size_t inbox) {
  const Entities::Inbox& subscribers = entities_->inboxes[inbox];
  dds_waitset_wait(subscribers.waitset, nullptr, 0, timeout.count());
  for (std::size_t i = 0; i < subscribers.readers.size(); ++i) {
    TakeCdr(subscribers.readers[i], [&](std::string_view bytes) { take(i, bytes); });
  }
}

std::vector<RosTopic> Ros2Node::Topics() const {
  constexpr std::size_t kMost = 1024;
  std::vector<void*> samples(kMost, nullptr);
  std::vector<dds_sample_info_t> infos(kMost);
  std::map<std::string, std::string> types;  // by topic
  const int count =
      dds_read_mask(entities_->discovery, samples.data(), infos.data(), kMost, kMost,
                    DDS_ANY_SAMPLE_STATE | DDS_ANY_VIEW_STATE | DDS_ALIVE_INSTANCE_STATE);
  for (int i = 0; i < count; ++i) {
    const auto* const endpoint = static_cast<const dds_builtintopic_endpoint_t*>(samples[i]);
    const bool is_own = std::memcmp(endpoint->participant_key.v, entities_->info.participant.v,
                                    sizeof(dds_guid_t)) == 0;
    const std::string_view name = infos[i].valid_data ? endpoint->topic_name : "";
    if (is_own || !name.starts_with(kTopicPrefix)) continue;
    const auto type = RosTypeOf(endpoint->type_name);
    if (!type || !Knows(*type)) continue;
    types.emplace(PlainTopicName(name.substr(kTopicPrefix.size() - 1)), *type);
  }
  if (count > 0) dds_return_loan(entities_->discovery, samples.data(), count);
  std::vector<RosTopic> topics;
  for (const auto& [name, type] : types) topics.push_back({name, type, WireFormat::kCdr, {}});
  return topics;
}

}  // namespace kestrel
