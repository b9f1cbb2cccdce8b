// SPDX-License-Identifier: Apache-2.0
#include "builder/cmd/concerns_text.h"

#include "builder/cmd/grammar.h"
#include "builder/plan/dataset_concerns.h"
#include "builder/plan/evenness.h"
#include "tracer/base/error.h"
#include "tracer/base/log.h"
#include "tracer/base/streams.h"

#include <algorithm>
#include <iterator>
#include <string_view>

namespace ds {
namespace {

struct ConcernText {
  const char* name;
  const char* text;             ///< behind "2 of 8 "
  const char* allowed_by = "";  ///< what a recipe says where it is meant
  bool said = false;            ///< finding by finding, when it was planned
};
constexpr ConcernText k_texts[] = {
    {"mask_empty", "images show nothing of their model, the mask is empty"},
    {"mask_at_frame", "images cut their model off, the mask touches the frame"},
    {"mask_small", "images show their model on less than 1 % of the picture"},
    {"picture_black", "pictures are black"},
    {"picture_white", "pictures are clipped at white on more than a quarter"},
    {"models_absent", "models that the class files list have no file",
     "classes.missing = \"ignore\""},
    {"models_unlisted", "model files stand in no class file", "classes.unlisted = \"keep\""},
    {"entries_ambiguous",
     "entries of the class files mean several model files each, which get one class and split "
     "(their whole names in the class files tell them apart)"},
    {"classes_unshared", "classes have models in one of the class files only",
     "classes.unshared = \"keep\""},
    {"classes_empty", "classes have no image", "classes.missing = \"ignore\""},
    {"splits_empty", "splits have no image"},
    {"assets_unphysical", "materials and environments have values that no real surface has", "",
     true},
    {"assets_unlikely", "materials and environments have something that is hardly meant", "", true},
    {"sizes_unlikely", "images are of lengths that hardly go together", "", true},
    {"names_by_case",
     "images have a name that differs from another's in upper and lower case only; on a disk that "
     "does not tell them apart (macOS, Windows) their files are one"},
    {"meshes_damaged",
     "models and environments lost faces when they were read, as for an index out of range", "",
     true},
    {"models_unlikely", "models have colours, uvs or normals that are hardly what is meant", "",
     true},
    {"own_materials_partial", "models have materials of their own that are not shown whole", "",
     true},
    {"distractors_unplaced",
     "images show fewer distractors than were drawn, for want of places or of other models"},
    {"draws_idle", "distributions have no effect on any image"},
};

const ConcernText& text_of(const Concern& concern) {
  const auto* const at = std::find_if(std::begin(k_texts), std::end(k_texts),
                                      [&](const auto& one) { return one.name == concern.name; });
  DS_ASSERT(at != std::end(k_texts));
  return *at;
}

/// " (classes.missing = "ignore" in the recipe says that it is meant)", where something does.
std::string way_out(const Concern& concern) {
  const std::string_view allowed_by = text_of(concern).allowed_by;
  return allowed_by.empty() ? ""
                            : fmt::format(" ({} in the recipe says that it is meant)", allowed_by);
}

/// What became of models that no class file lists, and which files those are.
std::string remedy(const Concern& concern, const Recipe& recipe) {
  if (concern.name != "models_unlisted") return "";
  std::vector<std::string> files;
  for (const auto& file : {recipe.class_table, recipe.train_classes, recipe.test_classes})
    if (file) files.push_back(file->string());
  const bool left_out = recipe.models.size() + concern.count == concern.of;
  return fmt::format(
      "; {}{}", left_out ? "left out" : "built without a class",
      files.empty() ? ""
                    : fmt::format(": a line for each in {} mends it", fmt::join(files, " or ")));
}

/// A class without images is one whose models are absent.
bool is_allowed(const Concern& concern, const ClassCoverage& coverage) {
  return ((concern.name == "models_absent" || concern.name == "classes_empty") &&
          coverage.missing_allowed) ||
         (concern.name == "models_unlisted" && coverage.unlisted_allowed) ||
         (concern.name == "classes_unshared" && coverage.unshared_allowed);
}

}  // namespace

std::string to_text(const Concern& concern) {
  std::string text = fmt::format("{} of {} {}: {}", concern.count, concern.of,
                                 agreeing(concern.count, text_of(concern).text),
                                 fmt::join(concern.examples, ", "));
  if (concern.count > concern.examples.size())
    text += fmt::format(" and {} more", concern.count - concern.examples.size());
  return text;
}

nlohmann::json to_json(const std::vector<Concern>& concerns) {
  nlohmann::json object = nlohmann::json::object();
  for (const Concern& concern : concerns)
    object[concern.name] = concern.count;
  return object;
}

std::size_t tell_concerns(const std::vector<Concern>& concerns, const Recipe& recipe, bool strict) {
  std::size_t errors = 0;
  for (const Concern& concern : concerns) {
    if (concern.count == 0) continue;
    if (is_allowed(concern, recipe.coverage)) {
      say(Stream::people, "{}{}\n", to_text(concern), remedy(concern, recipe));
    } else if (strict) {
      ++errors;
      say(Stream::people, "dsbuild: error: {}{}{} (--strict)\n", to_text(concern),
          remedy(concern, recipe), way_out(concern));
    } else if (!text_of(concern).said) {
      warn(to_text(concern) + remedy(concern, recipe) + way_out(concern));
    }
  }
  const auto masks = std::find_if(concerns.begin(), concerns.end(),
                                  [](const Concern& one) { return one.name == "mask_empty"; });
  if (masks != concerns.end() && masks->of == 0 && recipe.outputs.find_plane("mask") == nullptr)
    say(Stream::people,
        "not checked: whether images show their model whole; outputs.mask = true or outputs.depth "
        "= "
        "\"exr\" tells it\n");
  return errors;
}

std::vector<Concern> tell_planned_concerns(const Recipe& recipe, const Plan& plan) {
  std::vector<const ImageSpec*> images;
  images.reserve(plan.images.size());
  for (const PlannedImage& image : plan.images)
    if (!image.error) images.push_back(&image.spec);
  std::vector<Concern> concerns = dataset_concerns(recipe, plan.concerns, {}, images);
  for (const Concern& concern : concerns) {
    if (concern.count == 0 || text_of(concern).said) continue;
    if (!is_allowed(concern, recipe.coverage))
      warn(to_text(concern) + remedy(concern, recipe) + way_out(concern));
    else if (concern.name == "models_unlisted")  // meant once, it may be of new models by now
      say(Stream::people, "{}{}\n", to_text(concern), remedy(concern, recipe));
  }
  return concerns;
}

nlohmann::json tell_uneven(const Recipe& recipe, const Plan& plan) {
  nlohmann::json list = nlohmann::json::array();
  for (const Uneven& uneven : find_uneven(recipe, plan)) {
    say(Stream::people, "{}\n", to_text(uneven));
    nlohmann::json one{
        {"kind", uneven.kind}, {"classes", uneven.classes}, {"classes_lacking", uneven.lacking}};
    if (!uneven.most.empty())
      one.update({{"split", uneven.split},
                  {"most", {{"name", uneven.most}, {"share", uneven.most_share}}},
                  {"least", {{"name", uneven.least}, {"share", uneven.least_share}}}});
    list.push_back(std::move(one));
  }
  return list;
}

}  // namespace ds
