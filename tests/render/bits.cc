// SPDX-License-Identifier: Apache-2.0
#include "tests/render/bits.h"

#include "tracer/base/error.h"
#include "tracer/base/hash.h"
#include "tracer/device/plane_types.h"
#include "tracer/device/program_text.h"
#include "tracer/device/program_tokens.h"
#include "tracer/scene/sdl.h"

#include <algorithm>
#include <array>
#include <span>

namespace ds::pictures {
namespace {

std::string geometry_hash_of(const Geometry& geometry) {
  const std::string mask = hash_bytes(std::as_bytes(std::span(geometry.mask))).hex();
  const std::string depth = hash_bytes(std::as_bytes(std::span(geometry.depth))).hex();
  return hash_text(mask + depth).hex();
}

/// all_effects(), and the one that has them all by engine.error's schedule.
std::vector<Picture> pictures_of_bits() {
  std::vector<Picture> pictures = all_effects();
  Picture scheduled = pictures.back();
  scheduled.name = "scheduled";
  scheduled.engine.target = ErrorTarget{0.02, 48, scheduled.scene.tone_map};
  pictures.push_back(scheduled);
  return pictures;
}

std::vector<Picture> wanted_pictures(const BitsRequest& request) {
  std::vector<Picture> pictures;
  for (const Picture& picture : pictures_of_bits())
    if (request.names.empty() ||
        std::find(request.names.begin(), request.names.end(), picture.name) != request.names.end())
      pictures.push_back(picture);
  if (!request.names.empty() && pictures.size() != request.names.size())
    fail(ErrorKind::usage, "a picture was asked for that there is not, or twice");
  for (Picture& picture : pictures) {
    EngineSettings& engine = picture.engine;
    if (request.width > 0) engine.width = request.width;
    if (request.height > 0) engine.height = request.height;
    if (request.spp > 0) {
      engine.spp = request.spp;
      engine.target.reset();
    }
  }
  return pictures;
}

}  // namespace

std::map<std::string, std::string> bits_of(const BitsRequest& request) {
  std::map<std::string, std::string> table;
  table["host_version"] = std::to_string(k_host_render_version);
  table["geometry program"] = hash_text(program_tokens(planes_program_text(
                                            std::array{&plane_type("mask"), &plane_type("depth")})))
                                  .hex();
  Tracer tracer(request.tracer);
  for (const Picture& picture : wanted_pictures(request)) {
    const SceneEffects effects = scene_effects(picture.scene, picture.camera);
    table[picture.name + " program"] = hash_text(program_tokens(path_program_text(effects))).hex();
    table[picture.name + " scene"] = hash_text(canonical_environment(picture.scene)).hex();
    tracer.set_scene(picture.scene);
    table[picture.name + " film"] = film_hash(tracer.trace(picture.camera, picture.engine));
    table[picture.name + " geometry"] = geometry_hash_of(
        tracer.trace_geometry(picture.camera, picture.engine.width, picture.engine.height));
  }
  return table;
}

std::string to_text(const std::map<std::string, std::string>& table) {
  std::string text;
  for (const auto& [key, value] : table)
    text += key + " " + value + "\n";
  return text;
}

}  // namespace ds::pictures
