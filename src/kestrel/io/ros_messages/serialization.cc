// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/io/ros_messages/serialization.h"

#include <fmt/format.h>

#include "kestrel/core/base/error.h"

namespace kestrel {
namespace {

constexpr std::size_t kEncapsulation = 4;  // bytes before the data of CDR, from which it is aligned
constexpr std::int64_t kSecond = 1'000'000'000;

std::size_t PaddingBefore(std::size_t offset, std::size_t size) {
  return (size - (offset - kEncapsulation) % size) % size;
}

}  // namespace

WireReader::WireReader(std::string_view bytes, WireFormat format, const std::string& name)
    : reader_(bytes), size_(bytes.size()), format_(format), name_(&name) {
  if (format_ != WireFormat::kCdr) return;
  const std::string_view head = Take(kEncapsulation);
  if (head[0] != 0 || (head[1] != 0 && head[1] != 1)) {
    throw InputError(fmt::format(
        "{}: is serialized as {:02x}{:02x}, expected plain CDR (0000 or "
        "0001)",
        name, static_cast<unsigned char>(head[0]), static_cast<unsigned char>(head[1])));
  }
  is_big_endian_ = head[1] == 0;
}

// The seconds are signed in ROS 2 and unsigned in ROS 1.
void WireReader::Read(Time& time) {
  std::uint32_t seconds = 0;
  std::uint32_t nanoseconds = 0;
  Read(seconds);
  Read(nanoseconds);
  const std::int64_t whole = format_ == WireFormat::kCdr
                                 ? static_cast<std::int64_t>(static_cast<std::int32_t>(seconds))
                                 : static_cast<std::int64_t>(seconds);
  time = TimeFromNanoseconds(whole * kSecond + nanoseconds);
}

// Any byte but zero is true.
void WireReader::Read(bool& value) {
  std::uint8_t byte = 0;
  Read(byte);
  value = byte != 0;
}

void WireReader::Read(std::string& text) {
  std::string_view bytes = Take(Count());
  if (format_ == WireFormat::kCdr && bytes.ends_with('\0')) bytes.remove_suffix(1);
  text = bytes;
}

std::uint32_t WireReader::Count() {
  std::uint32_t count = 0;
  Read(count);
  return count;
}

void WireReader::Align(std::size_t size) {
  if (format_ == WireFormat::kCdr) Take(PaddingBefore(size_ - reader_.left(), size));
}

std::string_view WireReader::Take(std::size_t count) {
  const std::string_view taken = reader_.Bytes(count);
  if (reader_.has_failed()) {
    throw InputError(
        fmt::format("{}: the message ends after {} bytes, expected more", *name_, size_));
  }
  return taken;
}

WireWriter::WireWriter(WireFormat format) : format_(format) {
  if (format_ == WireFormat::kCdr) bytes_.assign({0, 1, 0, 0});
}

void WireWriter::Write(const Time& time) {
  std::int64_t seconds = ToNanoseconds(time) / kSecond;
  std::int64_t nanoseconds = ToNanoseconds(time) % kSecond;
  if (nanoseconds < 0) {
    seconds -= 1;
    nanoseconds += kSecond;
  }
  Write(static_cast<std::uint32_t>(seconds));
  Write(static_cast<std::uint32_t>(nanoseconds));
}

void WireWriter::Write(const std::string& text) {
  const bool has_end = format_ == WireFormat::kCdr;
  Write(static_cast<std::uint32_t>(text.size() + has_end));
  bytes_.append(text);
  if (has_end) bytes_.push_back('\0');
}

void WireWriter::Write(const std::string_view& bytes) {
  Write(static_cast<std::uint32_t>(bytes.size()));
  bytes_.append(bytes);
}

void WireWriter::Align(std::size_t size) {
  if (format_ == WireFormat::kCdr) bytes_.append(PaddingBefore(bytes_.size(), size), '\0');
}

}  // namespace kestrel
