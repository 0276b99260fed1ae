// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/comms/mavlink/stream_requests.h"

#include <algorithm>

namespace kestrel {
namespace {

constexpr Duration kQuick = std::chrono::milliseconds(1100);  // a whole measurement

}  // namespace

StreamRequests::Stream& StreamRequests::Get(std::uint32_t id) {
  for (Stream& stream : streams_) {
    if (stream.id == id) return stream;
  }
  Stream stream;
  stream.id = id;
  return streams_.emplace_back(stream);
}

void StreamRequests::Want(std::uint32_t id, double rate_hz) {
  Stream& stream = Get(id);
  if (stream.rate_hz == rate_hz) return;
  stream.rate_hz = rate_hz;
  stream.requests = 0;
  stream.due = {};
}

void StreamRequests::WantIfThere(std::uint32_t id, double rate_hz) {
  Want(id, rate_hz);
  Get(id).is_optional = true;
}

void StreamRequests::Count(std::uint32_t id) {
  for (Stream& stream : streams_) {
    if (stream.id != id) continue;
    ++stream.count;
    stream.begins = stream.begins || !stream.has_come;
    stream.has_come = true;
    return;
  }
}

void StreamRequests::Measure(Time now, Stream* stream) {
  constexpr double kLeast_s = 1;
  constexpr double kMessages = 4;
  const double past_s = ToSeconds(now - stream->counted_from);
  if (past_s >= 0 && past_s < std::max(kLeast_s, kMessages / stream->rate_hz)) return;
  stream->measured_hz = stream->count / past_s;
  stream->count = 0;
  stream->counted_from = now;
}

// Neither the requests before the first message nor the second in which it came are evidence of the
// rate.
void StreamRequests::Begin(Time now, Stream* stream) {
  stream->begins = false;
  if (stream->requests == 0) return;
  stream->requests = 1;
  stream->count = 0;
  stream->counted_from = now;
  stream->due = now + kQuick;
}

bool StreamRequests::Next(Time now, Request* request) {
  constexpr double kEnough = 0.7;
  constexpr int kQuickRequests = 5;
  constexpr Duration kSlow = std::chrono::seconds(5);
  constexpr Duration kSeldom = std::chrono::minutes(1);
  for (Stream& stream : streams_) {
    if (stream.rate_hz <= 0) continue;
    if (stream.begins) Begin(now, &stream);
    Measure(now, &stream);
    if (now < stream.due) continue;
    if (stream.requests > 0 && stream.measured_hz >= kEnough * stream.rate_hz) continue;
    *request = {stream.id, stream.rate_hz, stream.requests,
                stream.requests > 1 && !stream.has_come};
    ++stream.requests;
    const Duration later = stream.is_optional && !stream.has_come ? kSeldom : kSlow;
    stream.due = now + (stream.requests < kQuickRequests ? kQuick : later);
    return true;
  }
  return false;
}

void StreamRequests::RequestAgain() {
  for (Stream& stream : streams_) {
    stream.requests = 0;
    stream.has_come = false;
    stream.due = {};
  }
}

double StreamRequests::RateOf(std::uint32_t id) const {
  const auto is_it = [&](const Stream& stream) { return stream.id == id; };
  const auto found = std::find_if(streams_.begin(), streams_.end(), is_it);
  return found == streams_.end() ? 0 : found->measured_hz;
}

}  // namespace kestrel
