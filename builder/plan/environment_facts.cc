// SPDX-License-Identifier: Apache-2.0
#include "builder/plan/environment_facts.h"

#include "tracer/base/canonical.h"
#include "tracer/base/error.h"
#include "tracer/kernels/layout.h"
#include "tracer/scene/scene_reads.h"
#include "tracer/scene/sdl.h"
#include "tracer/scene/sdl_warn.h"
#include "tracer/scene/type_tables.h"
#include "tracer/scene/vary.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>

namespace ds {
namespace {

using nlohmann::json;

std::string canonical_shape(const Scene& environment, unsigned reads) {
  const bool materials = (reads & kernels::k_plane_materials) != 0;
  CanonicalText text;
  for (std::size_t i = 0; i < environment.objects.size(); ++i) {
    const Object& object = environment.objects[i];
    MeshExtras extras;
    if (materials) extras = reads_of(environment, object.material);
    extras.uvs = extras.uvs || (reads & kernels::k_plane_uvs) != 0;
    extras.normals = (reads & kernels::k_plane_normals) != 0;
    text.add("object.geometry", geometry_hash(object.mesh, extras).hex());
    text.add("object.camera_invisible", object.camera_invisible);
    if ((reads & kernels::k_plane_objects) != 0) text.add(fmt::format("object{}.id", i), object.id);
    if ((reads & kernels::k_plane_material_ids) != 0)
      text.add(fmt::format("object{}.material.id", i),
               environment.materials[static_cast<std::size_t>(object.material)].id);
    if (materials)
      text.add(fmt::format("object{}.material", i),
               environment.materials[static_cast<std::size_t>(object.material)].name);
  }
  return text.text() + (materials ? canonical_colours(environment) : "");
}

std::map<unsigned, std::string> canonical_shapes(const Scene& environment) {
  std::map<unsigned, std::string> shapes;
  for (const PlaneType& plane : plane_types())
    if (const unsigned reads = plane_reads(plane); !shapes.contains(reads))
      shapes.emplace(reads, canonical_shape(environment, reads));
  return shapes;
}

double longest_side(const Scene& environment) {
  if (environment.objects.empty()) return 0;
  Box all = bounds_of(environment.objects.front().mesh);
  for (const Object& object : environment.objects) {
    const Box box = bounds_of(object.mesh);
    all = {{std::min(all.least.x, box.least.x), std::min(all.least.y, box.least.y),
            std::min(all.least.z, box.least.z)},
           {std::max(all.most.x, box.most.x), std::max(all.most.y, box.most.y),
            std::max(all.most.z, box.most.z)}};
  }
  const Vec3d side = all.most - all.least;
  return std::max({side.x, side.y, side.z});
}

/// Lights that are alike from everywhere alone have none.
bool has_sides(const Scene& environment) {
  return !environment.objects.empty() ||
         std::any_of(environment.lights.begin(), environment.lights.end(), [](const Light& light) {
           const LightType& type = type_of(light);
           return (type.host.made_by & kernels::k_host_panorama) != 0 ||
                  std::any_of(type.host.inputs.begin(), type.host.inputs.end(),
                              [](const LightInput& input) {
                                return input.value == LightValue::point ||
                                       input.value == LightValue::direction;
                              });
         });
}

json to_json(const std::optional<FileStamp>& stamp) {
  if (!stamp) return {};
  return {stamp->size_bytes, stamp->mtime_ns, stamp->ctime_ns, stamp->inode};
}

bool has_stamp(const json& file) {
  const std::optional<FileStamp> now = stamp_of(file.at(0).get<std::string>());
  return to_json(now) == file.at(1);
}

json to_json(const ToneMap& map) {
  const auto& [kind, scale, prescale, postscale, burn, gamma] = map;
  return {static_cast<int>(kind), scale, prescale, postscale, burn, gamma};
}

ToneMap tone_map_from(const json& value) {
  const auto number = [&](std::size_t i) { return value.at(i).get<float>(); };
  return {static_cast<ToneMap::Kind>(value.at(0).get<int>()),
          number(1),
          number(2),
          number(3),
          number(4),
          number(5)};
}

}  // namespace

std::uint32_t largest_material_id(const Scene& scene) {
  std::uint32_t largest = 0;
  for (const Material& material : scene.materials)
    largest = std::max(largest, material.id);
  return largest;
}

unsigned plane_reads(const PlaneType& plane) {
  return plane.traits &
         (kernels::k_plane_normals | kernels::k_plane_uvs | kernels::k_plane_objects |
          kernels::k_plane_material_ids | kernels::k_plane_materials);
}

std::string canonical_colours(const Scene& scene) {
  Scene dark;
  dark.textures = scene.textures;
  dark.images = scene.images;
  dark.materials = scene.materials;
  dark.own_materials = scene.own_materials;
  dark.own_faces = scene.own_faces;
  for (Material& material : dark.materials)
    material.emits = false;
  return canonical_material(dark);
}

EnvironmentFacts facts_of(const Scene& environment, const std::string& nodes) {
  std::uint32_t largest_object_id = 0;
  for (const Object& object : environment.objects)
    largest_object_id = std::max(largest_object_id, object.id);
  return {canonical_environment(environment),
          canonical_shapes(environment),
          environment.tone_map,
          longest_side(environment),
          std::any_of(environment.materials.begin(), environment.materials.end(),
                      [](const Material& material) { return !material.unphysical.empty(); }),
          environment.lost_faces,
          environment.unlikely,
          largest_object_id,
          largest_material_id(environment),
          gain_changes_program(environment),
          nodes,
          !gives_light(environment),
          has_sides(environment)};
}

std::string to_text(const EnvironmentFacts& facts, const std::vector<SourceFile>& files) {
  json sources = json::array();
  for (const SourceFile& file : files)
    sources.push_back({file.path.string(), to_json(file.stamp)});
  try {
    return json{{"files", std::move(sources)},
                {"text", facts.text},
                {"shapes", facts.shapes},
                {"tone_map", to_json(facts.tone_map)},
                {"longest_side_m", facts.longest_side_m},
                {"unphysical", facts.unphysical},
                {"lost_faces", facts.lost_faces},
                {"unlikely", facts.unlikely},
                {"largest_object_id", facts.largest_object_id},
                {"largest_material_id", facts.largest_material_id},
                {"gain_changes_program", facts.gain_changes_program},
                {"nodes", facts.nodes},
                {"dark", facts.dark},
                {"turns", facts.turns}}
        .dump();
  } catch (const json::exception&) {  // a name that is no UTF-8
    return "";
  }
}

std::optional<EnvironmentFacts> facts_from_text(const std::string& text) {
  try {
    const json object = json::parse(text);
    const json& files = object.at("files");
    if (!std::all_of(files.begin(), files.end(), has_stamp)) return std::nullopt;
    return EnvironmentFacts{object.at("text").get<std::string>(),
                            object.at("shapes").get<std::map<unsigned, std::string>>(),
                            tone_map_from(object.at("tone_map")),
                            object.at("longest_side_m").get<double>(),
                            object.at("unphysical").get<bool>(),
                            object.at("lost_faces").get<bool>(),
                            object.at("unlikely").get<bool>(),
                            object.at("largest_object_id").get<std::uint32_t>(),
                            object.at("largest_material_id").get<std::uint32_t>(),
                            object.at("gain_changes_program").get<bool>(),
                            object.at("nodes").get<std::string>(),
                            object.at("dark").get<bool>(),
                            object.at("turns").get<bool>()};
  } catch (const json::exception&) {
    return std::nullopt;
  } catch (const Error&) {  // a file that cannot be looked at: reading it says why
    return std::nullopt;
  }
}

std::optional<std::vector<SourceFile>> settled(const std::vector<std::filesystem::path>& files,
                                               std::int64_t began_ns) {
  std::vector<SourceFile> sources;
  for (const std::filesystem::path& file : files) {
    sources.push_back({file, stamp_of(file)});
    if (sources.back().stamp && is_racy(*sources.back().stamp, began_ns)) return std::nullopt;
  }
  return sources;
}

std::string running_program() {
  const std::optional<FileStamp> stamp = stamp_of("/proc/self/exe");
  return stamp ? to_json(stamp).dump() : std::string();
}

}  // namespace ds
