// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/comms/team/team_message.h"

#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "kestrel/comms/team/message_signature.h"
#include "kestrel/comms/team/test_team.h"

namespace kestrel {
namespace {

using ::testing::ElementsAre;
using ::testing::Lt;
using ::testing::SizeIs;

const Time kNow = TimeFromNanoseconds(5'000'000'000);

TeamMessage PartOf(const std::vector<MappedObject>& objects) {
  PartMessage part{{"b", 2}, std::chrono::milliseconds(3), {7, kNow, {}}, objects};
  for (const MappedObject& object : objects) part.contents.objects[object.id] = 5;
  return {{"a", 1}, part};
}

TEST(TeamMessage, PartRoundTrips) {
  MappedObject moving = TestDisc(300, {5e6, -2, 0.5}, kNow);
  moving.may_move = moving.moves = true;
  moving.move_log_odds = 4.75;
  moving.state[3] = 1.5;
  moving.covariance += 0.25 * MappedObject::Covariance::Identity();
  moving.covariance(0, 4) = moving.covariance(4, 0) = 0.125;
  moving.first_seen -= std::chrono::seconds(4);
  moving = *AsReported(moving, kNow);
  MappedObject cuboid = TestDisc(2, {1, 2, 3}, kNow);
  cuboid.shape = ObjectShape::kCuboid;
  cuboid.digit_log_likelihoods[3] = -1;
  cuboid = *AsReported(cuboid, kNow);
  const auto message = ParseMessage(EncodeMessage(PartOf({moving, cuboid})));
  ASSERT_TRUE(message);
  const auto& part = std::get<PartMessage>(message->body);
  EXPECT_EQ(message->sender, (UavKey{"a", 1}));
  EXPECT_EQ(part.uav, (UavKey{"b", 2}));
  EXPECT_EQ(part.age, std::chrono::milliseconds(3));
  EXPECT_EQ(part.contents.version, 7);
  EXPECT_EQ(part.contents.now, kNow);
  EXPECT_THAT(part.contents.objects, ElementsAre(std::pair{2, 5}, std::pair{300, 5}));
  ASSERT_THAT(part.objects, SizeIs(2));
  EXPECT_EQ(EncodeObject(part.objects[0], kNow), EncodeObject(moving, kNow));
  EXPECT_EQ(part.objects[0].position().x(), 5e6);
  EXPECT_EQ(part.objects[0].covariance, moving.covariance);
  EXPECT_EQ(part.objects[0].first_seen, moving.first_seen);
  EXPECT_TRUE(part.objects[0].moves);
  EXPECT_EQ(part.objects[0].move_log_odds, 4.75);
  EXPECT_FALSE(part.objects[1].moves);
  EXPECT_EQ(part.objects[1].shape, ObjectShape::kCuboid);
  EXPECT_EQ(part.objects[1].digit_log_likelihoods, cuboid.digit_log_likelihoods);
}

TEST(TeamMessage, DigestRoundTrips) {
  const UavKey a{"a", 1};
  const UavKey b{"b", 2};
  Digest digest(2);
  digest[0].uav = a;
  digest[0].version = 8;
  digest[0].claim = Claim{{b, 5}, 0.5};
  digest[1].uav = b;
  digest[1].beat = 4'000'000'000;
  digest[1].missing = {3, 400};
  digest[1].tries = 7;
  digest[1].flight = UavFlight{{1, -2, 6}, {0.5, 0, -1}, true};
  digest[1].gone = {2, 5};
  digest[1].is_done = true;
  TeamMessage sent;
  sent.sender = a;
  sent.body = digest;
  const auto message = ParseMessage(EncodeMessage(sent));
  ASSERT_TRUE(message);
  const auto& lines = std::get<Digest>(message->body);
  ASSERT_THAT(lines, SizeIs(2));
  EXPECT_EQ(lines[0].claim->object, (ObjectRef{{"b", 2}, 5}));
  EXPECT_EQ(lines[0].claim->bid, 0.5);
  EXPECT_EQ(lines[1].beat, 4'000'000'000);
  EXPECT_THAT(lines[1].missing, ElementsAre(3, 400));
  EXPECT_EQ(lines[1].tries, 7);
  EXPECT_EQ(lines[0].flight, std::nullopt);
  EXPECT_EQ(lines[1].flight, digest[1].flight);
  EXPECT_EQ(lines[1].gone, digest[1].gone);
  EXPECT_TRUE(lines[1].is_done);
  EXPECT_FALSE(lines[0].is_done);
  EXPECT_FALSE(lines[1].claim);
}

TEST(TeamMessage, SpeedIsBounded) {
  Digest digest(1);
  digest[0].uav = {"a", 1};
  digest[0].flight = UavFlight{{0, 0, 6}, {60, -1e6, 1}, false};
  const auto message = ParseMessage(EncodeMessage({{"a", 1}, digest}));
  ASSERT_TRUE(message);
  EXPECT_EQ(std::get<Digest>(message->body)[0].flight->velocity, Eigen::Vector3d(50, -50, 1));
}

TEST(TeamMessage, StandingObjectTakesAtMost120Bytes) {
  EXPECT_THAT(EncodeObject(TestDisc(1000, {0, 0, 0}, kNow - std::chrono::seconds(30)), kNow),
              SizeIs(Lt(121)));
}

TEST(TeamMessage, DoesNotSendInvalidObjects) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  std::vector<MappedObject> objects(9, TestDisc(1, {0, 0, 0}, kNow));
  objects[0].state[1] = nan;
  objects[1].state[0] = 1e300;
  objects[2].covariance(0, 0) = -1;
  objects[3].covariance(1, 1) = nan;
  objects[4].time = kNow + Duration(1);  // in the future
  objects[5].last_seen = objects[5].first_seen - Duration(1);
  objects[6].log_odds = nan;
  objects[7].id = -1;
  objects[8].color_log_likelihoods[2] = -std::numeric_limits<double>::infinity();
  for (const MappedObject& object : objects) {
    EXPECT_FALSE(AsReported(object, kNow));
    EXPECT_FALSE(ParseMessage(EncodeMessage(PartOf({object}))));
  }
}

TEST(TeamMessage, DamagedMessagesAreRefusedOrWellFormed) {
  const std::vector<std::uint8_t> good =
      EncodeMessage(PartOf({TestDisc(1, {1, 2, 3}, kNow), TestDisc(2, {4, 5, 6}, kNow)}));
  for (std::size_t size = 0; size < good.size(); ++size) {
    EXPECT_FALSE(ParseMessage({good.data(), size}));
  }
  std::vector<std::uint8_t> longer = good;
  longer.push_back(0);
  EXPECT_FALSE(ParseMessage(longer));
  EXPECT_FALSE(ParseMessage(std::vector<std::uint8_t>(1'000'000)));
  Random random(1);
  for (int i = 0; i < 20'000; ++i) {
    std::vector<std::uint8_t> bytes = good;
    for (int k = random.Integer(1, 4); k > 0; --k) {
      bytes[random.Integer(0, static_cast<int>(bytes.size()) - 1)] =
          static_cast<std::uint8_t>(random.Integer(0, 255));
    }
    const auto message = ParseMessage(bytes);
    const auto* part = message ? std::get_if<PartMessage>(&message->body) : nullptr;
    if (part == nullptr) continue;
    for (const MappedObject& object : part->objects) {
      EXPECT_TRUE(object.state.allFinite() && object.covariance.allFinite());
      EXPECT_LE(object.time, part->contents.now);
    }
  }
}

TEST(TeamMessage, NamesAreShortWords) {
  for (const char* name : {"", "two words", "new\nline", "\xc3\xa4", "a/b"}) {
    EXPECT_FALSE(IsUavName(name)) << name;
    EXPECT_FALSE(ParseMessage(EncodeMessage({{name, 1}, Digest()})));
  }
  EXPECT_FALSE(IsUavName(std::string(33, 'a')));
  EXPECT_TRUE(IsUavName("uav-1_B.x"));
}

// RFC 4231, test case 1. Zeros fill its key up, which changes no HMAC.
TEST(MessageSignature, IsHmacSha256) {
  TeamKey key{};
  std::fill_n(key.begin(), 20, 0x0b);
  std::vector<std::uint8_t> bytes{'H', 'i', ' ', 'T', 'h', 'e', 'r', 'e'};
  SignMessage(key, &bytes);
  EXPECT_THAT(std::vector(bytes.begin() + 8, bytes.end()),
              ElementsAre(0xb0, 0x34, 0x4c, 0x61, 0xd8, 0xdb, 0x38, 0x53, 0x5c, 0xa8, 0xaf, 0xce,
                          0xaf, 0x0b, 0xf1, 0x2b));
  ASSERT_TRUE(CheckSignature(key, bytes));
  EXPECT_THAT(*CheckSignature(key, bytes), SizeIs(8));
  bytes[0] ^= 1;
  EXPECT_FALSE(CheckSignature(key, bytes));
  EXPECT_FALSE(CheckSignature(key, {}));
}

}  // namespace
}  // namespace kestrel
