// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/io/ros_messages/foxglove_message.h"

#include <algorithm>
#include <array>
#include <utility>
#include <vector>

#include "kestrel/core/base/bytes.h"
#include "kestrel/core/base/error.h"

namespace kestrel {
namespace {

constexpr std::array<std::pair<std::string_view, std::string_view>, 5> kTypes = {{
    {"foxglove.RawImage", ImageMessage::kType},
    {"foxglove.CompressedImage", CompressedImageMessage::kType},
    {"foxglove.CameraCalibration", CameraInfoMessage::kType},
    {"foxglove.PoseInFrame", PoseStampedMessage::kType},
    {"foxglove.FrameTransforms", TfMessage::kType},
}};

// The fields of a message, one after the other (protobuf.dev/programming-guides/encoding).
class ProtobufFields {
 public:
  ProtobufFields(std::string_view bytes, const std::string& name)
      : cursor_(bytes, name), name_(&name) {}

  // Goes to the next field; false at the end.
  bool Next() {
    if (cursor_.left() == 0) return false;
    const std::uint64_t tag = cursor_.Varint();
    number_ = static_cast<int>(tag >> 3);
    block_ = {};
    switch (tag & 7) {
      case 0:
        integer_ = cursor_.Varint();
        return true;
      case 1:
        block_ = cursor_.Bytes(8);
        return true;
      case 2:
        block_ = cursor_.Bytes(cursor_.Varint());
        return true;
      case 5:
        block_ = cursor_.Bytes(4);
        return true;
      default:
        throw InputError(*name_ + ": is no message of protobuf");
    }
  }

  int number() const { return number_; }
  std::uint64_t integer() const { return integer_; }
  std::string_view block() const { return block_; }
  std::string Text() const { return std::string(block_); }
  const std::string& name() const { return *name_; }

  template <class Number>
  Number Fixed() const {
    Number value{};
    std::copy_n(block_.data(), std::min(sizeof(value), block_.size()),
                reinterpret_cast<char*>(&value));
    return value;
  }
  std::vector<double> Doubles() const {
    std::vector<double> values(block_.size() / sizeof(double));
    std::copy_n(block_.data(), values.size() * sizeof(double),
                reinterpret_cast<char*>(values.data()));
    return values;
  }
  template <std::size_t kSize>
  void Copy(std::array<double, kSize>* values) const {
    const std::vector<double> all = Doubles();
    std::copy_n(all.begin(), std::min(kSize, all.size()), values->begin());
  }

 private:
  ByteCursor cursor_;
  const std::string* name_;
  int number_ = 0;
  std::uint64_t integer_ = 0;
  std::string_view block_;
};

Time TimeOf(const ProtobufFields& field) {
  constexpr std::int64_t kSecond_ns = 1'000'000'000, kMaxSeconds = 9'000'000'000;
  std::int64_t seconds = 0, nanos = 0;
  for (ProtobufFields part(field.block(), field.name()); part.Next();) {
    (part.number() == 1 ? seconds : nanos) = static_cast<std::int64_t>(part.integer());
  }
  if (seconds < 0 || seconds > kMaxSeconds || nanos < 0 || nanos >= kSecond_ns) {
    throw InputError(field.name() + ": its timestamp is out of range");
  }
  return TimeFromNanoseconds(seconds * kSecond_ns + nanos);
}

// x, y, z and, of a quaternion, w.
std::array<double, 4> NumbersOf(const ProtobufFields& field) {
  std::array<double, 4> numbers{};
  for (ProtobufFields part(field.block(), field.name()); part.Next();) {
    if (part.number() >= 1 && part.number() <= 4)
      numbers.at(part.number() - 1) = part.Fixed<double>();
  }
  return numbers;
}

// 'Vector': PointMessage or Vector3Message.
template <class Vector>
Vector VectorOf(const ProtobufFields& field) {
  const auto [x, y, z, unused] = NumbersOf(field);
  return {x, y, z};
}

QuaternionMessage QuaternionOf(const ProtobufFields& field) {
  const auto [x, y, z, w] = NumbersOf(field);
  return {x, y, z, w};
}

PoseMessage PoseOf(const ProtobufFields& field) {
  PoseMessage pose;
  for (ProtobufFields part(field.block(), field.name()); part.Next();) {
    if (part.number() == 1) pose.position = VectorOf<PointMessage>(part);
    if (part.number() == 2) pose.orientation = QuaternionOf(part);
  }
  return pose;
}

TransformStampedMessage TransformOf(const ProtobufFields& field) {
  TransformStampedMessage transform;
  for (ProtobufFields part(field.block(), field.name()); part.Next();) {
    if (part.number() == 1) transform.header.stamp = TimeOf(part);
    if (part.number() == 2) transform.header.frame_id = part.Text();
    if (part.number() == 3) transform.child_frame_id = part.Text();
    if (part.number() == 4) transform.transform.translation = VectorOf<Vector3Message>(part);
    if (part.number() == 5) transform.transform.rotation = QuaternionOf(part);
  }
  return transform;
}

}  // namespace

std::optional<std::string_view> RosTypeOfFoxglove(std::string_view type) {
  for (const auto& [foxglove, ros] : kTypes) {
    if (foxglove == type) return ros;
  }
  return std::nullopt;
}

// A compressed image has its frame as field 4, which is the encoding of a raw one; that has it
// as 7.
void ParseFoxglove(std::string_view bytes, const std::string& name, HeaderMessage* message) {
  bool is_raw = false;
  for (ProtobufFields field(bytes, name); field.Next();) {
    if (field.number() == 1) message->stamp = TimeOf(field);
    if (field.number() == 7 || (field.number() == 4 && !is_raw)) message->frame_id = field.Text();
    is_raw = is_raw || field.number() == 7;
  }
}

void ParseFoxglove(std::string_view bytes, const std::string& name, ImageMessage* message) {
  for (ProtobufFields field(bytes, name); field.Next();) {
    if (field.number() == 1) message->header.stamp = TimeOf(field);
    if (field.number() == 2) message->width = field.Fixed<std::uint32_t>();
    if (field.number() == 3) message->height = field.Fixed<std::uint32_t>();
    if (field.number() == 4) message->encoding = field.Text();
    if (field.number() == 5) message->step = field.Fixed<std::uint32_t>();
    if (field.number() == 6) message->data = field.block();
    if (field.number() == 7) message->header.frame_id = field.Text();
  }
}

void ParseFoxglove(std::string_view bytes, const std::string& name,
                   CompressedImageMessage* message) {
  for (ProtobufFields field(bytes, name); field.Next();) {
    if (field.number() == 1) message->header.stamp = TimeOf(field);
    if (field.number() == 2) message->data = field.block();
    if (field.number() == 3) message->format = field.Text();
    if (field.number() == 4) message->header.frame_id = field.Text();
  }
}

void ParseFoxglove(std::string_view bytes, const std::string& name, CameraInfoMessage* message) {
  for (ProtobufFields field(bytes, name); field.Next();) {
    if (field.number() == 1) message->header.stamp = TimeOf(field);
    if (field.number() == 2) message->width = field.Fixed<std::uint32_t>();
    if (field.number() == 3) message->height = field.Fixed<std::uint32_t>();
    if (field.number() == 4) message->distortion_model = field.Text();
    if (field.number() == 5) message->d = field.Doubles();
    if (field.number() == 6) field.Copy(&message->k);
    if (field.number() == 7) field.Copy(&message->r);
    if (field.number() == 8) field.Copy(&message->p);
    if (field.number() == 9) message->header.frame_id = field.Text();
  }
  // Foxglove's name for the model that ROS calls equidistant.
  if (message->distortion_model == "kannala_brandt") message->distortion_model = "equidistant";
}

void ParseFoxglove(std::string_view bytes, const std::string& name, PoseStampedMessage* message) {
  for (ProtobufFields field(bytes, name); field.Next();) {
    if (field.number() == 1) message->header.stamp = TimeOf(field);
    if (field.number() == 2) message->header.frame_id = field.Text();
    if (field.number() == 3) message->pose = PoseOf(field);
  }
}

void ParseFoxglove(std::string_view bytes, const std::string& name, TfMessage* message) {
  for (ProtobufFields field(bytes, name); field.Next();) {
    if (field.number() == 1) message->transforms.push_back(TransformOf(field));
  }
}

}  // namespace kestrel
