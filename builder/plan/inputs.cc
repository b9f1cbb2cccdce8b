// SPDX-License-Identifier: Apache-2.0
#include "builder/plan/inputs.h"

#include "builder/plan/keys.h"
#include "tracer/base/files.h"
#include "tracer/base/hash_stream.h"
#include "tracer/render/render.h"
#include "tracer/scene/sdl.h"

namespace ds {

namespace {

/// Stand in the database beside what was mended.
constexpr const char* k_has_uvs = "has_uvs";
constexpr const char* k_has_colors = "has_colors";

MendedDamage damage_and_facts(const MeshReport& report) {
  MendedDamage known = mended_damage(report);
  if (report.has_uvs) known.emplace_back(k_has_uvs, 1);
  if (report.has_colors) known.emplace_back(k_has_colors, 1);
  return known;
}

}  // namespace

template <typename T, typename Reader>
const T& Inputs::once(Known<T>& known, const std::filesystem::path& path, const Reader& reader) {
  Read<T>& entry = known[path.native()];
  if (!entry.value && !entry.error) {
    try {
      entry.value = reader(path);
    } catch (const DamagedDatabase&) {
      throw;  // no fault of the file
    } catch (const Error& error) {
      entry.error = error;
    }
  }
  if (entry.error) throw *entry.error;
  return *entry.value;
}

KnownModel Inputs::look_at_model(const std::filesystem::path& file) {
  // The stamp is taken before the bytes are read: a write in between gives a newer one, which is
  // then unknown.
  const std::optional<FileStamp> stamp = stamp_of(file);
  std::optional<Hash128> content;
  if (stamp && stamps_ == Stamps::trust) content = database_.find_content(file, *stamp);
  const bool new_content = !content;
  if (!content) content = content_hash(file);
  std::optional<KnownModel> known = database_.find_model(*content, k_host_render_version);
  const bool new_model = !known;
  if (!known) {
    const Model model = read_model(file);
    known = KnownModel{geometry_hash(model.mesh), damage_and_facts(model.report)};
  }
  if (new_content || new_model)
    new_models_.push_back(
        {file, stamp && !is_racy(*stamp) ? stamp : std::nullopt, *content, *known});
  return *known;
}

const Inputs::ModelFacts& Inputs::model(const std::filesystem::path& file) {
  return once(models_, file, [this](const auto& path) {
    const KnownModel known = look_at_model(path);
    ModelFacts facts;
    facts.geometry = known.geometry;
    for (const auto& [name, count] : known.damage) {
      if (name == k_has_uvs)
        facts.has.uvs = true;
      else if (name == k_has_colors)
        facts.has.colors = true;
      else
        facts.damage.emplace_back(name, count);
    }
    return facts;
  });
}

Mesh Inputs::model_mesh(const std::filesystem::path& file, const NormaliseOptions& options) {
  const Model model = read_model(file);
  if (geometry_hash(model.mesh) != model_geometry(file))
    fail(ErrorKind::asset, "{}: the model changed while the dataset was built", file.string());
  return normalise(model.mesh, options);
}

const Sphere& Inputs::model_sphere(const std::filesystem::path& file,
                                   const NormaliseOptions& options) {
  return once(spheres_, file, [&](const auto& path) {
    const Hash128 part = hash_text(canonical_model(model_geometry(path), options));
    if (const auto known = database_.find_sphere(part, k_host_render_version))
      return Sphere{{(*known)[0], (*known)[1], (*known)[2]}, (*known)[3]};
    return new_spheres_.emplace(part, bounding_sphere(model_mesh(path, options))).first->second;
  });
}

const Scene& Inputs::material(const std::filesystem::path& file) {
  return once(materials_, file, read_material);
}

const Scene& Inputs::environment(const std::filesystem::path& folder) {
  return once(environments_, folder, read_environment);
}

void Inputs::remember() {
  if (new_models_.empty() && new_spheres_.empty()) return;
  Transaction transaction(database_.connection());
  for (const NewModel& model : new_models_) {
    if (model.stamp) database_.put_content(model.file, *model.stamp, model.content);
    database_.put_model(model.content, k_host_render_version, model.known);
  }
  for (const auto& [part, sphere] : new_spheres_)
    database_.put_sphere(part, k_host_render_version,
                         {sphere.centre.x, sphere.centre.y, sphere.centre.z, sphere.radius_m});
  transaction.commit();
  new_models_.clear();
  new_spheres_.clear();
}

}  // namespace ds
