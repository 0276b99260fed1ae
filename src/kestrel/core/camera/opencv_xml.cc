// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/core/camera/opencv_xml.h"

#include <exception>
#include <string>

#include <opencv2/core.hpp>
#include <yaml-cpp/yaml.h>

#include "kestrel/core/base/error.h"

namespace kestrel {
namespace {

YAML::Node Converted(const cv::FileNode& node) {
  if (node.isInt()) return YAML::Node(static_cast<int>(node));
  if (node.isReal()) return YAML::Node(static_cast<double>(node));
  if (node.isString()) return YAML::Node(static_cast<std::string>(node));
  YAML::Node converted;
  for (const cv::FileNode& child : node) {
    if (node.isMap()) {
      converted.force_insert(child.name(), Converted(child));
    } else {
      converted.push_back(Converted(child));
    }
  }
  return converted;
}

}  // namespace

bool IsXml(std::string_view text) {
  const std::size_t first = text.find_first_not_of(" \t\r\n\xEF\xBB\xBF");
  return first != std::string_view::npos && text[first] == '<';
}

YAML::Node LoadOpenCvXml(std::string_view text, const std::string& file) {
  try {
    const cv::FileStorage storage(std::string(text.substr(text.find('<'))),
                                  cv::FileStorage::READ | cv::FileStorage::MEMORY);
    return Converted(storage.root());
  } catch (const std::exception&) {  // cv::Exception, or what its parser does not catch
    throw InputError(file + ": the file is not OpenCV's XML (<opencv_storage>) or is truncated");
  }
}

}  // namespace kestrel
