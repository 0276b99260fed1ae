// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/comms/mavlink/signing.h"

#include <algorithm>
#include <cctype>
#include <chrono>
#include <cstring>
#include <nettle/memops.h>
#include <nettle/sha2.h>
#include <sys/stat.h>

#include <fmt/format.h>

#include "kestrel/core/base/error.h"
#include "kestrel/core/base/read_file.h"

namespace kestrel::mavlink {
namespace {

constexpr std::size_t kTimestampSize = 6;
constexpr std::size_t kLinkSize = 1;
constexpr std::uint8_t kLink = 0;  // number of the link among the sender's links

int HexDigit(char digit) {
  if (digit >= '0' && digit <= '9') return digit - '0';
  const int letter = std::tolower(static_cast<unsigned char>(digit));
  constexpr int kTen = 10;
  return letter >= 'a' && letter <= 'f' ? letter - 'a' + kTen : -1;
}

bool ParseHexKey(std::string text, SigningKey* key) {
  while (!text.empty() && std::isspace(static_cast<unsigned char>(text.back())) != 0) {
    text.pop_back();
  }
  if (text.size() != 2 * key->size()) return false;
  for (std::size_t i = 0; i < key->size(); ++i) {
    const int high = HexDigit(text[2 * i]);
    const int low = HexDigit(text[2 * i + 1]);
    if (high < 0 || low < 0) return false;
    (*key)[i] = static_cast<std::uint8_t>(high << 4 | low);
  }
  return true;
}

void RequirePrivate(const std::string& path) {
  struct stat status {};
  constexpr unsigned kOthers = S_IRWXG | S_IRWXO;
  if (stat(path.c_str(), &status) == 0 && (status.st_mode & kOthers) != 0) {
    constexpr unsigned kMode = 0777;
    throw InputError(
        fmt::format("signing key {}: others may use the file (mode {:04o}), expected "
                    "mode 0600: chmod 600 {}",
                    path, status.st_mode & kMode, path));
  }
}

Signing::Timestamp ReadTimestamp(std::span<const std::uint8_t> bytes) {
  Signing::Timestamp timestamp = 0;
  std::memcpy(&timestamp, bytes.data(), kTimestampSize);
  return timestamp;
}

}  // namespace

SigningKey ReadSigningKey(const std::string& path) {
  const std::string text = ReadFile(path);
  RequirePrivate(path);
  SigningKey key{};
  if (text.size() == key.size()) {
    std::memcpy(key.data(), text.data(), key.size());
  } else if (!ParseHexKey(text, &key)) {
    throw InputError(
        fmt::format("signing key {}: has {} bytes, expected 32 bytes or 64 hexadecimal digits",
                    path, text.size()));
  }
  if (key == SigningKey{}) {
    throw InputError(
        fmt::format("signing key {}: is all zeros, which autopilots take for no key", path));
  }
  return key;
}

std::uint64_t UnixNanoseconds() {
  return static_cast<std::uint64_t>(std::chrono::duration_cast<std::chrono::nanoseconds>(
                                        std::chrono::system_clock::now().time_since_epoch())
                                        .count());
}

Signing::Timestamp Signing::TimestampOf(std::uint64_t unix_ns) {
  constexpr std::uint64_t kEpoch_ns = 1'420'070'400'000'000'000;
  constexpr std::uint64_t kTick_ns = 10'000;
  return unix_ns > kEpoch_ns ? (unix_ns - kEpoch_ns) / kTick_ns : 0;
}

Signing::Signing(const SigningKey& key, Timestamp stored) : key_(key), timestamp_(stored) {}

Signing::Signature Signing::SignatureOf(std::span<const std::uint8_t> signed_bytes) const {
  sha256_ctx context;
  sha256_init(&context);
  sha256_update(&context, key_.size(), key_.data());
  sha256_update(&context, signed_bytes.size(), signed_bytes.data());
  Signature signature;
  sha256_digest(&context, signature.size(), signature.data());
  return signature;
}

std::span<const std::uint8_t> Signing::Sign(std::span<const std::uint8_t> frame,
                                            std::span<std::uint8_t, kMaxFrame> memory,
                                            std::uint64_t unix_ns) {
  timestamp_ = std::max(timestamp_ + 1, TimestampOf(unix_ns));
  std::uint8_t* end = memory.data() + frame.size();
  *end++ = kLink;
  std::memcpy(end, &timestamp_, kTimestampSize);
  end += kTimestampSize;
  const Signature signature = SignatureOf({memory.data(), end});
  end = std::copy(signature.begin(), signature.end(), end);
  return {memory.data(), end};
}

Signing::Verdict Signing::Check(const Packet& packet, std::uint64_t unix_ns) {
  if (!packet.is_signed) return Verdict::kUnsigned;
  const auto frame = packet.frame();
  const auto received = frame.last<std::tuple_size_v<Signature>>();
  const Signature signature = SignatureOf(frame.first(frame.size() - received.size()));
  if (nettle_memeql_sec(signature.data(), received.data(), signature.size()) == 0) {
    return Verdict::kForged;
  }
  const auto stamp = frame.last<kSignatureSize>();
  const Timestamp timestamp = ReadTimestamp(stamp.subspan(kLinkSize));
  timestamp_ = std::max(timestamp_, TimestampOf(unix_ns));
  if (!IsLater(packet, stamp[0], timestamp)) return Verdict::kReplayed;
  timestamp_ = std::max(timestamp_, timestamp);
  return Verdict::kGood;
}

bool Signing::IsLater(const Packet& packet, std::uint8_t link, Timestamp timestamp) {
  for (Stream& stream : std::span(streams_).first(stream_count_)) {
    if (stream.system != packet.system || stream.component != packet.component ||
        stream.link != link) {
      continue;
    }
    if (timestamp <= stream.last) return false;
    stream.last = timestamp;
    return true;
  }
  constexpr Timestamp kMinute = 6'000'000;
  if (timestamp + kMinute < timestamp_ || stream_count_ == streams_.size()) return false;
  streams_[stream_count_++] = {packet.system, packet.component, link, timestamp};
  return true;
}

}  // namespace kestrel::mavlink
