// SPDX-License-Identifier: Apache-2.0
#include "builder/build/inputs.h"

#include "tracer/base/files.h"
#include "tracer/base/hash.h"
#include "tracer/render/render.h"
#include "tracer/scene/sdl.h"

namespace ds {

template <typename T, typename Reader>
const T& Inputs::once(std::map<std::filesystem::path, Read<T>>& known,
                      const std::filesystem::path& path, const Reader& reader) {
  Read<T>& entry = known[path];
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

Hash128 Inputs::read_geometry(const std::filesystem::path& file) {
  // The stamp is taken before the bytes are read: a write in between gives a newer one, which is
  // then unknown.
  const std::optional<FileStamp> stamp = stamp_of(file);
  std::optional<Hash128> content;
  if (stamp) content = database_.find_content(file, *stamp);
  const bool new_content = !content;
  if (!content) content = hash_file(file).xxh128;
  std::optional<Hash128> geometry = database_.find_geometry(*content, k_host_render_version);
  const bool new_geometry = !geometry;
  if (!geometry) geometry = geometry_hash(read_model(file).mesh);
  if (new_content || new_geometry)
    new_hashes_.push_back(
        {file, stamp && !is_racy(*stamp) ? stamp : std::nullopt, *content, *geometry});
  return *geometry;
}

Hash128 Inputs::model_geometry(const std::filesystem::path& file) {
  return once(geometries_, file, [this](const auto& path) { return read_geometry(path); });
}

Mesh Inputs::model_mesh(const std::filesystem::path& file, const NormaliseOptions& options) {
  const Model model = read_model(file);
  if (geometry_hash(model.mesh) != model_geometry(file))
    fail(ErrorKind::asset, "{}: the model changed while the dataset was built", file.string());
  return normalise(model.mesh, options);
}

const Scene& Inputs::material(const std::filesystem::path& file) {
  return once(materials_, file, read_material);
}

const Scene& Inputs::environment(const std::filesystem::path& folder) {
  return once(environments_, folder, read_environment);
}

void Inputs::remember() {
  if (new_hashes_.empty()) return;
  Transaction transaction(database_.connection());
  for (const NewHash& hash : new_hashes_) {
    if (hash.stamp) database_.put_content(hash.file, *hash.stamp, hash.content);
    database_.put_geometry(hash.content, k_host_render_version, hash.geometry);
  }
  transaction.commit();
  new_hashes_.clear();
}

}  // namespace ds
