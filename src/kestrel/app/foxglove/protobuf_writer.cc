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

void ProtobufWriter::PutBlock(int number, std::string_view content) {
  PutTag(number, kBlock);
  PutVarint(content.size(), bytes_);
  bytes_->append(content);
}

void ProtobufWriter::PutDoubles(int number, const double* values, std::size_t count) {
  if (count == 0) return;
  PutBlock(number, {reinterpret_cast<const char*>(values), count * sizeof(double)});
}

}  // namespace kestrel
