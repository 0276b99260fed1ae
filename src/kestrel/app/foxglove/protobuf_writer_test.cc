// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/app/foxglove/protobuf_writer.h"

#include <array>
#include <optional>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "kestrel/app/foxglove/protobuf_schema.h"
#include "kestrel/app/foxglove/test_protobuf.h"

namespace kestrel {
namespace {

using namespace std::string_literals;

enum class Kind { kNone, kSome };

struct Inner {
  static constexpr std::string_view kType = "test.Inner";
  int a = 0;

  static void Fields(auto& self, auto& visit) { visit(1, "a", self.a); }
};

struct Outer {
  static constexpr std::string_view kType = "test.Outer";
  Time time;
  Kind kind = Kind::kNone;
  std::string text;
  std::vector<Inner> list;
  std::optional<Inner> perhaps;
  std::array<double, 2> pair{};
  std::uint32_t fixed = 0;

  static void Fields(auto& self, auto& visit) {
    visit(1, "time", self.time);
    visit(2, "kind", self.kind);
    visit(3, "text", self.text);
    visit(4, "list", self.list);
    visit(5, "perhaps", self.perhaps);
    visit(6, "pair", self.pair);
    visit(16, "fixed", self.fixed);
  }
};

}  // namespace

template <>
struct ProtobufEnum<Kind> {
  static constexpr const char* kName = "Kind";
  static constexpr std::array kValues{"NONE", "SOME"};
};

namespace {

// Examples from protobuf.dev/programming-guides/encoding.
TEST(ProtobufWriterTest, WritesExamplesOfSpecification) {
  EXPECT_EQ(ProtobufBytesOf(Inner{150}), "\x08\x96\x01"s);
  Outer outer;
  outer.text = "testing";
  EXPECT_EQ(ProtobufFields(ProtobufBytesOf(outer)).bytes(3), "testing");
  EXPECT_EQ(ProtobufBytesOf(Inner{-1}), "\x08\xff\xff\xff\xff\xff\xff\xff\xff\xff\x01"s);
}

TEST(ProtobufWriterTest, WritesEveryKindOfField) {
  const Outer outer{.time = TimeFromNanoseconds(3'000'000'007),
                    .kind = Kind::kSome,
                    .text = {},
                    .list = {{1}, {2}},
                    .perhaps = std::nullopt,
                    .pair = {0.5, -2},
                    .fixed = 9};
  const ProtobufFields fields(ProtobufBytesOf(outer));
  EXPECT_EQ(fields.time(1), outer.time);
  EXPECT_EQ(fields.number<std::int64_t>(2), 1);
  EXPECT_EQ(fields.count(3), 0u);
  ASSERT_EQ(fields.count(4), 2u);
  EXPECT_EQ(fields.message(4, 1).number<std::int64_t>(1), 2);
  EXPECT_EQ(fields.count(5), 0u);
  EXPECT_THAT(fields.doubles(6), ::testing::ElementsAre(0.5, -2));
  EXPECT_EQ(fields.number<std::uint32_t>(16), 9u);
}

TEST(ProtobufWriterTest, NanosecondsAreNonNegativeBeforeEpoch) {
  const TimestampMessage before = TimestampOf(TimeFromNanoseconds(-1));
  EXPECT_EQ(before.seconds, -1);
  EXPECT_EQ(before.nanos, 999'999'999);
}

// The file of a message comes after the files of the messages that it needs; each file comes once.
TEST(ProtobufSchemaTest, DescribesMessageAndItsDependencies) {
  const ProtobufFields set(ProtobufSchemaOf<Outer>());
  ASSERT_EQ(set.count(1), 3u);
  EXPECT_EQ(set.message(1, 0).bytes(1), "google/protobuf/timestamp.proto");
  EXPECT_EQ(set.message(1, 1).bytes(1), "test/Inner.proto");
  const ProtobufFields file = set.message(1, 2);
  EXPECT_EQ(file.bytes(1), "test/Outer.proto");
  EXPECT_EQ(file.bytes(2), "test");
  EXPECT_EQ(file.count(3), 2u);
  EXPECT_EQ(file.bytes(12), "proto3");

  const ProtobufFields message = file.message(4);
  EXPECT_EQ(message.bytes(1), "Outer");
  ASSERT_EQ(message.count(2), 7u);
  const ProtobufFields list = message.message(2, 3);
  EXPECT_EQ(list.bytes(1), "list");
  EXPECT_EQ(list.number<std::int64_t>(3), 4);
  EXPECT_EQ(list.number<std::int64_t>(4), 3);   // repeated
  EXPECT_EQ(list.number<std::int64_t>(5), 11);  // a message
  EXPECT_EQ(list.bytes(6), ".test.Inner");
  EXPECT_EQ(message.message(2, 1).bytes(6), ".test.Outer.Kind");
  const ProtobufFields kind = message.message(4);
  EXPECT_EQ(kind.bytes(1), "Kind");
  ASSERT_EQ(kind.count(2), 2u);
  EXPECT_EQ(kind.message(2, 1).bytes(1), "SOME");
  EXPECT_EQ(kind.message(2, 1).number<std::int64_t>(2), 1);
}

}  // namespace
}  // namespace kestrel
