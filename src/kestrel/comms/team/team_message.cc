// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/comms/team/team_message.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <limits>

#include <Eigen/Cholesky>

#include "kestrel/core/base/bytes.h"

namespace kestrel {
namespace {

constexpr std::uint32_t kMagic = 0x0354'4b01;  // the last byte is the format's number
constexpr std::size_t kMaxNameSize = 32;
constexpr std::int64_t kMaxId = std::int64_t{1} << 48;
constexpr std::uint64_t kMaxAge_ns = 1'000'000'000'000'000;  // eleven days
constexpr double kMaxPosition_m = 1e8;
constexpr double kMaxNumber = 1e9;
constexpr int kMaxDetections = 1 << 30;
constexpr int kStanding = 3;  // number of values in the state of a standing object
enum Kind : std::uint8_t { kDigest, kPart };
enum Flag : std::uint8_t {
  kMayMove = 1,
  kHasDigits = 2,
  kMoves = 4,
  kDone = 1,
  kFlies = 2,
  kAtWork = 4
};

using Bytes = std::vector<std::uint8_t>;

void PutSingle(double value, Bytes* out) { Put(static_cast<float>(value), out); }

void Write(const UavKey& key, Bytes* out) {
  PutVarint(key.name.size(), out);
  out->insert(out->end(), key.name.begin(), key.name.end());
  Put(key.boot, out);
}

UavKey ReadKey(ByteReader* in) {
  UavKey key{std::string(in->Bytes(in->Varint(kMaxNameSize))), 0};
  in->Require(IsUavName(key.name));
  key.boot = in->Fixed<std::uint32_t>();
  return key;
}

std::int64_t ReadId(ByteReader* in) { return static_cast<std::int64_t>(in->Varint(kMaxId)); }

// Writes the time before 'now'; a later time cannot be written.
void WriteAge(Time time, Time now, Bytes* out) {
  PutVarint(static_cast<std::uint64_t>((now - time).count()), out);
}

Time ReadAge(Time now, ByteReader* in) {
  return now - Duration(static_cast<std::int64_t>(in->Varint(kMaxAge_ns)));
}

double ReadBounded(double value, double max, ByteReader* in) {
  in->Require(std::abs(value) <= max);
  return value;
}

double ReadSingle(ByteReader* in) { return ReadBounded(in->Fixed<float>(), kMaxNumber, in); }

template <class Array>
void ReadSingles(std::size_t count, Array* array, ByteReader* in) {
  for (std::size_t i = 0; i < count; ++i) (*array)[i] = ReadSingle(in);
}

void Write(const MappedObject& object, Time now, Bytes* out) {
  const auto& digits = object.digit_log_likelihoods;
  const bool has_digits =
      std::any_of(digits.begin(), digits.end(), [](double x) { return x != 0; });
  PutVarint(static_cast<std::uint64_t>(object.id), out);
  Put(static_cast<std::uint8_t>(object.shape), out);
  Put<std::uint8_t>((object.may_move ? kMayMove : 0) | (has_digits ? kHasDigits : 0) |
                        (object.moves ? kMoves : 0),
                    out);
  for (const Time time : {object.first_seen, object.last_seen, object.time}) {
    WriteAge(time, now, out);
  }
  PutVarint(static_cast<std::uint64_t>(object.detections), out);
  PutSingle(object.log_odds, out);
  PutSingle(object.color.hue_deg, out);
  PutSingle(object.color.saturation, out);
  PutSingle(object.color.value, out);
  const int size = object.may_move ? MappedObject::kStateSize : kStanding;
  if (object.may_move) PutSingle(object.move_log_odds, out);
  for (int i = 0; i < kStanding; ++i) Put(object.state[i], out);
  for (int i = kStanding; i < size; ++i) PutSingle(object.state[i], out);
  for (int i = 0; i < size; ++i) {
    for (int k = i; k < size; ++k) PutSingle(object.covariance(i, k), out);
  }
  const auto& colors = object.color_log_likelihoods;
  std::size_t count = colors.size();
  while (count > 0 && colors[count - 1] == 0) --count;
  Put(static_cast<std::uint8_t>(count), out);
  for (std::size_t i = 0; i < count; ++i) PutSingle(colors[i], out);
  if (!has_digits) return;
  for (const double digit : digits) PutSingle(digit, out);
}

void ReadState(ByteReader* in, MappedObject* object) {
  const int size = object->may_move ? MappedObject::kStateSize : kStanding;
  for (int i = 0; i < kStanding; ++i) {
    object->state[i] = ReadBounded(in->Fixed<double>(), kMaxPosition_m, in);
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
  const std::uint8_t shape = in->Fixed<std::uint8_t>();
  in->Require(shape <= static_cast<std::uint8_t>(ObjectShape::kBar));
  object.shape = static_cast<ObjectShape>(shape);
  const std::uint8_t flags = in->Fixed<std::uint8_t>();
  in->Require(flags <= (kMayMove | kHasDigits | kMoves));
  object.may_move = (flags & kMayMove) != 0;
  object.moves = (flags & kMoves) != 0;
  in->Require(object.may_move || !object.moves);
  object.first_seen = ReadAge(now, in);
  object.last_seen = ReadAge(now, in);
  object.time = ReadAge(now, in);
  in->Require(object.first_seen <= object.last_seen);
  object.detections = static_cast<int>(in->Varint(kMaxDetections));
  object.log_odds = ReadSingle(in);
  object.color.hue_deg = static_cast<float>(ReadSingle(in));
  object.color.saturation = static_cast<float>(ReadSingle(in));
  object.color.value = static_cast<float>(ReadSingle(in));
  if (object.may_move) object.move_log_odds = ReadSingle(in);
  ReadState(in, &object);
  const std::size_t colors = in->Fixed<std::uint8_t>();
  if (!in->Require(colors <= object.color_log_likelihoods.size())) return object;
  ReadSingles(colors, &object.color_log_likelihoods, in);
  if ((flags & kHasDigits) != 0) {
    ReadSingles(object.digit_log_likelihoods.size(), &object.digit_log_likelihoods, in);
  }
  return object;
}

void Write(const PartMessage& part, Bytes* out) {
  const Contents& contents = part.contents;
  Write(part.uav, out);
  PutVarint(static_cast<std::uint64_t>(
                std::clamp<std::int64_t>(part.age.count(), 0, std::int64_t{kMaxAge_ns})),
            out);
  PutVarint(contents.version, out);
  Put(static_cast<std::uint64_t>(ToNanoseconds(contents.now)), out);
  PutVarint(contents.objects.size(), out);
  std::int64_t last_id = 0;
  for (const auto& [id, version] : contents.objects) {
    PutVarint(static_cast<std::uint64_t>(id - last_id), out);
    PutVarint(contents.version - version, out);
    last_id = id;
  }
  PutVarint(part.objects.size(), out);
  for (const MappedObject& object : part.objects) Write(object, contents.now, out);
}

PartMessage ReadPart(ByteReader* in) {
  PartMessage part;
  part.uav = ReadKey(in);
  part.age = Duration(static_cast<std::int64_t>(in->Varint(kMaxAge_ns)));
  Contents& contents = part.contents;
  contents.version = in->Varint(kMaxVersion);
  const auto now = static_cast<std::int64_t>(in->Fixed<std::uint64_t>());
  constexpr std::int64_t kMaxNow = std::numeric_limits<std::int64_t>::max() / 2;
  in->Require(std::abs(now / 2) <= kMaxNow / 2);
  contents.now = in->has_failed() ? Time() : TimeFromNanoseconds(now);
  const std::size_t count = in->Varint(kMaxSentObjects);
  std::int64_t id = 0;
  for (std::size_t i = 0; i < count && !in->has_failed(); ++i) {
    id += ReadId(in);
    in->Require(id <= kMaxId);
    const std::uint64_t version = contents.version - in->Varint(contents.version);
    in->Require(contents.objects.emplace(id, version).second);
  }
  const std::size_t objects = in->Varint(contents.objects.size());
  for (std::size_t i = 0; i < objects && !in->has_failed(); ++i) {
    part.objects.push_back(ReadObject(contents.now, in));
    in->Require(contents.objects.contains(part.objects.back().id));
  }
  return part;
}

void WriteIds(const std::vector<std::int64_t>& ids, Bytes* out) {
  PutVarint(ids.size(), out);
  for (const std::int64_t id : ids) PutVarint(static_cast<std::uint64_t>(id), out);
}

std::vector<std::int64_t> ReadIds(std::size_t most, ByteReader* in) {
  std::vector<std::int64_t> ids;
  const std::size_t count = in->Varint(most);
  for (std::size_t i = 0; i < count && !in->has_failed(); ++i) ids.push_back(ReadId(in));
  return ids;
}

std::uint8_t FlagsOf(const DigestLine& line) {
  const bool is_at_work = line.flight && line.flight->is_at_work;
  return static_cast<std::uint8_t>((line.is_done ? kDone : 0) | (line.flight ? kFlies : 0) |
                                   (is_at_work ? kAtWork : 0));
}

void ReadFlags(ByteReader* in, DigestLine* line) {
  const std::uint8_t flags = in->Fixed<std::uint8_t>();
  in->Require(flags <= (kDone | kFlies | kAtWork));
  line->is_done = (flags & kDone) != 0;
  const bool is_at_work = (flags & kAtWork) != 0;
  if ((flags & kFlies) != 0) line->flight = UavFlight{.is_at_work = is_at_work};
  in->Require(line->flight || !is_at_work);
}

void Write(const UavFlight& flight, Bytes* out) {
  for (const double value : flight.position) Put(value, out);
  for (const double value : flight.velocity) {
    PutSingle(std::clamp(value, -kMaxSpeed_mps, kMaxSpeed_mps), out);
  }
}

void Read(ByteReader* in, UavFlight* flight) {
  for (double& value : flight->position) {
    value = ReadBounded(in->Fixed<double>(), kMaxPosition_m, in);
  }
  for (double& value : flight->velocity) {
    value = ReadBounded(in->Fixed<float>(), kMaxSpeed_mps, in);
  }
}

// A claim refers to the UAV by its line, because names are long.
void Write(const Digest& digest, Bytes* out) {
  PutVarint(digest.size(), out);
  for (const DigestLine& line : digest) {
    Write(line.uav, out);
    Put(line.beat, out);
    PutVarint(line.version, out);
    Put(static_cast<std::uint8_t>(line.tries), out);
    Put(FlagsOf(line), out);
    if (line.flight) Write(*line.flight, out);
    WriteIds(line.missing, out);
    WriteIds(line.gone, out);
    const auto claimed =
        !line.claim ? digest.end() : std::find_if(digest.begin(), digest.end(), [&](auto& other) {
          return other.uav == line.claim->object.uav;
        });
    const bool has_claim = claimed != digest.end();
    PutVarint(has_claim ? 1 + static_cast<std::uint64_t>(claimed - digest.begin()) : 0, out);
    if (!has_claim) continue;
    PutVarint(static_cast<std::uint64_t>(line.claim->object.id), out);
    PutSingle(line.claim->bid, out);
  }
}

Digest ReadDigest(ByteReader* in) {
  Digest digest(in->Varint(kMaxUavs));
  std::vector<std::size_t> claimed;
  for (DigestLine& line : digest) {
    line.uav = ReadKey(in);
    line.beat = in->Fixed<std::uint32_t>();
    line.version = in->Varint(kMaxVersion);
    line.tries = in->Fixed<std::uint8_t>();
    ReadFlags(in, &line);
    if (line.flight) Read(in, &*line.flight);
    line.missing = ReadIds(kMaxMissing, in);
    line.gone = ReadIds(kMaxSentObjects, in);
    claimed.push_back(in->Varint(digest.size()));
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
  Bytes out;
  Put(kMagic, &out);
  Write(message.sender, &out);
  Put<std::uint8_t>(std::holds_alternative<Digest>(message.body) ? kDigest : kPart, &out);
  std::visit([&](const auto& body) { Write(body, &out); }, message.body);
  return out;
}

std::optional<TeamMessage> ParseMessage(std::span<const std::uint8_t> bytes) {
  ByteReader in(bytes);
  in.Require(bytes.size() <= kMaxTeamMessage);
  in.Require(in.Fixed<std::uint32_t>() == kMagic);
  TeamMessage message;
  message.sender = ReadKey(&in);
  const std::uint8_t kind = in.Fixed<std::uint8_t>();
  in.Require(kind <= kPart);
  if (kind == kDigest) {
    message.body = ReadDigest(&in);
  } else {
    message.body = ReadPart(&in);
  }
  if (in.has_failed() || in.left() > 0) return std::nullopt;
  return message;
}

std::vector<std::uint8_t> EncodeObject(const MappedObject& object, Time now) {
  Bytes out;
  Write(object, now, &out);
  return out;
}

std::optional<MappedObject> AsReported(const MappedObject& object, Time now) {
  const std::vector<std::uint8_t> bytes = EncodeObject(object, now);
  ByteReader in(bytes);
  MappedObject reported = ReadObject(now, &in);
  if (in.has_failed()) return std::nullopt;
  return reported;
}

}  // namespace kestrel
