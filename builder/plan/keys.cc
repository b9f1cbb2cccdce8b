// SPDX-License-Identifier: Apache-2.0
#include "builder/plan/keys.h"

#include "builder/plan/alike.h"
#include "builder/plan/distractors.h"
#include "builder/plan/environment_vary.h"
#include "builder/plan/image_material.h"
#include "builder/plan/image_scene.h"
#include "builder/plan/output_kinds.h"
#include "builder/plan/plane_keys.h"
#include "builder/plan/text_form.h"
#include "tracer/base/canonical.h"
#include "tracer/base/hex_text.h"
#include "tracer/device/plane_types.h"
#include "tracer/device/program_text.h"
#include "tracer/device/program_tokens.h"
#include "tracer/device/scene_effects.h"
#include "tracer/kernels/layout.h"
#include "tracer/render/engine_text.h"
#include "tracer/scene/scene_reads.h"
#include "tracer/scene/sdl.h"
#include "tracer/scene/told_lights.h"
#include "tracer/scene/type_tables.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <deque>
#include <map>
#include <optional>
#include <set>
#include <span>
#include <tuple>
#include <unordered_map>
#include <utility>

namespace ds {
namespace {

std::string_view view_of_digits(const fmt::format_int& number) {
  return {number.data(), number.size()};
}

/// The five parts of the render key behind what `head` holds.
TextForm form_of_parts(CanonicalText head) {
  for (std::size_t i = 0; i < 5; ++i)
    head.add(k_part_names[i], "");
  return {head.text(), std::span(k_part_names).first<5>()};
}

/// What images from one camera in one environment share.
struct View {
  Shared<std::string> name;  ///< keeps the address that is this entry's name
  Camera camera;
  EnvironmentChange change;
  int width = 0, height = 0;
  std::string text;              ///< canonical, of camera and change
  std::optional<Hash128> part;   ///< of that text alone
  std::vector<TextForm> planes;  ///< of each wanted: its text, plane_form
};

/// What images in one environment share.
struct Environment {
  Shared<std::filesystem::path> folder;  ///< keeps the address that is this entry's name
  std::string text;                      ///< canonical
  Hash128 part;
  std::string files;  ///< canonical_files
  std::map<unsigned, std::string> shapes;
  TextForm picture;      ///< the picture's output
  std::string tone_map;  ///< canonical
  std::unordered_map<const void*, View> views;
  bool gain_changes_program = false;
};

/// What images of one material, environment, kind of lens and of light share.
struct Kind {
  Shared<std::filesystem::path> material, environment;  ///< keep the addresses that are its name
  Hash128 material_part;
  std::string material_id;  ///< ids_of_model
  std::string files;        ///< canonical, of an image without effects of its camera
  Hash128 files_part;
  MeshExtras reads;                     ///< of a model, by the material
  Hash128 colours;                      ///< of canonical_colours
  std::vector<Hash128> plane_programs;  ///< of each wanted; none where that is the plane's alone
  std::vector<TextForm> plane_engines;  ///< of each wanted plane of light: as `engine`
  Hash128 program;                      ///< of its tokens, as they stand in a canonical text
  bool made = false;
  EngineSettings settings;  ///< with seed 0
  TextForm engine;          ///< folded, "seed" to be filled
  std::optional<TextForm> kept;
};

/// Of an image's own material: of its texts.
struct MaterialHashes {
  Hash128 part, colours;
};

/// Whether the image's gain makes another program.
bool is_gained(const EnvironmentChange& change, const Environment& environment) {
  return environment.gain_changes_program && is_gain(change);
}

/// All that the kinds of effects in an image depend on; `material` names what of its material does. What constants a
/// material has is no part of them, so that images with other values of the same properties are of one kind.
/// `others`: DistractorTexts::programs. `lit`: lights_and_changes.
std::string kind_name(const ImageSpec& image, const Environment& environment, bool gained,
                      Hash128 material, const std::string& others, const std::string& lit) {
  return fmt::format("{} {} {}{}{}{}{}{}", material.hex(), environment.part.hex(),
                     image.camera.lens_radius_m > 0 ? "lens" : "pinhole", gained ? " gained" : "",
                     others.empty() ? "" : " with ", others, lit.empty() ? "" : " lit by ", lit);
}

/// What of the lights beside its environment's, and of that environment's values, an image's program depends on.
std::string lights_and_changes(const ImageSpec& image, const EnvironmentChange& change) {
  std::set<std::string_view> kinds;
  for (const Light& light : *image.lights)
    if (shines(light)) kinds.insert(type_of(light).kernel_prefix);
  const std::string values = program_share_of(change.values);
  return fmt::format("{}{}{}", fmt::join(kinds, " "), values.empty() ? "" : " changed ", values);
}

}  // namespace

class KeyMaker::State {
 public:
  State(const Recipe& recipe, Inputs& inputs, TextSet& texts);

  ImageKeys keys(const ImageSpec& image);
  Hash128 kept_key(const ImageSpec& image, const ImageKeys& keys);
  void add_texts(const ImageSpec& image, const ImageKeys& keys);

 private:
  /// A text that is an image's own, folded, and its hash.
  struct OwnText {
    Hash128 hash;
    std::string text;
  };
  OwnText own(std::string_view canonical) {
    std::string folded = texts_.fold(canonical);
    const Hash128 hash = hash_text(folded);
    return {hash, std::move(folded)};
  }
  /// The hash of a text that add_texts may be asked for.
  Hash128 note(std::string_view canonical) { return own_.emplace_back(own(canonical)).hash; }
  const OwnText& model_text(const ImageSpec& image, MeshExtras reads);
  Hash128 model_part(const ImageSpec& image, MeshExtras reads) {
    return model_text(image, reads).hash;
  }
  Environment& environment_of(const ImageSpec& image);
  View& view_of(Environment& environment, const ImageSpec& image);
  Kind& kind_of(const ImageSpec& image, const Environment& environment);
  EnvironmentChange changed(const ImageSpec& image) { return change_of(image, recipe_, inputs_); }
  const std::string& program(const ImageSpec& image);
  Hash128 program_hash(const ImageSpec& image, const std::string& kind);
  MaterialHashes material_of_image(const Kind& kind, const ImageSpec& image);
  Hash128 view_part(View& view, const ImageSpec& image);
  Hash128 traced_plane(std::size_t number, const PartHashes& parts, Hash128 colours,
                       const Environment& environment, View& view, Kind& kind,
                       const ImageSpec& image);
  void add_outputs(ImageKeys& keys, Hash128 colours, Environment& environment, View& view,
                   Kind& kind, const ImageSpec& image);

  const Recipe& recipe_;
  Inputs& inputs_;
  TextSet& texts_;
  std::vector<OutputKind> output_kinds_;
  std::vector<WantedPlane> planes_;      ///< as they stand in output_kinds_
  Shared<std::filesystem::path> model_;  ///< the last image's: a model's images follow each other
  NormaliseOptions options_;             ///< and how it is placed
  std::array<std::optional<OwnText>, 8> model_parts_;  ///< by what of the model is read
  std::unordered_map<const void*, Environment> environments_;
  std::map<std::tuple<const void*, const void*, bool, bool, std::string, std::string>, Kind> kinds_;
  DistractorTexts distractors_;
  std::deque<std::pair<SceneEffects, std::string>> programs_;
  TextForm five_, film_sums_, files_;
  // Of the image that keys() was asked for last:
  PartHashes last_{};
  Kind* kind_ = nullptr;
  const View* view_ = nullptr;  ///< where it has no text of its own
  std::vector<OwnText> own_;
  bool colours_ = false;   ///< a wanted plane reads materials
  bool reserved_ = false;  ///< there is place for the texts of all images
};

KeyMaker::State::State(const Recipe& recipe, Inputs& inputs, TextSet& texts)
    : recipe_(recipe),
      inputs_(inputs),
      texts_(texts),
      output_kinds_(kinds_of(recipe.outputs)),
      distractors_(recipe, inputs),
      five_(form_of_parts({})) {
  CanonicalText head;
  head.add("kind", "film_sums");
  film_sums_ = form_of_parts(head);
  CanonicalText files;
  std::vector<const char*> names;
  for (const OutputKind& kind : output_kinds_) {
    files.add(kind.kind, "");
    names.push_back(kind.kind.data());  // names are literals
    if (kind.plane == nullptr) continue;
    planes_.push_back(wanted_plane(kind));
    colours_ = colours_ || reads_materials(*kind.plane);
  }
  files_ = TextForm(files.text(), names);
}

const KeyMaker::State::OwnText& KeyMaker::State::model_text(const ImageSpec& image,
                                                            MeshExtras reads) {
  const NormaliseOptions options = normalise_of(image, recipe_);
  if (!model_.is_same(image.model_file) || options != options_) {
    model_parts_ = {};
    model_ = image.model_file;
    options_ = options;
  }
  std::optional<OwnText>& part =
      model_parts_[(reads.uvs ? 1U : 0U) + (reads.colors ? 2U : 0U) + (reads.normals ? 4U : 0U)];
  if (!part) part = own(canonical_model(inputs_.model_hashes(image.model_file), reads, options));
  return *part;
}

Environment& KeyMaker::State::environment_of(const ImageSpec& image) {
  const auto found = environments_.find(image.environment_folder.identity());
  if (found != environments_.end()) return found->second;
  const EnvironmentFacts& facts = inputs_.environment_facts(image.environment_folder);
  const ToneMap& tone_map = tone_map_of(recipe_, facts);
  Environment made;
  made.folder = image.environment_folder;
  made.part = texts_.add(facts.text);
  made.files = canonical_files(recipe_.outputs, tone_map, facts);
  made.shapes = facts.shapes;
  made.gain_changes_program = facts.gain_changes_program;
  made.tone_map = canonical_tone_map(tone_map);
  made.picture = output_form("image", k_picture_format, made.tone_map);
  return environments_.emplace(made.folder.identity(), std::move(made)).first->second;
}

View& KeyMaker::State::view_of(Environment& environment, const ImageSpec& image) {
  View& view = environment.views[image.view.identity()];
  const EngineSettings& engine = image.engine;
  EnvironmentChange change = changed(image);
  if (view.width == engine.width && view.height == engine.height &&
      same(view.camera, image.camera) && view.change == change)
    return view;
  view.name = image.view;
  view.camera = image.camera;
  view.change = std::move(change);
  view.width = engine.width;
  view.height = engine.height;
  view.text = canonical_camera(image.camera) + canonical_change(view.change);
  view.part.reset();
  view.planes.clear();
  for (const WantedPlane& plane : planes_)
    view.planes.push_back(is_of_light(*plane.type)
                              ? TextForm()
                              : plane_form(plane, environment.shapes, image, view.change));
  return view;
}

/// What views of an image have in common, and what is its own.
Hash128 KeyMaker::State::view_part(View& view, const ImageSpec& image) {
  if (!image.distractors->empty() || !image.lights->empty())
    return note(view.text + canonical_lights(image.lights) + distractors_.of_picture(image));
  if (!view.part) view.part = hash_text(texts_.fold(view.text));
  view_ = &view;
  return *view.part;
}

/// Of what a plane is made from, for an image; `parts`: of its picture.
Hash128 KeyMaker::State::traced_plane(std::size_t number, const PartHashes& parts, Hash128 colours,
                                      const Environment& environment, View& view, Kind& kind,
                                      const ImageSpec& image) {
  const WantedPlane& plane = planes_[number];
  if (is_of_light(*plane.type)) {
    const Hash128 engine =
        kind.plane_engines[number].hash({view_of_digits(fmt::format_int(image.engine.seed))});
    return five_.hash({HexText(parts[0]).text(), HexText(parts[1]).text(), HexText(parts[2]).text(),
                       HexText(parts[3]).text(), HexText(engine).text()});
  }
  TextForm own;
  const bool alone = (plane.type->traits & kernels::k_plane_alone) != 0;
  if (!image.distractors->empty() && !alone)
    own = plane_form(plane, environment.shapes, image, view.change,
                     distractors_.of_plane(image, *plane.type));
  TextForm& form = image.distractors->empty() || alone ? view.planes[number] : own;
  if (reads_materials(*plane.type)) {
    MeshExtras reads = kind.reads;
    reads.normals = plane.reads.normals;
    return form.hash({HexText(kind.plane_programs[number]).text(),
                      HexText(model_part(image, reads)).text(), HexText(colours).text()});
  }
  const bool has_id = (plane.type->traits & kernels::k_plane_material_ids) != 0;
  return form.hash({HexText(model_part(image, plane.reads)).text(),
                    has_id ? std::string_view(kind.material_id) : std::string_view()});
}

/// Of few different ones, however many materials and environments there are.
const std::string& KeyMaker::State::program(const ImageSpec& image) {
  SceneEffects effects = scene_effects(scene_without_model(recipe_, inputs_, image), image.camera);
  for (const auto& [known, text] : programs_)
    if (known == effects) return text;
  std::string text = program_tokens(path_program_text(effects));
  return programs_.emplace_back(std::move(effects), std::move(text)).second;
}

/// Hash of the program's value in a canonical text, under which that is kept. It depends on the
/// material, the environment and the lens, and on dsbuild itself.
Hash128 KeyMaker::State::program_hash(const ImageSpec& image, const std::string& kind) {
  const std::string question = "program " + kind;
  if (const auto known = inputs_.find_known(question))
    if (const auto hash = Hash128::from_hex(*known)) return *hash;
  CanonicalText text;
  text.add("program", program(image));
  const std::string folded = texts_.fold(text.text());
  const std::size_t at = folded.find(TextSet::k_reference) + 1;
  const auto hash = Hash128::from_hex(std::string_view(folded).substr(at, 32));
  DS_ASSERT(hash);  // programs are longer than the longest value
  inputs_.keep_known(question, hash->hex());
  return *hash;
}

Kind& KeyMaker::State::kind_of(const ImageSpec& image, const Environment& environment) {
  const bool lens = image.camera.lens_radius_m > 0;
  const EnvironmentChange change = changed(image);
  const bool gained = is_gained(change, environment);
  const std::string others = distractors_.programs(image), lit = lights_and_changes(image, change);
  Kind& kind = kinds_[{image.material_file.identity(), image.environment_folder.identity(), lens,
                       gained, others, lit}];
  if (kind.made && same_but_seed(kind.settings, image.engine)) return kind;
  EngineSettings settings = image.engine;
  settings.seed = 0;
  kind.material = image.material_file;
  kind.environment = image.environment_folder;
  const Scene material = material_of(image, recipe_, inputs_);
  kind.material_part = texts_.add(canonical_material(material));
  kind.reads = reads_of_model(material);
  kind.reads.normals = true;
  kind.material_id = ids_of_model(material);
  CanonicalText id;
  if (recipe_.outputs.find_plane("material_id") != nullptr)
    id.add("model.material.id", kind.material_id);
  kind.files = environment.files + id.text();
  kind.files_part = texts_.add(kind.files);
  const bool own = shows_own(image);
  const Hash128 program_name = own ? program_name_of(material) : kind.material_part;
  const std::string of = kind_name(image, environment, gained, program_name, others, lit);
  kind.program = program_hash(image, of);
  kind.engine =
      TextForm(canonical_engine(settings, TextSet::k_reference + kind.program.hex()), {"seed"});
  kind.kept.reset();
  kind.colours = hash_text(canonical_colours(material));
  kind.plane_programs.clear();
  kind.plane_engines.clear();
  for (const WantedPlane& plane : planes_) {
    const bool light = is_of_light(*plane.type);
    Hash128 program;
    if (light || reads_materials(*plane.type))
      program = plane_program(*plane.type, of, recipe_, inputs_, image);
    kind.plane_programs.push_back(program);
    TextForm engine;
    if (light) engine = TextForm(canonical_engine(settings, program.hex()), {"seed"});
    kind.plane_engines.push_back(std::move(engine));
  }
  kind.settings = settings;
  kind.made = true;
  return kind;
}

/// What is drawn of a material is each image's own.
MaterialHashes KeyMaker::State::material_of_image(const Kind& kind, const ImageSpec& image) {
  if (recipe_.vary.empty()) return {kind.material_part, kind.colours};
  const Scene material = material_of(image, recipe_, inputs_);
  return {note(canonical_material(material)),
          colours_ ? hash_text(canonical_colours(material)) : Hash128{}};
}

void KeyMaker::State::add_outputs(ImageKeys& keys, Hash128 colours, Environment& environment,
                                  View& view, Kind& kind, const ImageSpec& image) {
  keys.outputs.reserve(output_kinds_.size());
  std::vector<HexText> texts;
  texts.reserve(output_kinds_.size());
  std::vector<std::string_view> values;
  std::size_t next = 0;
  for (const OutputKind& output : output_kinds_) {
    Hash128 key;
    if (output.plane == nullptr) {
      const std::string effects = canonical_effects(effects_of(image));
      const HexText render(keys.render);
      key = effects.empty()
                ? environment.picture.hash({render.text()})
                : hash_text(std::string(environment.picture.fill({render.text()})) + effects);
    } else {
      const Hash128 traced =
          traced_plane(next, keys.parts, colours, environment, view, kind, image);
      TextForm& form = planes_[next++].output;
      const HexText from(traced);
      key = output.developed
                ? hash_text(std::string(form.fill({from.text()})) + environment.tone_map)
                : form.hash({from.text()});
    }
    texts.emplace_back(key);
    keys.outputs.push_back(
        {std::string(output.kind), output_path(image.id, output.ending), key, output.plane});
  }
  for (const HexText& text : texts)
    values.push_back(text.text());
  keys.files = files_.hash(values);
}

ImageKeys KeyMaker::State::keys(const ImageSpec& image) {
  own_.clear();
  view_ = nullptr;
  Environment& environment = environment_of(image);
  View& view = view_of(environment, image);
  Kind& kind = kind_of(image, environment);
  const MaterialHashes material = material_of_image(kind, image);
  ImageKeys keys;
  keys.parts = {model_part(image, kind.reads),
                material.part,
                environment.part,
                view_part(view, image),
                kind.engine.hash({view_of_digits(fmt::format_int(image.engine.seed))}),
                kind.files_part};
  const auto& parts = keys.parts;
  keys.render =
      five_.hash({HexText(parts[0]).text(), HexText(parts[1]).text(), HexText(parts[2]).text(),
                  HexText(parts[3]).text(), HexText(parts[4]).text()});
  if (const std::string effects = canonical_effects(effects_of(image)); !effects.empty())
    keys.parts[5] = note(kind.files + effects);
  add_outputs(keys, material.colours, environment, view, kind, image);
  last_ = keys.parts;
  kind_ = &kind;
  return keys;
}

Hash128 KeyMaker::State::kept_key(const ImageSpec& image, const ImageKeys& keys) {
  Kind& kind = kind_of(image, environment_of(image));
  if (!kind.kept)
    kind.kept = TextForm(canonical_kept_engine(kind.settings, program(image)), {"seed"});
  const Hash128 engine = kind.kept->hash({view_of_digits(fmt::format_int(image.engine.seed))});
  const auto& parts = keys.parts;
  return film_sums_.hash({HexText(parts[0]).text(), HexText(parts[1]).text(),
                          HexText(parts[2]).text(), HexText(parts[3]).text(),
                          HexText(engine).text()});
}

/// The other texts were added when the first image of their kind was met, but for a program that was
/// known by its hash.
void KeyMaker::State::add_texts(const ImageSpec& image, const ImageKeys& keys) {
  if (kind_ == nullptr || last_ != keys.parts) this->keys(image);
  Kind& kind = *kind_;
  if (!reserved_ && !recipe_.drawn.empty()) {
    constexpr std::size_t k_most_texts = 6;  // an image's own
    texts_.reserve(k_most_texts * image_count(recipe_));
    reserved_ = true;
  }
  const OwnText& model = model_text(image, kind.reads);
  texts_.put(model.hash, model.text);
  if (view_ != nullptr) texts_.add(view_->text);
  for (OwnText& one : own_)
    texts_.put(one.hash, std::move(one.text));
  kind_ = nullptr;  // these texts are gone
  texts_.add(kind.engine.fill({view_of_digits(fmt::format_int(image.engine.seed))}));
  if (texts_.find(kind.program) != nullptr) return;
  CanonicalText text;
  text.add("program", program(image));
  texts_.fold(text.text());
}

KeyMaker::KeyMaker(const Recipe& recipe, Inputs& inputs, TextSet& texts)
    : state_(std::make_unique<State>(recipe, inputs, texts)) {}

KeyMaker::~KeyMaker() = default;

ImageKeys KeyMaker::keys(const ImageSpec& image) {
  return state_->keys(image);
}

Hash128 KeyMaker::kept_key(const ImageSpec& image, const ImageKeys& keys) {
  return state_->kept_key(image, keys);
}

void KeyMaker::add_texts(const ImageSpec& image, const ImageKeys& keys) {
  state_->add_texts(image, keys);
}

}  // namespace ds
