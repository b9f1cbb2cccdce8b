// SPDX-License-Identifier: Apache-2.0
// Models, materials and environments of the recipe that no image shows.
#include "manifests/check/check.h"
#include "tracer/base/error.h"

#include <nlohmann/json.hpp>

#include <filesystem>
#include <set>

namespace ds {
namespace {

using Field = std::string ImageRecord::*;

/// What a list of the recipe names; nothing where it is none.
std::vector<std::string> names_in(const CheckInput& input, const char* key) {
  const auto list = nlohmann::json::parse(input.setting(key), nullptr, false);
  std::vector<std::string> names;
  if (!list.is_array()) return names;
  for (const auto& name : list)
    if (name.is_string()) names.push_back(name.get<std::string>());
  return names;
}

void check_list(const CheckInput& input, CheckReport& report, CheckLevel level, const char* key,
                Field field, const char* what, std::string ObjectRecord::*of_object = nullptr) {
  std::set<std::string> used;
  for (const ImageRecord& image : input.images) {
    used.insert(image.*field);
    if (of_object == nullptr) continue;
    for (const ObjectRecord& object : image.objects)
      used.insert(object.*of_object);
  }
  const std::vector<std::string> names = names_in(input, key);
  std::vector<std::string> unused;
  for (const std::string& name : names)
    if (!used.contains(name) && !used.contains(std::filesystem::path(name).stem().string()))
      unused.push_back(name);
  report.add(level, what, unused, names.size(), "", std::vector<std::string>());
}

/// By classes.unlisted = "skip", which was meant once and may be of models that came later.
void check_skipped(const CheckInput& input, CheckReport& report) {
  if (input.setting("classes.unlisted") != "\"skip\"") return;
  for (const Concern& concern : input.dataset.concerns) {
    if (concern.name != "models_unlisted" || concern.count == 0) continue;
    report.say(
        CheckLevel::note,
        fmt::format("{} of {} model files stand in no class file and are left out "
                    "(classes.unlisted = \"skip\"): {}{}",
                    concern.count, concern.of, fmt::join(concern.examples, ", "),
                    concern.count > concern.examples.size()
                        ? fmt::format(" and {} more", concern.count - concern.examples.size())
                        : ""));
  }
}

void check_unused(const CheckInput& input, CheckReport& report) {
  check_skipped(input, report);
  check_list(input, report, CheckLevel::warning, "models.files", &ImageRecord::model,
             "models of the recipe are in no image");
  check_list(input, report, CheckLevel::note, "materials.files", &ImageRecord::material,
             "materials of the recipe are in no image", &ObjectRecord::material);
  check_list(input, report, CheckLevel::note, "environments.files", &ImageRecord::environment,
             "environments of the recipe are in no image");
}

}  // namespace

Check unused_check() {
  return {"unused", "models, materials and environments of the recipe that no image shows",
          check_unused};
}

}  // namespace ds
