// SPDX-License-Identifier: Apache-2.0
#include "builder/forecast/calibration.h"

#include "builder/plan/image_scene.h"
#include "tracer/base/canonical.h"
#include "tracer/base/error.h"
#include "tracer/base/files.h"

#include <nlohmann/json.hpp>

#include <map>
#include <system_error>

namespace ds {
namespace {

/// Version 1: first.
constexpr int k_version = 1;

void put_optional(nlohmann::json& object, const char* name, std::optional<double> value) {
  if (value) object[name] = *value;
}

std::optional<double> get_optional(const nlohmann::json& object, const char* name) {
  if (!object.contains(name)) return std::nullopt;
  return object.at(name).get<double>();
}

/// Removes what was made in a folder, however it is left.
class Scratch {
 public:
  explicit Scratch(std::filesystem::path folder) : folder_(std::move(folder)) {}
  ~Scratch() {
    std::error_code ignored;
    std::filesystem::remove_all(folder_, ignored);
  }
  Scratch(const Scratch&) = delete;
  Scratch& operator=(const Scratch&) = delete;
  const std::filesystem::path& folder() const { return folder_; }

 private:
  std::filesystem::path folder_;
};

/// Keys of the images to probe, by id; without those that cannot be read.
std::map<std::string, Hash128> probe_keys(const Recipe& recipe, Inputs& inputs,
                                          const std::vector<PairImages>& pairs,
                                          const std::string& device) {
  TextSet texts;
  KeyMaker maker(recipe, inputs, texts);
  std::map<std::string, Hash128> keys;
  for (const PairImages& pair : pairs)
    for (const ImageSpec& image : pair.images) {
      ImageSpec probed = image;
      probed.engine.spp = probe_samples(image.engine).high;
      probed.engine.target.reset();
      try {
        keys[image.id] = probe_key(maker.keys(probed), recipe, device);
      } catch (const DamagedDatabase&) {
        throw;
      } catch (const Error&) {
        continue;  // the plan tells of it
      }
    }
  return keys;
}

/// The first of each pair, the second of each, ...: no scene follows itself.
std::vector<ImageSpec> by_turns(const std::vector<PairImages>& pairs) {
  std::vector<ImageSpec> images;
  bool more = true;
  for (std::size_t turn = 0; more; ++turn) {
    more = false;
    for (const PairImages& pair : pairs) {
      if (turn >= pair.images.size()) continue;
      images.push_back(pair.images[turn]);
      more = true;
    }
  }
  return images;
}

}  // namespace

std::filesystem::path CalibrationCache::path_of(Hash128 key) const {
  return folder_ / "calibration" / (key.hex() + ".json");
}

std::optional<Probe> CalibrationCache::find(Hash128 key) const {
  const std::filesystem::path file = path_of(key);
  std::error_code error;
  if (!std::filesystem::is_regular_file(file, error)) return std::nullopt;
  return probe_from_json(read_text_file(file));
}

void CalibrationCache::put(Hash128 key, const Probe& probe) const {
  write_file_atomic(path_of(key), to_json_text(probe));
}

Hash128 probe_key(const ImageKeys& keys, const Recipe& recipe, const std::string& device) {
  CanonicalText text;
  text.add("version", k_version);
  text.add("render", keys.render.hex());
  text.add("files", keys.files.hex());
  text.add("low_spp", probe_samples(recipe.engine).low);
  if (recipe.engine.target && recipe.engine.target->region == ErrorRegion::model)
    text.add("error_region", "model");
  text.add("keep_film", recipe.keep_film);
  if (recipe.keep_sums) text.add("keep_sums", true);
  text.add("device", device);
  return hash_text(text.text());
}

std::string to_json_text(const Probe& probe) {
  nlohmann::json object{{"version", k_version},
                        {"low_spp", probe.low_spp},
                        {"high_spp", probe.high_spp},
                        {"scene_seconds", probe.scene_seconds},
                        {"image_seconds", probe.image_seconds},
                        {"sample_seconds", probe.sample_seconds},
                        {"bytes", nlohmann::json::object()}};
  put_optional(object, "low_error", probe.low_error);
  put_optional(object, "high_error", probe.high_error);
  for (const auto& [kind, size] : probe.bytes)
    object["bytes"][kind] = {size.low, size.high};
  if (probe.target)
    object["target"] = {probe.target->spp, probe.target->error, probe.target->sample_seconds};
  return object.dump() + "\n";
}

std::optional<Probe> probe_from_json(const std::string& text) {
  try {
    const nlohmann::json object = nlohmann::json::parse(text);
    if (object.at("version").get<int>() != k_version) return std::nullopt;
    Probe probe;
    probe.low_spp = object.at("low_spp").get<int>();
    probe.high_spp = object.at("high_spp").get<int>();
    probe.scene_seconds = object.at("scene_seconds").get<double>();
    probe.image_seconds = object.at("image_seconds").get<double>();
    probe.sample_seconds = object.at("sample_seconds").get<double>();
    probe.low_error = get_optional(object, "low_error");
    probe.high_error = get_optional(object, "high_error");
    for (const auto& [kind, size] : object.at("bytes").items())
      probe.bytes[kind] = {size.at(0).get<double>(), size.at(1).get<double>()};
    if (object.contains("target")) {
      const nlohmann::json& target = object.at("target");
      probe.target = {target.at(0).get<double>(), target.at(1).get<double>(),
                      target.at(2).get<double>()};
    }
    if (probe.low_spp < 1 || probe.high_spp <= probe.low_spp) return std::nullopt;
    return probe;
  } catch (const nlohmann::json::exception&) {
    return std::nullopt;
  }
}

namespace {

/// An image whose model cannot be read keeps its camera: it is left out where its key is made.
void settle_images(std::vector<PairImages>& pairs, const Recipe& recipe, Inputs& inputs) {
  ImageSettler settler(recipe, inputs);
  for (PairImages& pair : pairs)
    for (ImageSpec& image : pair.images) {
      try {
        settler.settle(image);
      } catch (const DamagedDatabase&) {
        throw;
      } catch (const Error&) {
      }
    }
}

}  // namespace

Calibration calibrate(const Recipe& recipe, Inputs& inputs, Renderer& renderer,
                      const CalibrationCache& cache, const CalibrationWish& wish,
                      const std::filesystem::path& scratch, const ProbeWatch& watch) {
  Calibration calibration;
  calibration.device = renderer.device();
  const bool by_error = wish.by_error && recipe.outputs.image;
  std::vector<PairImages> wanted = images_to_probe(expand(recipe));
  settle_images(wanted, recipe, inputs);
  const std::map<std::string, Hash128> keys =
      probe_keys(recipe, inputs, wanted, calibration.device);
  std::map<std::string, Probe> probes;
  std::vector<ImageSpec> missing;
  for (const ImageSpec& image : by_turns(wanted)) {
    if (!keys.contains(image.id)) continue;
    const std::optional<Probe> known = wish.again ? std::nullopt : cache.find(keys.at(image.id));
    if (known && (known->target || !by_error))
      probes[image.id] = *known;
    else
      missing.push_back(image);
  }
  const Scratch work(scratch);
  const std::vector<Probe> found =
      probe_images(recipe, inputs, missing, renderer, work.folder(), by_error, watch);
  for (std::size_t i = 0; i < missing.size(); ++i) {
    cache.put(keys.at(missing[i].id), found[i]);
    probes[missing[i].id] = found[i];
  }
  calibration.measured = missing.size();
  for (const PairImages& pair : wanted) {
    PairImages readable{pair.environment, pair.material, {}};
    std::vector<Probe> of_pair;
    for (const ImageSpec& image : pair.images)
      if (probes.contains(image.id)) {
        readable.images.push_back(image);
        of_pair.push_back(probes.at(image.id));
      }
    if (of_pair.empty()) continue;
    calibration.pairs.push_back(std::move(readable));
    calibration.probes.push_back(std::move(of_pair));
  }
  return calibration;
}

}  // namespace ds
