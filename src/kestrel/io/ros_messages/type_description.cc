// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/io/ros_messages/type_description.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <type_traits>
#include <utility>

#include <fmt/format.h>

#include "kestrel/core/base/error.h"
#include "kestrel/io/ros_messages/messages.h"
#include "kestrel/io/ros_messages/node_messages.h"
#include "kestrel/io/ros_messages/result_messages.h"
#include "kestrel/io/ros_messages/tag_messages.h"

namespace kestrel {
namespace {

template <class Type>
struct Tag {};

// Visits the fields of messages and describes them.
class TypeDescriber {
 public:
  explicit TypeDescriber(WireFormat format) : format_(format) {}

  template <RosMessage Message>
  void Describe() {
    const bool is_known = std::any_of(types_.begin(), types_.end(), [](const auto& known) {
      return known.type == Message::kType;
    });
    if (is_known) return;
    const std::size_t outer = std::exchange(current_, types_.size());
    std::string_view constants;
    if constexpr (requires { Message::kConstants; }) constants = Message::kConstants;
    types_.push_back({Message::kType, constants, {}});
    Message message;
    Message::Fields(message, *this);
    current_ = outer;
  }

  template <class Field>
  void operator()(FieldName name, const Field&) {
    // Evaluated first: it may describe the field's type.
    std::string type = NameOf(Tag<Field>());
    types_[current_].fields.push_back(
        {std::move(type), format_ == WireFormat::kRos1 ? name.ros1 : name.ros2});
  }
  template <class Field>
  void OfRos1(FieldName name, const Field& field) {
    if (format_ == WireFormat::kRos1) (*this)(name, field);
  }

  std::vector<TypeDescription> Take() { return std::move(types_); }

 private:
  static std::string NameOf(Tag<bool>) { return "bool"; }
  static std::string NameOf(Tag<char>) { return "char"; }
  static std::string NameOf(Tag<std::uint8_t>) { return "uint8"; }
  static std::string NameOf(Tag<std::int32_t>) { return "int32"; }
  static std::string NameOf(Tag<std::uint32_t>) { return "uint32"; }
  static std::string NameOf(Tag<float>) { return "float32"; }
  static std::string NameOf(Tag<double>) { return "float64"; }
  static std::string NameOf(Tag<std::string>) { return "string"; }
  static std::string NameOf(Tag<std::string_view>) { return "uint8[]"; }
  template <std::size_t kMax>
  static std::string NameOf(Tag<BoundedText<kMax>>) {
    return fmt::format("string<={}", kMax);
  }
  template <class Enum>
  requires(std::is_enum_v<Enum> && sizeof(Enum) == 1) static std::string NameOf(Tag<Enum>) {
    return "byte";
  }
  std::string NameOf(Tag<Time>) {
    return format_ == WireFormat::kRos1 ? "time" : NameOf(Tag<TimeMessage>());
  }
  template <class Element, std::size_t kSize>
  std::string NameOf(Tag<std::array<Element, kSize>>) {
    return fmt::format("{}[{}]", NameOf(Tag<Element>()), kSize);
  }
  template <class Element>
  std::string NameOf(Tag<std::vector<Element>>) {
    return NameOf(Tag<Element>()) + "[]";
  }
  template <RosMessage Message>
  std::string NameOf(Tag<Message>) {
    Describe<Message>();
    return std::string(Message::kType);
  }

  WireFormat format_;
  std::vector<TypeDescription> types_;
  std::size_t current_ = 0;  // index of the type whose fields are visited
};

struct KnownType {
  std::string_view name;
  void (TypeDescriber::*describe)();
};
template <class... Messages>
constexpr std::array<KnownType, sizeof...(Messages)> Known() {
  return {KnownType{Messages::kType, &TypeDescriber::Describe<Messages>}...};
}

constexpr auto kBothTypes =
    Known<ImageMessage, CompressedImageMessage, CameraInfoMessage, PoseStampedMessage,
          PoseWithCovarianceStampedMessage, TransformStampedMessage, TfMessage, OdometryMessage>();
constexpr auto kRos2Types =
    Known<PathMessage, MarkerArrayMessage, DiagnosticArrayMessage, Detection3DArrayMessage,
          TagArrayMessage, ParticipantEntitiesMessage<kGidSize>,
          ParticipantEntitiesMessage<kHumbleGidSize>>();

template <class Types>
const KnownType* Find(const Types& types, std::string_view name) {
  const auto found = std::find_if(types.begin(), types.end(),
                                  [&](const KnownType& known) { return known.name == name; });
  return found == types.end() ? nullptr : &*found;
}

}  // namespace

std::vector<TypeDescription> DescribeType(std::string_view type, WireFormat format) {
  const KnownType* known = Find(kBothTypes, type);
  if (known == nullptr && format == WireFormat::kCdr) known = Find(kRos2Types, type);
  if (known == nullptr) throw InputError(fmt::format("the type {} is not written", type));
  TypeDescriber describer(format);
  (describer.*known->describe)();
  return describer.Take();
}

const std::vector<std::string_view>& Ros2Types() {
  static const std::vector<std::string_view> kNames = [] {
    std::vector<std::string_view> names;
    for (const KnownType& known : kBothTypes) names.push_back(known.name);
    for (const KnownType& known : kRos2Types) names.push_back(known.name);
    return names;
  }();
  return kNames;
}

}  // namespace kestrel
