// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/flight/ros1/ros1_connection.h"

#include <boost/make_shared.hpp>
#include <cstring>
#include <deque>
#include <ros/master.h>
#include <ros/ros.h>
#include <ros/subscription_callback_helper.h>
#include <sstream>
#include <std_srvs/Trigger.h>
#include <typeinfo>
#include <xmlrpcpp/XmlRpcValue.h>

namespace kestrel {
namespace {

// A message that is already serialized.
struct Bytes {
  const std::string* text;
};

}  // namespace
}  // namespace kestrel

namespace ros::message_traits {
template <>
struct MD5Sum<kestrel::Bytes> {
  static const char* value() { return "*"; }
  static const char* value(const kestrel::Bytes&) { return "*"; }
};
template <>
struct DataType<kestrel::Bytes> {
  static const char* value() { return "*"; }
  static const char* value(const kestrel::Bytes&) { return "*"; }
};
}  // namespace ros::message_traits

namespace ros::serialization {
template <>
struct Serializer<kestrel::Bytes> {
  template <class Stream>
  static void write(Stream& stream, const kestrel::Bytes& bytes) {
    std::memcpy(stream.advance(static_cast<std::uint32_t>(bytes.text->size())), bytes.text->data(),
                bytes.text->size());
  }
  static std::uint32_t serializedLength(const kestrel::Bytes& bytes) {
    return static_cast<std::uint32_t>(bytes.text->size());
  }
};
}  // namespace ros::serialization

namespace kestrel {
namespace {

struct TypedBytes {
  std::string type;
  std::string bytes;
};

// Takes messages of any type as serialized bytes.
class BytesCallback : public ros::SubscriptionCallbackHelper {
 public:
  explicit BytesCallback(Ros1Connection::TakeMessage take) : take_(std::move(take)) {}

  ros::VoidConstPtr deserialize(
      const ros::SubscriptionCallbackHelperDeserializeParams& params) override {
    const auto message = boost::make_shared<TypedBytes>();
    const auto type = params.connection_header->find("type");
    if (type != params.connection_header->end()) message->type = type->second;
    message->bytes.assign(reinterpret_cast<const char*>(params.buffer), params.length);
    return message;
  }
  void call(ros::SubscriptionCallbackHelperCallParams& params) override {
    const auto message =
        boost::static_pointer_cast<TypedBytes const>(params.event.getConstMessage());
    take_(message->type, message->bytes);
  }
  const std::type_info& getTypeInfo() override { return typeid(TypedBytes); }
  bool isConst() override { return true; }
  bool hasHeader() override { return false; }

 private:
  Ros1Connection::TakeMessage take_;
};

std::string TextOf(const XmlRpc::XmlRpcValue& value) {
  std::ostringstream text;
  text.precision(17);
  switch (value.getType()) {
    case XmlRpc::XmlRpcValue::TypeBoolean:
      text << (static_cast<const bool&>(value) ? "true" : "false");
      break;
    case XmlRpc::XmlRpcValue::TypeDouble:
      text << static_cast<const double&>(value);
      break;
    case XmlRpc::XmlRpcValue::TypeString:
      text << static_cast<const std::string&>(value);
      break;
    default:
      value.write(text);
  }
  return text.str();
}

void AddParameters(const std::string& name, const XmlRpc::XmlRpcValue& value,
                   std::vector<std::pair<std::string, std::string>>* parameters) {
  if (value.getType() != XmlRpc::XmlRpcValue::TypeStruct) {
    parameters->emplace_back(name, TextOf(value));
    return;
  }
  const std::string prefix = name.empty() ? "" : name + ".";
  for (const auto& [key, part] : value) AddParameters(prefix + key, part, parameters);
}

}  // namespace

struct Ros1Connection::State {
  ros::NodeHandle handle;
  ros::NodeHandle private_handle{"~"};
  std::vector<ros::Subscriber> subscribers;
  std::deque<ros::Publisher> publishers;
  std::vector<ros::ServiceServer> services;
};

Ros1Connection::Ros1Connection(int* argc, char** argv, const std::string& node,
                               bool handles_interrupts) {
  const std::uint32_t no_handler = ros::init_options::NoSigintHandler;
  ros::init(*argc, argv, node, handles_interrupts ? 0 : no_handler);
  if (ros::master::check()) state_ = std::make_unique<State>();
}

Ros1Connection::~Ros1Connection() = default;

bool Ros1Connection::HasMaster() const { return state_ != nullptr; }

std::vector<std::pair<std::string, std::string>> Ros1Connection::Parameters() const {
  std::vector<std::pair<std::string, std::string>> parameters;
  XmlRpc::XmlRpcValue value;
  if (ros::param::get(ros::this_node::getName(), value)) AddParameters("", value, &parameters);
  return parameters;
}

std::string Ros1Connection::ResolvedName(const std::string& topic) const {
  return state_->handle.resolveName(topic);
}

void Ros1Connection::Subscribe(const std::string& topic, const MessageType& type,
                               std::uint32_t queue, const TakeMessage& take) {
  ros::SubscribeOptions options(topic, queue, type.checksum, type.name);
  options.helper = boost::make_shared<BytesCallback>(take);
  options.transport_hints = ros::TransportHints().tcpNoDelay();
  state_->subscribers.push_back(state_->handle.subscribe(options));
}

std::size_t Ros1Connection::Advertise(const std::string& topic, const MessageType& type,
                                      bool is_latched) {
  constexpr std::uint32_t kQueue = 10;
  ros::AdvertiseOptions options(topic, kQueue, type.checksum, type.name, type.definition);
  options.latch = is_latched;
  state_->publishers.push_back(state_->private_handle.advertise(options));
  return state_->publishers.size() - 1;
}

bool Ros1Connection::HasSubscribers(std::size_t topic) const {
  return state_->publishers[topic].getNumSubscribers() > 0;
}

void Ros1Connection::Publish(std::size_t topic, const std::string& bytes) {
  state_->publishers[topic].publish(Bytes{&bytes});
}

void Ros1Connection::Offer(const std::string& name, const Service& service) {
  using Request = std_srvs::Trigger::Request;
  using Response = std_srvs::Trigger::Response;
  const boost::function<bool(Request&, Response&)> call = [service](Request&, Response& response) {
    const Answer answer = service();
    response.success = answer.success;
    response.message = answer.message;
    return true;
  };
  state_->services.push_back(state_->private_handle.advertiseService(name, call));
}

void Ros1Connection::Spin(const std::function<void()>& tick) {
  const ros::WallTimer timer = state_->private_handle.createWallTimer(
      ros::WallDuration(1), [&tick](const ros::WallTimerEvent&) { tick(); });
  ros::spin();
}

void Ros1Connection::Warn(const std::string& text) const { ROS_WARN("%s", text.c_str()); }

std::int64_t Ros1Connection::NowNanoseconds() const {
  return static_cast<std::int64_t>(ros::Time::now().toNSec());
}

}  // namespace kestrel
