// SPDX-License-Identifier: Apache-2.0
#include "builder/plan/inputs.h"

#include "builder/plan/keys.h"
#include "tracer/base/canonical.h"
#include "tracer/base/disk_error.h"
#include "tracer/base/files.h"
#include "tracer/base/hash_stream.h"
#include "tracer/base/log.h"
#include "tracer/base/name_pattern.h"
#include "tracer/render/images.h"
#include "tracer/render/render.h"
#include "tracer/scene/mesh_shape.h"
#include "tracer/scene/sdl.h"
#include "tracer/scene/sdl_math.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <utility>

namespace ds {

namespace {

/// Stand in the database beside what was mended.
constexpr const char* k_has_uvs = "has_uvs";
constexpr const char* k_has_colors = "has_colors";

MendedDamage damage_and_facts(const MeshReport& report) {
  MendedDamage known = mended_damage(report);
  for (auto& unlikely : unlikely_properties(report))
    known.push_back(std::move(unlikely));
  if (report.has_uvs) known.emplace_back(k_has_uvs, 1);
  if (report.has_colors) known.emplace_back(k_has_colors, 1);
  return known;
}

void put_known(Database& database, const std::string& program,
               const std::map<std::string, std::string>& known) {
  if (known.empty()) return;
  try {
    Transaction transaction(database.connection());
    for (const auto& [question, answer] : known)
      database.put_known(program, question, answer);
    transaction.commit();
  } catch (const DiskFailed&) {  // it is found out again: no reason for a command to fail
  }
}

std::string question_of(const std::filesystem::path& environment) {
  return "environment " + environment.string();
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
  const Hash128 whole = content_with_parts(file, *content);
  std::optional<KnownModel> known = database_.find_model(whole, k_mesh_reader_version);
  const bool new_model = !known;
  if (!known) {
    const Model model = read_model(file);
    known = KnownModel{mesh_hashes(model.mesh), damage_and_facts(model.report),
                       extent_of(model.mesh), shape_of(model.mesh)};
  }
  if (new_content || new_model)
    new_models_.push_back(
        {file, stamp && !is_racy(*stamp) ? stamp : std::nullopt, *content, whole, *known});
  return *known;
}

std::vector<std::filesystem::path> Inputs::files_named(const char* kind,
                                                       const std::filesystem::path& file,
                                                       const Hash128& content, FilesOf* files_of) {
  const std::string question =
      fmt::format("{} {} {}", kind, content.hex(), file.parent_path().string());
  std::vector<std::filesystem::path> files;
  if (const auto known = find_known(question)) {
    for (std::string_view rest = *known; !rest.empty();) {
      const std::size_t end = std::min(rest.find('\n'), rest.size());
      if (end > 0) files.emplace_back(rest.substr(0, end));
      rest.remove_prefix(std::min(end + 1, rest.size()));
    }
  } else {
    files = files_of(file);
    std::string text;
    for (const std::filesystem::path& one : files)
      text += one.string() + "\n";
    keep_known(question, text.empty() ? "\n" : text);
  }
  return files;
}

Hash128 Inputs::content_with_parts(const std::filesystem::path& file, const Hash128& content) {
  if (!may_have_parts(file)) return content;
  const auto parts = files_named("parts", file, content, model_parts);
  if (parts.empty()) return content;
  CanonicalText whole;
  whole.add("file", content.hex());
  for (const std::filesystem::path& part : parts)
    whole.add("part", content_of_file(part).hex());
  return hash_text(whole.text());
}

const Inputs::ModelFacts& Inputs::model(const std::filesystem::path& file) {
  return once(models_, file, [this](const auto& path) {
    const KnownModel known = look_at_model(path);
    ModelFacts facts;
    facts.hashes = known.hashes;
    facts.extent = known.extent;
    facts.shape = known.shape;
    facts.has.normals = known.hashes.normals != Hash128{};
    for (const auto& [name, count] : known.damage) {
      const MeshReportColumn* const column = mesh_report_column(name);
      if (name == k_has_uvs)
        facts.has.uvs = true;
      else if (name == k_has_colors)
        facts.has.colors = true;
      else if (column != nullptr && column->unlikely != nullptr)
        facts.unlikely.emplace_back(name, count);
      else
        facts.damage.emplace_back(name, count);
    }
    return facts;
  });
}

std::shared_ptr<const FileMesh> ModelMeshes::file_mesh(const ModelSource& source) {
  constexpr std::size_t k_most_bytes = std::size_t{128} << 20U;
  const auto read = [&] {
    FileMesh mesh = read_model(source.file).mesh;
    if (mesh_hashes(mesh) != source.hashes)
      fail(ErrorKind::asset, "{}: the model changed while the dataset was built",
           source.file.string());
    return KeptMesh{std::move(mesh)};
  };
  if (!source.shared) return std::make_shared<const FileMesh>(read().mesh);
  if (!files_) files_.emplace(k_most_bytes);
  const std::shared_ptr<const KeptMesh> kept =
      files_->get(hash_text(source.file.native() + source.hashes.shape.hex()), read);
  return {kept, &kept->mesh};
}

Mesh ModelMeshes::get(const ModelSource& source) {
  constexpr std::size_t k_most_kept_triangles = 2'000'000;
  const Hash128 part =
      hash_text(canonical_model(source.hashes, {true, true, true}, source.options));
  const std::lock_guard lock(mutex_);
  if (last_ && last_->file == source.file && last_->part == part) return last_->mesh;
  last_.reset();
  Mesh mesh = normalise(*file_mesh(source), source.options);
  if (mesh.triangles.size() <= k_most_kept_triangles) last_ = Last{source.file, part, mesh};
  return mesh;
}

Sphere Inputs::model_sphere(const std::filesystem::path& file, const NormaliseOptions& options,
                            double lowest) {
  NormaliseOptions still = options;
  still.turn = NormaliseOptions{}.turn;
  still.place_m = {};
  const std::string text = canonical_model(model_hashes(file), {}, still);
  auto at = spheres_.find(text);
  if (at == spheres_.end()) {
    const Hash128 part = hash_text(text);
    const auto known = database_.find_sphere(part, k_host_render_version);
    const Sphere sphere =
        known ? Sphere{{(*known)[0], (*known)[1], (*known)[2]}, (*known)[3]}
              : new_spheres_.emplace(part, bounding_sphere(model_mesh(file, still))).first->second;
    at = spheres_.emplace(text, sphere).first;
  }
  if (still == options) return at->second;
  // Turned and moved with the model, however many images show it otherwise.
  const Mat4 before = model_to_world(model_extent(file), still),
             after = model_to_world(model_extent(file), options, lowest);
  return {after.point(portable::inverse(before).point(at->second.centre)), at->second.radius_m};
}

const FileMesh& Inputs::model_file_mesh(const std::filesystem::path& file) {
  if (!last_file_ || last_file_->file != file) {
    last_file_.reset();
    last_file_ = LastFile{file, read_model(file).mesh};
  }
  return last_file_->mesh;
}

double Inputs::model_lowest(const std::filesystem::path& file, const NormaliseOptions& options) {
  NormaliseOptions turned;
  turned.up = options.up;
  turned.turn = options.turn;
  const std::string question =
      "lowest " + hash_text(canonical_model(model_hashes(file), {}, turned)).hex();
  if (const auto known = find_known(question)) {
    double lowest = 0;
    const auto [end, error] = std::from_chars(known->data(), known->data() + known->size(), lowest);
    if (error == std::errc() && end == known->data() + known->size()) return lowest;
  }
  const double lowest = lowest_of(model_file_mesh(file), turned);
  keep_known(question, fmt::format("{}", lowest));
  return lowest;
}

/// A material's images and a model's parts are looked at by every command, and read only where they are not those of
/// the command before.
Hash128 Inputs::content_of_file(const std::filesystem::path& file) {
  return once(contents_, file, [this](const auto& path) {
    // Taken before the bytes are read, as for models.
    const std::optional<FileStamp> stamp = stamp_of(path);
    if (stamp && stamps_ == Stamps::trust)
      if (const auto known = database_.find_content(path, *stamp)) return *known;
    const Hash128 content = content_hash(path);
    if (stamp && !is_racy(*stamp)) new_contents_.push_back({path, *stamp, content});
    return content;
  });
}

/// Nothing of an image that cannot be read: its error is that of the images that need it.
std::optional<InputBounds> Inputs::image_bounds(const Image& image) {
  CanonicalText use;
  use.add("content", image.content.hex());
  use.add("gamma", image.gamma);
  if (image.srgb) use.add("srgb", true);
  use.add("gain", image.gain);
  use.add("wrap", static_cast<int>(image.wrap));
  use.add("channel", static_cast<int>(image.channel));
  const Hash128 key = hash_text(use.text());
  if (const auto known = database_.find_image_bounds(key, k_host_render_version)) {
    const auto& [r0, g0, b0, r1, g1, b1] = *known;
    return InputBounds{{r0, g0, b0}, {r1, g1, b1}};
  }
  try {
    Image pixels = image;
    load_image(pixels);
    return new_bounds_.insert_or_assign(key, bounds_of_pixels(pixels)).first->second;
  } catch (const Error&) {
    return std::nullopt;
  }
}

void Inputs::look_at_pixels(Scene& scene) {
  const auto bounds = [this](const Image& image) { return image_bounds(image); };
  for (const std::string& line : add_unphysical_of_pixels(scene, bounds))
    warn(line);
}

const OwnMaterials& Inputs::own_materials(const std::filesystem::path& model) {
  return once(own_materials_, model, [this](const auto& path) {
    const Hash128 content = content_of_file(path);
    const auto files = files_named("material files", path, content, own_material_files);
    CanonicalText question;
    question.add("own materials of", content_with_parts(path, content).hex());
    question.add("model", path.string());
    for (const std::filesystem::path& file : files) {
      std::error_code error;
      question.add("file", std::filesystem::is_regular_file(file, error)
                               ? content_of_file(file).hex()
                               : std::string());
    }
    if (const auto known = find_known(question.text())) return own_materials_from_text(*known);
    OwnMaterials own = read_own_materials(path);
    keep_known(question.text(), own_materials_text(own));
    return own;
  });
}

const Scene& Inputs::own_material(const std::filesystem::path& model) {
  return once(own_scenes_, model, [this](const auto& path) {
    return own_scene(own_materials(path), model_has(path).colors,
                     [this](const auto& image) { return content_of_file(image); });
  });
}

const Scene& Inputs::material(const std::filesystem::path& file) {
  return once(materials_, file, [this](const auto& path) {
    Scene scene = read_material(path, [this](const auto& image) { return content_of_file(image); });
    look_at_pixels(scene);
    return scene;
  });
}

const Scene& Inputs::environment(const std::filesystem::path& folder) {
  return once(environments_, folder, [this](const auto& path) {
    const std::int64_t began_ns = now_ns();
    const std::uint64_t warnings = warning_count();
    EnvironmentSource source;
    Scene scene = read_environment(path, &source,
                                   [this](const auto& image) { return content_of_file(image); });
    environment_nodes_[path.native()] = source.nodes;
    look_at_pixels(scene);
    // What there is to warn of is to be said by each command.
    if (warning_count() == warnings)
      if (const auto sources = settled(source.files, began_ns))
        keep_known(question_of(path), to_text(facts_of(scene, source.nodes), *sources));
    return scene;
  });
}

const EnvironmentFacts& Inputs::environment_facts(const std::filesystem::path& folder) {
  return once(environment_facts_, folder, [this](const auto& path) {
    if (const auto known = find_known(question_of(path)))
      if (auto facts = facts_from_text(*known)) return *std::move(facts);
    const Scene& scene = environment(path);
    return facts_of(scene, environment_nodes_.at(path.native()));
  });
}

const std::vector<NodeProperty>& Inputs::environment_properties(
    const std::filesystem::path& folder) {
  return once(environment_properties_, folder, [this](const auto& path) {
    return node_properties(environment_facts(path).nodes, path);
  });
}

const std::vector<const NodeProperty*>& Inputs::environment_fits(
    const std::filesystem::path& folder, const std::string& nodes, const std::string& property) {
  const auto& properties = environment_properties(folder);
  const auto [at, is_new] =
      environment_fits_.try_emplace(fmt::format("{}\n{}.{}", folder.native(), nodes, property));
  if (is_new)
    for (const NodeProperty& one : properties)
      if (one.name == property && fits_pattern(one.node, nodes)) at->second.push_back(&one);
  return at->second;
}

std::optional<std::string> Inputs::find_known(const std::string& question) {
  if (program_.empty() || stamps_ == Stamps::ignore) return std::nullopt;
  if (const auto at = new_known_.find(question); at != new_known_.end()) return at->second;
  return database_.find_known(program_, question);
}

void Inputs::keep_known(const std::string& question, std::string answer) {
  if (!program_.empty() && !answer.empty()) new_known_[question] = std::move(answer);
}

void Inputs::remember() {
  put_known(database_, program_, std::exchange(new_known_, {}));
  if (new_models_.empty() && new_spheres_.empty() && new_bounds_.empty() && new_contents_.empty())
    return;
  Transaction transaction(database_.connection());
  for (const NewModel& model : new_models_) {
    if (model.stamp) database_.put_content(model.file, *model.stamp, model.content);
    database_.put_model(model.whole, k_mesh_reader_version, model.known);
  }
  for (const NewContent& image : new_contents_)
    database_.put_content(image.file, image.stamp, image.content);
  for (const auto& [part, sphere] : new_spheres_)
    database_.put_sphere(part, k_host_render_version,
                         {sphere.centre.x, sphere.centre.y, sphere.centre.z, sphere.radius_m});
  for (const auto& [key, bounds] : new_bounds_)
    database_.put_image_bounds(
        key, k_host_render_version,
        {bounds.low.x, bounds.low.y, bounds.low.z, bounds.high.x, bounds.high.y, bounds.high.z});
  transaction.commit();
  new_bounds_.clear();
  new_contents_.clear();
  new_models_.clear();
  new_spheres_.clear();
}

}  // namespace ds
