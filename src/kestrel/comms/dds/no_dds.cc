// SPDX-License-Identifier: BSD-3-Clause
// Replaces the sources that use Cyclone DDS when it is not installed.
#include "kestrel/comms/dds/ros2_node.h"
#include "kestrel/comms/dds/team_topic.h"
#include "kestrel/core/base/error.h"

namespace kestrel {
namespace {

#ifdef KESTREL_EXTENSION
constexpr char kHowToGetIt[] = "this needs DDS: apt install " KESTREL_EXTENSION;
#else
constexpr char kHowToGetIt[] =
    "this kestrel was built without DDS: run scripts/install-deps --dds and build it again";
#endif

[[noreturn]] void FailWithoutDds() { throw InputError(kHowToGetIt); }

}  // namespace

struct Ros2Node::Entities {};

Ros2Node::Ros2Node(int /*domain*/, const Ros2NodeOptions& /*options*/) { FailWithoutDds(); }

Ros2Node::~Ros2Node() = default;

bool Ros2Node::Knows(std::string_view /*type*/) { return false; }

std::size_t Ros2Node::Advertise(const std::string& /*topic*/, std::string_view /*type*/,
                                const Ros2Qos& /*qos*/) {
  return 0;
}

bool Ros2Node::HasSubscribers(std::size_t /*publisher*/) const { return false; }

bool Ros2Node::Publish(std::size_t /*publisher*/, std::string_view /*bytes*/) { return false; }

void Ros2Node::Flush(Duration /*timeout*/) const {}

std::size_t Ros2Node::Subscribe(const std::string& /*topic*/, std::string_view /*type*/,
                                const Ros2Qos& /*qos*/, std::size_t /*inbox*/) {
  return 0;
}

void Ros2Node::Take(Duration /*timeout*/, const TakeMessage& /*take*/, std::size_t /*inbox*/) {}

std::vector<RosTopic> Ros2Node::Topics() const { return {}; }

struct TeamTopic::Entities {};

TeamTopic::TeamTopic(int /*domain*/, const std::string& /*team*/, const std::string& /*sender*/) {
  FailWithoutDds();
}

TeamTopic::~TeamTopic() = default;

void TeamTopic::Send(std::span<const std::uint8_t> /*bytes*/) {}

void TeamTopic::Receive(const std::function<void(std::span<const std::uint8_t>)>& /*hear*/) {}

}  // namespace kestrel
