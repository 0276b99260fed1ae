// SPDX-License-Identifier: BSD-3-Clause
#include "kestrel/core/camera/opencv_xml.h"

#include <sstream>
#include <string>
#include <tinyxml2.h>

#include <yaml-cpp/yaml.h>

#include "kestrel/core/base/error.h"

namespace kestrel {
namespace {

using tinyxml2::XMLElement;

// A word is a scalar, several words are a list; a text in quotes is one word.
YAML::Node ConvertedText(const char* text) {
  const std::string all = text == nullptr ? "" : text;
  if (all.size() > 1 && all.front() == '"' && all.back() == '"') {
    return YAML::Node(all.substr(1, all.size() - 2));
  }
  YAML::Node words(YAML::NodeType::Sequence);
  std::istringstream stream(all);
  for (std::string word; stream >> word;) words.push_back(word);
  return words.size() == 1 ? words[0] : words;
}

// The items of a list have the name "_".
YAML::Node Converted(const XMLElement& element) {
  if (element.FirstChildElement() == nullptr) return ConvertedText(element.GetText());
  YAML::Node converted;
  for (const XMLElement* child = element.FirstChildElement(); child != nullptr;
       child = child->NextSiblingElement()) {
    if (std::string(child->Name()) == "_") {
      converted.push_back(Converted(*child));
    } else {
      converted.force_insert(std::string(child->Name()), Converted(*child));
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
  tinyxml2::XMLDocument document(/*processEntities=*/true, tinyxml2::COLLAPSE_WHITESPACE);
  document.Parse(text.data(), text.size());
  const XMLElement* const root = document.FirstChildElement("opencv_storage");
  if (document.Error() || root == nullptr) {
    throw InputError(file + ": the file is not OpenCV's XML (<opencv_storage>) or is truncated");
  }
  return Converted(*root);
}

}  // namespace kestrel
