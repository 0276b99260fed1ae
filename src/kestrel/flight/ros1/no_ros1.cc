// SPDX-License-Identifier: BSD-3-Clause
// Replaces ros1_connection.cc when ROS is not installed.
#include "kestrel/core/base/error.h"
#include "kestrel/flight/ros1/ros1_connection.h"

namespace kestrel {
namespace {

#ifdef KESTREL_EXTENSION
constexpr char kHowToGetIt[] = "this needs ROS: apt install " KESTREL_EXTENSION;
#else
constexpr char kHowToGetIt[] =
    "this kestrel was built without ROS: run scripts/install-deps --ros and build it again";
#endif

}  // namespace

struct Ros1Connection::State {};

Ros1Connection::Ros1Connection(int* /*argc*/, char** /*argv*/, const std::string& /*node*/,
                               bool /*handles_interrupts*/) {
  throw InputError(kHowToGetIt);
}

Ros1Connection::~Ros1Connection() = default;

bool Ros1Connection::HasMaster() const { return false; }

std::vector<std::pair<std::string, std::string>> Ros1Connection::Parameters() const { return {}; }

std::string Ros1Connection::ResolvedName(const std::string& topic) const { return topic; }

void Ros1Connection::Subscribe(const std::string& /*topic*/, const MessageType& /*type*/,
                               std::uint32_t /*queue*/, const TakeMessage& /*take*/) {}

std::size_t Ros1Connection::Advertise(const std::string& /*topic*/, const MessageType& /*type*/,
                                      bool /*is_latched*/) {
  return 0;
}

bool Ros1Connection::HasSubscribers(std::size_t /*topic*/) const { return false; }

void Ros1Connection::Publish(std::size_t /*topic*/, const std::string& /*bytes*/) {}

void Ros1Connection::Offer(const std::string& /*name*/, const Service& /*service*/) {}

void Ros1Connection::Spin(const std::function<void()>& /*tick*/) {}

void Ros1Connection::Warn(const std::string& /*text*/) const {}

std::int64_t Ros1Connection::NowNanoseconds() const { return 0; }

}  // namespace kestrel
