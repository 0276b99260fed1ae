// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/io/bags/mcap_file.h"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "kestrel/core/base/bytes.h"
#include "kestrel/core/base/error.h"
#include "kestrel/core/base/read_file.h"
#include "kestrel/core/base/test_folder.h"
#include "kestrel/io/bags/mcap_opcodes.h"
#include "kestrel/io/bags/mcap_reader.h"

namespace kestrel {
namespace {

using ::testing::Contains;
using ::testing::ElementsAreArray;
using ::testing::EndsWith;
using ::testing::IsEmpty;
using ::testing::StartsWith;

const McapChannel kChannel{.topic = "/numbers",
                           .message_encoding = "protobuf",
                           .schema_name = "test.Number",
                           .schema_encoding = "protobuf",
                           .schema = std::string("\0\1", 2)};

constexpr int kPerSecond = 4;

std::string TextOf(int message) { return fmt::format("message {}", message); }

// Writes a message each quarter of a second. Returns the size of the file after each.
std::vector<std::uint64_t> WriteNumbers(const std::string& path, int count, bool is_closed,
                                        Compression compression = Compression::kNone) {
  McapFile file(path, {.compression = compression, .name = UnfinishedName::kOwn});
  const std::size_t channel = file.AddChannel(kChannel);
  std::vector<std::uint64_t> sizes;
  for (int i = 0; i < count; ++i) {
    file.Write(channel, TimeFromNanoseconds(1'000'000'000LL * i / kPerSecond), TextOf(i));
    sizes.push_back(std::filesystem::file_size(path));
  }
  if (is_closed) file.Close();
  return sizes;
}

std::vector<std::string> ReadMessages(const std::string& path) {
  McapReader reader(path);
  std::vector<std::size_t> topics(reader.topics().size());
  for (std::size_t i = 0; i < topics.size(); ++i) topics[i] = i;
  reader.Select(topics);
  std::vector<std::string> messages;
  for (BagMessage message; reader.Next(&message);) messages.emplace_back(message.data);
  return messages;
}

std::vector<std::string> Numbers(int count) {
  std::vector<std::string> texts;
  for (int i = 0; i < count; ++i) texts.push_back(TextOf(i));
  return texts;
}

TEST(McapFileTest, MessagesRoundTrip) {
  const TestFolder folder;
  for (const Compression compression : {Compression::kNone, Compression::kZstd}) {
    const std::string path = folder / fmt::format("{}.mcap", static_cast<int>(compression));
    WriteNumbers(path, 30, /*is_closed=*/true, compression);
    EXPECT_THAT(ReadMessages(path), ElementsAreArray(Numbers(30)));
    const McapReader reader(path);
    ASSERT_EQ(reader.topics().size(), 1u);
    EXPECT_EQ(reader.topics()[0].name, "/numbers");
    EXPECT_EQ(reader.topics()[0].type, "test.Number");
    EXPECT_EQ(reader.topics()[0].messages, 30u);
    EXPECT_THAT(reader.remark(), IsEmpty());
  }
}

// During writing at most one second is missing from the file: as much as a crash would lose.
TEST(McapFileTest, ChunksLastAtMostOneSecond) {
  const TestFolder folder;
  const std::vector<std::uint64_t> sizes = WriteNumbers(folder / "a.mcap", 40, false);
  std::size_t last_growth = 0;
  for (std::size_t i = 1; i < sizes.size(); ++i) {
    if (sizes[i] > sizes[i - 1]) last_growth = i;
    EXPECT_LE(i - last_growth, static_cast<std::size_t>(kPerSecond)) << i;
  }
  EXPECT_GT(last_growth, 30u);
}

TEST(McapFileTest, ReadsFileTruncatedAtAnyByteUpToCut) {
  const TestFolder folder;
  for (const Compression compression : {Compression::kNone, Compression::kZstd}) {
    const std::string whole = folder / "whole.mcap";
    std::filesystem::remove(whole);
    const std::vector<std::uint64_t> sizes = WriteNumbers(whole, 14, true, compression);
    const std::string bytes = ReadFile(whole);
    for (std::size_t cut = sizes[5]; cut < bytes.size(); ++cut) {
      const std::string path = folder.Write("cut.mcap", bytes.substr(0, cut));
      const std::vector<std::string> messages = ReadMessages(path);
      // The last chunk of the file with this size was written when the next message did not fit
      // into it any more.
      const auto complete = std::upper_bound(sizes.begin(), sizes.end(), cut) - sizes.begin() - 1;
      const auto needed = complete / (kPerSecond + 1) * (kPerSecond + 1);
      ASSERT_GE(static_cast<std::ptrdiff_t>(messages.size()), needed) << cut;
      ASSERT_THAT(messages, ElementsAreArray(Numbers(static_cast<int>(messages.size())))) << cut;
    }
  }
}

// CRC-32 as in the PNG specification, bit by bit.
std::uint32_t Crc32(std::string_view bytes) {
  std::uint32_t crc = ~0u;
  for (const char byte : bytes) {
    crc ^= static_cast<std::uint8_t>(byte);
    for (int bit = 0; bit < 8; ++bit) crc = (crc >> 1) ^ ((crc & 1) != 0 ? 0xEDB88320u : 0u);
  }
  return ~crc;
}

TEST(McapFileTest, ChecksumsAreRight) {
  const TestFolder folder;
  const std::string path = folder / "a.mcap";
  WriteNumbers(path, 10, true);
  const std::string bytes = ReadFile(path);
  const std::string_view all = bytes;
  int chunks = 0;
  std::size_t data_end = 0;
  for (std::size_t at = kMcapMagic.size(); at + kMcapMagic.size() < bytes.size();) {
    ByteCursor cursor(all.substr(at), path);
    const auto opcode = cursor.Take<std::uint8_t>();
    const auto size = cursor.Take<std::uint64_t>();
    const std::size_t next = at + 9 + size;
    if (opcode == kMcapChunk) {
      cursor.Bytes(8 + 8 + 8);
      const auto checksum = cursor.Take<std::uint32_t>();
      cursor.Text();
      EXPECT_EQ(checksum, Crc32(cursor.Bytes(cursor.Take<std::uint64_t>())));
      ++chunks;
    } else if (opcode == kMcapDataEnd) {
      EXPECT_EQ(cursor.Take<std::uint32_t>(), Crc32(all.substr(0, at)));
      data_end = next;
    } else if (opcode == kMcapFooter) {
      EXPECT_EQ(cursor.Take<std::uint64_t>(), data_end);
      cursor.Bytes(8);
      EXPECT_EQ(cursor.Take<std::uint32_t>(),
                Crc32(all.substr(data_end, next - sizeof(std::uint32_t) - data_end)));
    }
    at = next;
  }
  EXPECT_EQ(chunks, 2);
  EXPECT_GT(data_end, 0u);
}

// Finds and changes bytes in the file, as a bad disk would.
std::string Changed(std::string bytes, std::string_view from, std::string_view to) {
  const std::size_t at = bytes.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return bytes.replace(at, from.size(), to);
}

// Returns the places of the checksums of all chunks.
std::vector<std::size_t> ChunkChecksums(std::string_view bytes) {
  std::vector<std::size_t> places;
  const std::string name = "file";
  for (std::size_t at = kMcapMagic.size(); at + kMcapMagic.size() < bytes.size();) {
    ByteCursor cursor(bytes.substr(at), name);
    if (cursor.Take<std::uint8_t>() == kMcapChunk) places.push_back(at + 9 + 8 + 8 + 8);
    at += 9 + cursor.Take<std::uint64_t>();
  }
  return places;
}

std::string WithoutChecksums(std::string bytes) {
  for (const std::size_t place : ChunkChecksums(bytes)) bytes.replace(place, 4, 4, '\0');
  return bytes;
}

// Replaces the footer by one that declares no summary.
std::string WithoutSummary(std::string bytes) {
  constexpr std::size_t kFooterAndMagic = 20 + 8;
  return bytes.replace(bytes.size() - kFooterAndMagic, 8, 8, '\0');
}

// The second chunk has the messages 5 to 9.
TEST(McapFileTest, SkipsChunkWithWrongChecksum) {
  const TestFolder folder;
  WriteNumbers(folder / "whole.mcap", 14, true);
  std::vector<std::string> others;
  for (const int i : {0, 1, 2, 3, 4, 10, 11, 12, 13}) others.push_back(TextOf(i));
  const std::string damaged = Changed(ReadFile(folder / "whole.mcap"), "message 7", "massage 7");
  for (const std::string& bytes : {damaged, WithoutSummary(damaged)}) {
    const std::string path = folder.Write("damaged.mcap", bytes);
    EXPECT_THAT(ReadMessages(path), ElementsAreArray(others));
    McapReader reader(path);
    reader.Select({0});
    EXPECT_THAT(reader.remark() + reader.damage(), IsEmpty());
    for (BagMessage message; reader.Next(&message);) continue;
    EXPECT_THAT(reader.damage(), StartsWith(path + ": byte "));
    EXPECT_THAT(reader.damage(), EndsWith("its checksum is wrong; left out: 1 of 3 chunks"));
  }
  const std::string unchecked = folder.Write("unchecked.mcap", WithoutChecksums(damaged));
  EXPECT_THAT(ReadMessages(unchecked), Contains("massage 7"));
}

TEST(McapFileTest, IgnoresSummaryWithWrongChecksum) {
  const TestFolder folder;
  WriteNumbers(folder / "whole.mcap", 14, true);
  std::string bytes = ReadFile(folder / "whole.mcap");
  const std::size_t summary = bytes.rfind("/numbers");
  bytes.replace(summary, 8, "/letters");
  const std::string path = folder.Write("damaged.mcap", bytes);
  const McapReader reader(path);
  ASSERT_EQ(reader.topics().size(), 1u);
  EXPECT_EQ(reader.topics()[0].name, "/numbers");
  EXPECT_THAT(reader.remark(), IsEmpty());
  EXPECT_THAT(ReadMessages(path), ElementsAreArray(Numbers(14)));
}

// This protects chunks without a checksum of their own.
TEST(McapFileTest, ChecksDataChecksumOnSequentialRead) {
  const TestFolder folder;
  WriteNumbers(folder / "whole.mcap", 14, true);
  const std::string unchecked = WithoutSummary(WithoutChecksums(ReadFile(folder / "whole.mcap")));
  const std::string path = folder.Write("damaged.mcap", unchecked);
  EXPECT_THAT(McapReader(path).remark(), EndsWith("the checksum of all is wrong"));
  EXPECT_THAT(ReadMessages(path), ElementsAreArray(Numbers(14)));
}

TEST(McapFileTest, KeepsExistingFile) {
  const TestFolder folder;
  const std::string path = folder.Write("a.mcap", "mine");
  EXPECT_THROW(McapFile(path, {.name = UnfinishedName::kOwn}), InputError);
  EXPECT_EQ(ReadFile(path), "mine");
  { const McapFile discarded(path, {.replace = true}); }
  EXPECT_EQ(ReadFile(path), "mine");
}

}  // namespace
}  // namespace kestrel
