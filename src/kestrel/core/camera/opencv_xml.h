// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <string_view>

namespace YAML {
class Node;
}

namespace kestrel {

// Returns whether a text is XML.
bool IsXml(std::string_view text);

// Returns the content of OpenCV's XML (cv::FileStorage) as the YAML that OpenCV would have written.
// Throws InputError with 'file' when it is other XML or is truncated.
YAML::Node LoadOpenCvXml(std::string_view text, const std::string& file);

}  // namespace kestrel
