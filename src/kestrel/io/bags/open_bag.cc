// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/io/bags/open_bag.h"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "kestrel/core/base/error.h"
#include "kestrel/io/bags/bag_folder.h"
#include "kestrel/io/bags/mcap_reader.h"
#include "kestrel/io/bags/ros1_bag.h"
#include "kestrel/io/bags/sqlite_bag.h"
#include "kestrel/io/recording/euroc/euroc_recording.h"

namespace kestrel {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kAnyRos1Bag = "#ROSBAG V";

std::string BeginOf(const std::string& path) {
  std::string bytes(16, '\0');
  std::ifstream file(path, std::ios::binary);
  file.read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  bytes.resize(static_cast<std::size_t>(std::max<std::streamsize>(file.gcount(), 0)));
  return bytes;
}

enum class BagKind { kNone, kRos1, kMcap, kSqlite, kCompressed };

// Returns the kind by the content, or by the name when a cut has left too little content.
BagKind BagKindOf(const std::string& path) {
  std::error_code ignored;
  if (!fs::is_regular_file(path, ignored)) return BagKind::kNone;
  const std::string begin = BeginOf(path);
  if (begin.starts_with(kAnyRos1Bag)) return BagKind::kRos1;
  if (begin.starts_with(kMcapMagic)) return BagKind::kMcap;
  if (begin == kSqliteMagic) return BagKind::kSqlite;
  if (IsCompressedBagFile(path)) return BagKind::kCompressed;
  const std::string extension = fs::path(path).extension().string();
  if (extension == ".bag") return BagKind::kRos1;
  if (extension == ".mcap") return BagKind::kMcap;
  return extension == ".db3" ? BagKind::kSqlite : BagKind::kNone;
}

std::unique_ptr<BagReader> OpenBagFile(const std::string& path, bool has_compressed_messages) {
  switch (BagKindOf(path)) {
    case BagKind::kRos1:
      return std::make_unique<Ros1Bag>(path);
    case BagKind::kMcap:
      if (has_compressed_messages) {
        throw InputError(path + ": its messages are compressed one by one, expected chunks");
      }
      return std::make_unique<McapReader>(path);
    case BagKind::kSqlite:
      return std::make_unique<SqliteBag>(path, has_compressed_messages);
    case BagKind::kCompressed:
      throw InputError(fmt::format(
          "{0}: is compressed as a whole, expected it decompressed (zstd -d -o {1} {0})", path,
          fs::path(path).stem().string()));
    case BagKind::kNone:
      break;
  }
  throw InputError(path + ": is no bag, expected a ROS 1 bag, an MCAP file or rosbag2's .db3");
}

// Reads the parts of a bag one after the other; only one file is open at a time.
class SplitBag : public BagReader {
 public:
  explicit SplitBag(BagFolder folder) : folder_(std::move(folder)) {
    for (const std::string& file : folder_.files) {
      const auto part = OpenBagFile(file, folder_.has_compressed_messages);
      for (const RosTopic& topic : part->topics()) Add(topic);
      if (!part->remark().empty()) remark_ = part->remark();
    }
  }

  const std::vector<RosTopic>& topics() const override { return topics_; }
  std::string remark() const override { return remark_; }
  std::string damage() const override { return damage_; }

  void Select(const std::vector<std::size_t>& topics) override {
    selected_ = topics;
    next_part_ = 0;
    part_.reset();
    is_selected_ = true;
  }

  bool Next(BagMessage* message) override {
    while (is_selected_) {
      if (part_ && part_->Next(message)) {
        message->topic = IndexOf(part_->topics()[message->topic]);
        return true;
      }
      if (part_ && damage_.empty()) damage_ = part_->damage();
      part_.reset();
      if (next_part_ == folder_.files.size()) return false;
      OpenPart(folder_.files[next_part_++]);
    }
    return false;
  }

 private:
  static bool IsSame(const RosTopic& a, const RosTopic& b) {
    return a.name == b.name && a.type == b.type && a.wire_format == b.wire_format;
  }
  std::size_t IndexOf(const RosTopic& topic) const {
    const auto known = std::find_if(topics_.begin(), topics_.end(),
                                    [&](const RosTopic& other) { return IsSame(topic, other); });
    return static_cast<std::size_t>(known - topics_.begin());
  }
  void Add(const RosTopic& topic) {
    const std::size_t index = IndexOf(topic);
    if (index == topics_.size()) {
      topics_.push_back(topic);
      return;
    }
    auto& messages = topics_[index].messages;
    messages =
        messages && topic.messages ? std::optional(*messages + *topic.messages) : std::nullopt;
  }
  void OpenPart(const std::string& file) {
    part_ = OpenBagFile(file, folder_.has_compressed_messages);
    std::vector<std::size_t> wanted;
    for (std::size_t i = 0; i < part_->topics().size(); ++i) {
      const std::size_t index = IndexOf(part_->topics()[i]);
      if (std::find(selected_.begin(), selected_.end(), index) != selected_.end()) {
        wanted.push_back(i);
      }
    }
    part_->Select(wanted);
  }

  BagFolder folder_;
  std::vector<RosTopic> topics_;
  std::string remark_;
  std::string damage_;  // the first damage that was met
  std::vector<std::size_t> selected_;
  bool is_selected_ = false;
  std::size_t next_part_ = 0;
  std::unique_ptr<BagReader> part_;
};

}  // namespace

bool IsBag(const std::string& path) {
  return BagKindOf(path) != BagKind::kNone || (!FindEurocRoot(path) && IsBagFolder(path));
}

std::unique_ptr<BagReader> OpenBag(const std::string& path) {
  if (!IsBagFolder(path)) return OpenBagFile(path, /*has_compressed_messages=*/false);
  BagFolder folder = ReadBagFolder(path);
  if (folder.files.size() == 1) {
    return OpenBagFile(folder.files.front(), folder.has_compressed_messages);
  }
  return std::make_unique<SplitBag>(std::move(folder));
}

}  // namespace kestrel
