// SPDX-License-Identifier: Apache-2.0
#include "tracer/base/error.h"
#include "tracer/base/files.h"
#include "tracer/base/text_lines.h"
#include "tracer/scene/mesh.h"
#include "tracer/scene/mesh_formats.h"
#include "tracer/scene/mesh_text.h"

#include <algorithm>

namespace ds {

Model parse_model(std::string_view bytes, const std::string& name, Winding winding) {
  if (is_utf16(bytes)) fail(ErrorKind::asset, "{}: {}", name, k_utf16_message);
  bytes = without_bom(bytes);
  for (const MeshFormat* format : mesh_formats())
    if (format->matches(bytes, name)) return mend(format->read(bytes, name), name, winding);
  if (bytes.empty())
    fail(ErrorKind::asset, "{}: wanted a mesh file ({}), found an empty one", name,
         mesh_format_names());
  fail(ErrorKind::asset, "{}: wanted a mesh file ({}), found one that begins \"{}\"", name,
       mesh_format_names(), printable(bytes.substr(0, 16)));
}

std::vector<std::filesystem::path> model_parts(const std::filesystem::path& file) {
  for (const MeshFormat* format : mesh_formats()) {
    if (format->parts == nullptr || !has_ending_of(*format, file)) continue;
    const std::string bytes = read_text_file(file);
    const std::string_view text = without_bom(bytes);
    if (format->matches(text, file.string())) return format->parts(text, file.string());
  }
  return {};
}

bool may_have_parts(const std::filesystem::path& file) {
  const auto formats = mesh_formats();
  return std::any_of(formats.begin(), formats.end(), [&](const MeshFormat* format) {
    return format->parts != nullptr && has_ending_of(*format, file);
  });
}

Model read_model(const std::filesystem::path& file, Winding winding) {
  return parse_model(read_text_file(file), file.string(), winding);
}

}  // namespace ds
