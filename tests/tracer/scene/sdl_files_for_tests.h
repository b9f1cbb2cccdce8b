// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tracer/base/error.h"
#include "tracer/base/files.h"
#include "tracer/scene/sdl.h"

#include <filesystem>
#include <string>
#include <string_view>

namespace ds::testing {

/// A folder in which a test writes SDL files and reads them.
class SdlFolder {
 public:
  const std::filesystem::path& path() const { return folder_.path(); }
  void write(const std::string& name, std::string_view text) const {
    write_file_atomic(path() / name, text);
  }
  Scene material(std::string_view text) const {
    write("m.scn", text);
    return read_material(path() / "m.scn");
  }
  Scene environment(std::string_view text) const {
    write("environment.scn", text);
    return read_environment(path());
  }
  /// The message with the folder's path taken out; empty where nothing was thrown.
  std::string material_error(std::string_view text) const {
    return error_of([&] { material(text); });
  }
  std::string environment_error(std::string_view text) const {
    return error_of([&] { environment(text); });
  }

 private:
  template <typename Action>
  std::string error_of(Action action) const {
    try {
      action();
    } catch (const Error& error) {
      if (error.kind() != ErrorKind::asset) return "wrong kind of error";
      std::string message = error.what();
      const std::string prefix = path().string() + "/";
      for (std::size_t at; (at = message.find(prefix)) != std::string::npos;)
        message.erase(at, prefix.size());
      return message;
    }
    return "";
  }

  TemporaryFolder folder_;
};

/// A square of side 2 round the origin, facing +z.
inline constexpr std::string_view k_square =
    "scene.objects.square.vertices = -1 -1 0  1 -1 0  1 1 0  -1 1 0\n"
    "scene.objects.square.faces = 0 1 2 0 2 3\n"
    "scene.objects.square.material = body\n";
inline constexpr std::string_view k_matte_body = "scene.materials.body.type = matte\n";

}  // namespace ds::testing
