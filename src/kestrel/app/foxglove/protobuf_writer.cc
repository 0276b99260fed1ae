// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/app/foxglove/protobuf_writer.h"

namespace kestrel {
namespace {

constexpr std::int64_t kSecond_ns = 1'000'000'000;

}  // namespace

TimestampMessage TimestampOf(Time time) {
  const std::int64_t ns = ToNanoseconds(time);
  const std::int64_t seconds = ns / kSecond_ns - (ns % kSecond_ns < 0 ? 1 : 0);
  return {seconds, static_cast<int>(ns - seconds * kSecond_ns)};
}

DurationMessage DurationOf(Duration duration) {
  return {duration.count() / kSecond_ns, static_cast<int>(duration.count() % kSecond_ns)};
}

// Seven bits per byte, the lowest first; the eighth bit is set in all bytes but the last.
void ProtobufWriter::PutVarint(std::uint64_t value) {
  constexpr std::uint64_t kMore = 0x80;
  for (; value >= kMore; value >>= 7) *bytes_ += static_cast<char>(value | kMore);
  *bytes_ += static_cast<char>(value);
}

void ProtobufWriter::PutBlock(int number, std::string_view content) {
  PutTag(number, kBlock);
  PutVarint(content.size());
  bytes_->append(content);
}

void ProtobufWriter::PutDoubles(int number, const double* values, std::size_t count) {
  if (count == 0) return;
  PutBlock(number, {reinterpret_cast<const char*>(values), count * sizeof(double)});
}

}  // namespace kestrel
