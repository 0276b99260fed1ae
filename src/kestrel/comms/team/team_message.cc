// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/comms/team/team_message.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <limits>

#include <Eigen/Cholesky>

#include "kestrel/comms/team/byte_stream.h"

namespace kestrel {
namespace {

constexpr std::uint32_t kMagic = 0x0254'4b01;  // the last byte is the format's number
constexpr std::size_t kMaxNameSize = 32;
constexpr std::int64_t kMaxId = std::int64_t{1} << 48;
constexpr std::uint64_t kMaxAge_ns = 1'000'000'000'000'000;  // eleven days
constexpr double kMaxPosition_m = 1e8;
constexpr double kMaxNumber = 1e9;
constexpr int kMaxDetections = 1 << 30;
constexpr int kStanding = 3;  // number of values in the state of a standing object
enum Kind : std::uint8_t { kDigest, kPart };
enum Flag : std::uint8_t { kMayMove = 1, kHasDigits = 2, kMoves = 4, kDone = 1 };

void Write(const UavKey& key, ByteWriter* out) {
  out->Text(key.name);
  out->Fixed(key.boot);
}

UavKey ReadKey(ByteReader* in) {
  UavKey key{in->Text(kMaxNameSize), 0};
  in->Require(IsUavName(key.name));
  key.boot = in->Fixed<std::uint32_t>();
  return key;
}

std::int64_t ReadId(ByteReader* in) { return static_cast<std::int64_t>(in->Whole(kMaxId)); }

// Writes the time before 'now'; a later time cannot be written.
void WriteAge(Time time, Time now, ByteWriter* out) {
  out->Whole(static_cast<std::uint64_t>((now - time).count()));
}

Time ReadAge(Time now, ByteReader* in) {
  return now - Duration(static_cast<std::int64_t>(in->Whole(kMaxAge_ns)));
}

double ReadBounded(double value, double max, ByteReader* in) {
  in->Require(std::abs(value) <= max);
  return value;
}

double ReadSingle(ByteReader* in) { return ReadBounded(in->Single(), kMaxNumber, in); }

template <class Array>
void ReadSingles(std::size_t count, Array* array, ByteReader* in) {
  for (std::size_t i = 0; i < count; ++i) (*array)[i] = ReadSingle(in);
}

void Write(const MappedObject& object, Time now, ByteWriter* out) {
  const auto& digits = object.digit_log_likelihoods;
  const bool has_digits =
      std::any_of(digits.begin(), digits.end(), [](double x) { return x != 0; });
  out->Whole(static_cast<std::uint64_t>(object.id));
  out->Byte(static_cast<std::uint8_t>(object.shape));
  out->Byte((object.may_move ? kMayMove : 0) | (has_digits ? kHasDigits : 0) |
            (object.moves ? kMoves : 0));
  for (const Time time : {object.first_seen, object.last_seen, object.time}) {
    WriteAge(time, now, out);
  }
  out->Whole(static_cast<std::uint64_t>(object.detections));
  out->Single(object.log_odds);
  out->Single(object.color.hue_deg);
  out->Single(object.color.saturation);
  out->Single(object.color.value);
  const int size = object.may_move ? MappedObject::kStateSize : kStanding;
  if (object.may_move) out->Single(object.move_log_odds);
  for (int i = 0; i < kStanding; ++i) out->Double(object.state[i]);
  for (int i = kStanding; i < size; ++i) out->Single(object.state[i]);
  for (int i = 0; i < size; ++i) {
    for (int k = i; k < size; ++k) out->Single(object.covariance(i, k));
  }
  const auto& colors = object.color_log_likelihoods;
  std::size_t count = colors.size();
  while (count > 0 && colors[count - 1] == 0) --count;
  out->Byte(static_cast<std::uint8_t>(count));
  for (std::size_t i = 0; i < count; ++i) out->Single(colors[i]);
  if (!has_digits) return;
  for (const double digit : digits) out->Single(digit);
}

void ReadState(ByteReader* in, MappedObject* object) {
  const int size = object->may_move ? MappedObject::kStateSize : kStanding;
  for (int i = 0; i < kStanding; ++i) {
    object->state[i] = ReadBounded(in->Double(), kMaxPosition_m, in);
  }
  for (int i = kStanding; i < size; ++i) object->state[i] = ReadSingle(in);
  for (int i = 0; i < size; ++i) {
    for (int k = i; k < size; ++k) {
      object->covariance(i, k) = object->covariance(k, i) = ReadSingle(in);
    }
  }
  const Eigen::Matrix3d position = object->covariance.topLeftCorner<3, 3>();
  in->Require(!in->has_failed() && position.llt().info() == Eigen::Success &&
              object->covariance.diagonal().minCoeff() >= 0);
}

MappedObject ReadObject(Time now, ByteReader* in) {
  MappedObject object;
  object.id = ReadId(in);
  const std::uint8_t shape = in->Byte();
  in->Require(shape <= static_cast<std::uint8_t>(ObjectShape::kBar));
  object.shape = static_cast<ObjectShape>(shape);
  const std::uint8_t flags = in->Byte();
  in->Require(flags <= (kMayMove | kHasDigits | kMoves));
  object.may_move = (flags & kMayMove) != 0;
  object.moves = (flags & kMoves) != 0;
  in->Require(object.may_move || !object.moves);
  object.first_seen = ReadAge(now, in);
  object.last_seen = ReadAge(now, in);
  object.time = ReadAge(now, in);
  in->Require(object.first_seen <= object.last_seen);
  object.detections = static_cast<int>(in->Whole(kMaxDetections));
  object.log_odds = ReadSingle(in);
  object.color.hue_deg = static_cast<float>(ReadSingle(in));
  object.color.saturation = static_cast<float>(ReadSingle(in));
  object.color.value = static_cast<float>(ReadSingle(in));
  if (object.may_move) object.move_log_odds = ReadSingle(in);
  ReadState(in, &object);
  const std::size_t colors = in->Byte();
  if (!in->Require(colors <= object.color_log_likelihoods.size())) return object;
  ReadSingles(colors, &object.color_log_likelihoods, in);
  if ((flags & kHasDigits) != 0) {
    ReadSingles(object.digit_log_likelihoods.size(), &object.digit_log_likelihoods, in);
  }
  return object;
}

void Write(const PartMessage& part, ByteWriter* out) {
  const Contents& contents = part.contents;
  Write(part.uav, out);
  out->Whole(static_cast<std::uint64_t>(
      std::clamp<std::int64_t>(part.age.count(), 0, std::int64_t{kMaxAge_ns})));
  out->Whole(contents.version);
  out->Fixed(static_cast<std::uint64_t>(ToNanoseconds(contents.now)));
  out->Whole(contents.objects.size());
  std::int64_t last_id = 0;
  for (const auto& [id, version] : contents.objects) {
    out->Whole(static_cast<std::uint64_t>(id - last_id));
    out->Whole(contents.version - version);
    last_id = id;
  }
  out->Whole(part.objects.size());
  for (const MappedObject& object : part.objects) Write(object, contents.now, out);
}

PartMessage ReadPart(ByteReader* in) {
  PartMessage part;
  part.uav = ReadKey(in);
  part.age = Duration(static_cast<std::int64_t>(in->Whole(kMaxAge_ns)));
  Contents& contents = part.contents;
  contents.version = in->Whole(kMaxVersion);
  const auto now = static_cast<std::int64_t>(in->Fixed<std::uint64_t>());
  constexpr std::int64_t kMaxNow = std::numeric_limits<std::int64_t>::max() / 2;
  in->Require(std::abs(now / 2) <= kMaxNow / 2);
  contents.now = in->has_failed() ? Time() : TimeFromNanoseconds(now);
  const std::size_t count = in->Whole(kMaxToldObjects);
  std::int64_t id = 0;
  for (std::size_t i = 0; i < count && !in->has_failed(); ++i) {
    id += ReadId(in);
    in->Require(id <= kMaxId);
    const std::uint64_t version = contents.version - in->Whole(contents.version);
    in->Require(contents.objects.emplace(id, version).second);
  }
  const std::size_t objects = in->Whole(contents.objects.size());
  for (std::size_t i = 0; i < objects && !in->has_failed(); ++i) {
    part.objects.push_back(ReadObject(contents.now, in));
    in->Require(contents.objects.contains(part.objects.back().id));
  }
  return part;
}

// A claim refers to the UAV by its line, because names are long.
void Write(const Digest& digest, ByteWriter* out) {
  out->Whole(digest.size());
  for (const DigestLine& line : digest) {
    Write(line.uav, out);
    out->Fixed(line.beat);
    out->Whole(line.version);
    out->Byte(static_cast<std::uint8_t>(line.tries));
    out->Byte(line.is_done ? kDone : 0);
    out->Whole(line.missing.size());
    for (const std::int64_t id : line.missing) out->Whole(static_cast<std::uint64_t>(id));
    const auto claimed =
        !line.claim ? digest.end() : std::find_if(digest.begin(), digest.end(), [&](auto& other) {
          return other.uav == line.claim->object.uav;
        });
    const bool has_claim = claimed != digest.end();
    out->Whole(has_claim ? 1 + static_cast<std::uint64_t>(claimed - digest.begin()) : 0);
    if (!has_claim) continue;
    out->Whole(static_cast<std::uint64_t>(line.claim->object.id));
    out->Single(line.claim->bid);
  }
}

Digest ReadDigest(ByteReader* in) {
  Digest digest(in->Whole(kMaxUavs));
  std::vector<std::size_t> claimed;
  for (DigestLine& line : digest) {
    line.uav = ReadKey(in);
    line.beat = in->Fixed<std::uint32_t>();
    line.version = in->Whole(kMaxVersion);
    line.tries = in->Byte();
    const std::uint8_t flags = in->Byte();
    in->Require(flags <= kDone);
    line.is_done = flags == kDone;
    const std::size_t missing = in->Whole(kMaxMissing);
    for (std::size_t i = 0; i < missing && !in->has_failed(); ++i) {
      line.missing.push_back(ReadId(in));
    }
    claimed.push_back(in->Whole(digest.size()));
    if (claimed.back() == 0) continue;
    const std::int64_t id = ReadId(in);
    line.claim = Claim{{{}, id}, ReadSingle(in)};
  }
  if (in->has_failed()) return {};
  for (std::size_t i = 0; i < digest.size(); ++i) {
    if (digest[i].claim) digest[i].claim->object.uav = digest[claimed[i] - 1].uav;
  }
  return digest;
}

}  // namespace

bool IsUavName(const std::string& name) {
  return !name.empty() && name.size() <= kMaxNameSize &&
         std::all_of(name.begin(), name.end(), [](unsigned char c) {
           return std::isalnum(c) != 0 || c == '_' || c == '-' || c == '.';
         });
}

std::vector<std::uint8_t> EncodeMessage(const TeamMessage& message) {
  ByteWriter out;
  out.Fixed(kMagic);
  Write(message.sender, &out);
  out.Byte(std::holds_alternative<Digest>(message.body) ? kDigest : kPart);
  std::visit([&](const auto& body) { Write(body, &out); }, message.body);
  return std::move(out.bytes());
}

std::optional<TeamMessage> ParseMessage(std::span<const std::uint8_t> bytes) {
  ByteReader in(bytes);
  in.Require(bytes.size() <= kMaxTeamMessage);
  in.Require(in.Fixed<std::uint32_t>() == kMagic);
  TeamMessage message;
  message.sender = ReadKey(&in);
  const std::uint8_t kind = in.Byte();
  in.Require(kind <= kPart);
  if (kind == kDigest) {
    message.body = ReadDigest(&in);
  } else {
    message.body = ReadPart(&in);
  }
  if (in.has_failed() || !in.is_at_end()) return std::nullopt;
  return message;
}

std::vector<std::uint8_t> EncodeObject(const MappedObject& object, Time now) {
  ByteWriter out;
  Write(object, now, &out);
  return std::move(out.bytes());
}

std::optional<MappedObject> AsTold(const MappedObject& object, Time now) {
  const std::vector<std::uint8_t> bytes = EncodeObject(object, now);
  ByteReader in(bytes);
  MappedObject told = ReadObject(now, &in);
  if (in.has_failed()) return std::nullopt;
  return told;
}

}  // namespace kestrel
