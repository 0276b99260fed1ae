// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/io/ros_messages/topic_choice.h"

#include <algorithm>
#include <string_view>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "kestrel/core/base/error.h"
#include "kestrel/io/ros_messages/messages.h"
#include "kestrel/io/ros_messages/pose_message.h"

namespace kestrel {
namespace {

constexpr std::string_view kCompressedSuffix = "/compressed";

enum class TopicUse { kImage, kCameraInfo, kPose, kTransforms, kNone };

TopicUse UseOf(const RosTopic& topic) {
  if (topic.wire_format == WireFormat::kOther) return TopicUse::kNone;
  if (topic.type == CompressedImageMessage::kType && topic.name.ends_with("/compressedDepth")) {
    return TopicUse::kNone;
  }
  if (topic.type == ImageMessage::kType || topic.type == CompressedImageMessage::kType) {
    return TopicUse::kImage;
  }
  if (topic.type == CameraInfoMessage::kType) return TopicUse::kCameraInfo;
  if (topic.type == TfMessage::kType || topic.type == "tf/tfMessage") return TopicUse::kTransforms;
  // Other poses in files for viewers are those of the camera and of what was found.
  if (topic.wire_format == WireFormat::kProtobuf && topic.name != "/pose") return TopicUse::kNone;
  return IsPoseType(topic.type) ? TopicUse::kPose : TopicUse::kNone;
}

// Chooses among the topics of a bag.
class TopicChooser {
 public:
  TopicChooser(const std::vector<RosTopic>& topics, const std::vector<std::string>& names,
               const std::string& bag)
      : topics_(topics), names_(names), bag_(bag) {
    for (const std::string& name : names_) CheckName(name);
  }

  // Returns the topics for this use; if some of them are named, only those.
  std::vector<std::size_t> Candidates(TopicUse use) const {
    std::vector<std::size_t> all = All(use);
    std::vector<std::size_t> named;
    std::copy_if(all.begin(), all.end(), std::back_inserter(named),
                 [this](std::size_t topic) { return IsNamed(topics_[topic].name); });
    return named.empty() ? all : named;
  }

  std::size_t Image() const {
    std::vector<std::size_t> images = Candidates(TopicUse::kImage);
    if (images.empty()) {
      throw InputError(fmt::format(
          "{}: has no images, expected a topic of sensor_msgs Image or CompressedImage among {}",
          bag_, Listed(AllIndices())));
    }
    if (images.size() > 1) std::erase_if(images, [&](std::size_t image) { return IsCopy(image); });
    if (images.size() > 1) FailAmbiguous("cameras", images);
    return images.front();
  }

  // Finds the topic beside the image: "/camera/camera_info" for "/camera/image_raw" (and for
  // "/compressed" below it).
  std::optional<std::size_t> CameraInfo(std::size_t image) const {
    const std::vector<std::size_t> infos = Candidates(TopicUse::kCameraInfo);
    std::string_view base = RawName(image);
    base = base.substr(0, base.rfind('/') == std::string_view::npos ? 0 : base.rfind('/'));
    for (const std::size_t info : infos) {
      if (topics_[info].name == std::string(base) + "/camera_info") return info;
    }
    if (infos.size() == 1) return infos.front();
    return std::nullopt;
  }

  std::optional<std::size_t> Pose() const {
    const std::vector<std::size_t> poses = Candidates(TopicUse::kPose);
    if (poses.empty()) return std::nullopt;
    if (poses.size() == 1) return poses.front();
    for (const std::string_view known : {"/local_position/pose", "/local_position/odom"}) {
      for (const std::size_t pose : poses) {
        if (topics_[pose].name.ends_with(known)) return pose;
      }
    }
    FailAmbiguous("topics with poses", poses);
  }

  std::vector<std::size_t> All(TopicUse use) const {
    std::vector<std::size_t> found;
    for (std::size_t i = 0; i < topics_.size(); ++i) {
      if (UseOf(topics_[i]) == use) found.push_back(i);
    }
    return found;
  }

 private:
  bool IsNamed(const std::string& topic) const {
    return std::find(names_.begin(), names_.end(), topic) != names_.end();
  }

  void CheckName(const std::string& name) const {
    const auto topic = std::find_if(topics_.begin(), topics_.end(), [&](const RosTopic& candidate) {
      return candidate.name == name;
    });
    if (topic == topics_.end()) {
      throw InputError(
          fmt::format("{}: has no topic {}, expected one of {}", bag_, name, Listed(AllIndices())));
    }
    if (UseOf(*topic) == TopicUse::kNone) {
      throw InputError(
          fmt::format("{}: the topic {} is of type {}, expected images, camera_info, poses or tf",
                      bag_, name, topic->type));
    }
  }

  std::string_view RawName(std::size_t image) const {
    std::string_view name = topics_[image].name;
    if (name.ends_with(kCompressedSuffix)) name.remove_suffix(kCompressedSuffix.size());
    return name;
  }
  // True when this is the compressed copy of images that also exist raw.
  bool IsCopy(std::size_t image) const {
    if (!std::string_view(topics_[image].name).ends_with(kCompressedSuffix)) return false;
    return std::any_of(topics_.begin(), topics_.end(), [&](const RosTopic& topic) {
      return topic.name == RawName(image) && UseOf(topic) == TopicUse::kImage;
    });
  }

  std::vector<std::size_t> AllIndices() const {
    std::vector<std::size_t> all(topics_.size());
    for (std::size_t i = 0; i < all.size(); ++i) all[i] = i;
    return all;
  }
  std::string Listed(const std::vector<std::size_t>& indices) const {
    constexpr std::size_t kMaxShown = 12;
    if (indices.empty()) return "its topics (there is none)";
    std::vector<std::string> shown;
    for (const std::size_t i : indices) {
      if (shown.size() == kMaxShown) {
        shown.push_back("...");
        break;
      }
      shown.push_back(fmt::format("{} ({})", topics_[i].name, topics_[i].type));
    }
    return fmt::format("{}", fmt::join(shown, ", "));
  }
  [[noreturn]] void FailAmbiguous(const char* what, const std::vector<std::size_t>& found) const {
    throw InputError(fmt::format("{}: has {} {}, choose one by --topic: {}", bag_, found.size(),
                                 what, Listed(found)));
  }

  const std::vector<RosTopic>& topics_;
  const std::vector<std::string>& names_;
  const std::string& bag_;
};

}  // namespace

TopicChoice ChooseTopics(const std::vector<RosTopic>& topics, const std::vector<std::string>& names,
                         const std::string& bag) {
  const TopicChooser chooser(topics, names, bag);
  TopicChoice chosen;
  chosen.image = chooser.Image();
  chosen.camera_info = chooser.CameraInfo(chosen.image);
  chosen.pose = chooser.Pose();
  chosen.transforms = chooser.All(TopicUse::kTransforms);
  return chosen;
}

bool IsRectified(const std::string& topic) {
  return topic.find("/image_rect") != std::string::npos;
}

}  // namespace kestrel
