// SPDX-License-Identifier: Apache-2.0
#include "tracer/scene/mesh_formats.h"

#include "tracer/base/error.h"
#include "tracer/base/file_names.h"

#include <algorithm>
#include <cstddef>
#include <functional>

namespace ds {

// The list in mesh.cmake: k_ply_format, k_off_format, ...
extern const MeshFormat DS_MESH_FORMATS;

namespace {

/// "a, b or c".
std::string joined(const std::vector<std::string_view>& words, std::string_view last_joint) {
  std::string text;
  for (std::size_t i = 0; i < words.size(); ++i) {
    if (i > 0) text += i + 1 == words.size() ? last_joint : ", ";
    text += words[i];
  }
  return text;
}

std::vector<std::string_view> split(std::string_view words) {
  std::vector<std::string_view> list;
  while (!words.empty()) {
    const std::size_t end = std::min(words.find(' '), words.size());
    list.push_back(words.substr(0, end));
    words.remove_prefix(std::min(end + 1, words.size()));
  }
  return list;
}

}  // namespace

std::span<const MeshFormat* const> mesh_formats() {
  static const std::vector<const MeshFormat*> formats = [] {
    std::vector<const MeshFormat*> list;
    for (const MeshFormat& format :
         std::initializer_list<std::reference_wrapper<const MeshFormat>>{DS_MESH_FORMATS})
      list.push_back(&format);
    return list;
  }();
  return formats;
}

std::string mesh_format_names() {
  std::vector<std::string_view> names;
  for (const MeshFormat* format : mesh_formats())
    names.push_back(format->name);
  return joined(names, " or ");
}

std::vector<std::string_view> mesh_endings() {
  std::vector<std::string_view> endings;
  for (const MeshFormat* format : mesh_formats())
    for (const std::string_view ending : split(format->endings))
      endings.push_back(ending);
  return endings;
}

std::string mesh_endings_text(std::string_view last_joint) {
  return joined(mesh_endings(), last_joint);
}

bool has_ending_of(const MeshFormat& format, const std::filesystem::path& file) {
  const std::vector<std::string_view> endings = split(format.endings);
  return std::any_of(endings.begin(), endings.end(),
                     [&](std::string_view ending) { return has_ending(file, ending); });
}

bool has_mesh_ending(const std::filesystem::path& file) {
  const std::vector<std::string_view> endings = mesh_endings();
  return std::any_of(endings.begin(), endings.end(),
                     [&](std::string_view ending) { return has_ending(file, ending); });
}

std::string mesh_format_reference() {
  std::string text = "| format | files | what is read beside faces |\n| --- | --- | --- |\n";
  for (const MeshFormat* format : mesh_formats()) {
    std::string endings;
    for (const std::string_view ending : split(format->endings))
      endings += fmt::format("{}`{}`", endings.empty() ? "" : ", ", ending);
    text += fmt::format("| {} | {} | {} |\n", format->name, endings, format->holds);
  }
  return text;
}

}  // namespace ds
