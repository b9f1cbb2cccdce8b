// SPDX-License-Identifier: Apache-2.0
#include "tracer/scene/sdl_node.h"

#include <algorithm>
#include <charconv>

namespace ds {
namespace {

/// Steps in the order of their numbers, as LuxCore runs them, not of the file.
std::vector<std::string> steps_in_order(const PropertySet& properties) {
  std::vector<std::string> steps = properties.names_below(section_of(SdlKind::film));
  const auto number = [](const std::string& text) {
    unsigned value = 0;
    std::from_chars(text.data(), text.data() + text.size(), value);
    return value;
  };
  std::stable_sort(steps.begin(), steps.end(), [&](const std::string& a, const std::string& b) {
    return number(a) < number(b);
  });
  return steps;
}

float number(const SdlNode& node, std::string_view property) {
  return static_cast<float>(node.number(property));
}

class PipelineReader {
 public:
  explicit PipelineReader(ToneMap& tone_map) : tone_map_(tone_map) { tone_map_.gamma = 1; }

  void read(SdlNode node) {
    if (!node.read_type()) return;
    const std::string& type = node.type();
    if (type == "NOP") return;
    if (type == "GAMMA_CORRECTION") return read_gamma(node);
    if (type == "TONEMAP_LINEAR") {
      take_tone_map(node, ToneMap::Kind::linear);
      tone_map_.scale = number(node, "scale");
    } else if (type == "TONEMAP_REINHARD02") {
      take_tone_map(node, ToneMap::Kind::reinhard02);
      tone_map_.prescale = number(node, "prescale");
      tone_map_.postscale = number(node, "postscale");
      tone_map_.burn = number(node, "burn");
    } else {
      DS_ASSERT(type == "TONEMAP_AUTOLINEAR");
      take_tone_map(node, ToneMap::Kind::autolinear);
    }
  }

 private:
  void take_tone_map(const SdlNode& node, ToneMap::Kind kind) {
    if (has_tone_map_) node.error("type", "a second tone map is not supported yet");
    if (has_gamma_) node.error("type", "a tone map after GAMMA_CORRECTION is not supported yet");
    has_tone_map_ = true;
    tone_map_.kind = kind;
  }
  void read_gamma(const SdlNode& node) {
    if (has_gamma_) node.error("type", "a second GAMMA_CORRECTION is not supported yet");
    has_gamma_ = true;
    tone_map_.gamma = number(node, "value");
    node.number("table.size");
  }

  ToneMap& tone_map_;
  bool has_tone_map_ = false;
  bool has_gamma_ = false;
};

}  // namespace

const SdlSection& film_section() {
  constexpr NumberRange k_positive{.least = 0, .open_least = true};
  static const SdlSection section{
      SdlKind::film,
      "film",
      "`environment.cfg`: the steps `film.imagepipeline.N.*` from linear radiance to a picture, in "
      "the order of N: at most one tone map, then at most one GAMMA_CORRECTION. Without any step: "
      "TONEMAP_AUTOLINEAR, then a gamma of 2.2. With steps and no GAMMA_CORRECTION pictures hold "
      "radiance itself, which looks dark.",
      "",
      {},
      {{"TONEMAP_LINEAR",
        "A factor.",
        {{"scale", SdlType::number, "1", "factor on the radiance", k_positive}}},
       {"TONEMAP_REINHARD02",
        "Reinhard and others' global curve.",
        {{"prescale", SdlType::number, "1", "factor before the curve", k_positive},
         {"postscale", SdlType::number, "1.2", "factor behind it", k_positive},
         {"burn", SdlType::number, "3.75", "where highlights burn out", k_positive}}},
       {"TONEMAP_AUTOLINEAR", "A factor that the picture's mean luminance gives.", {}},
       {"GAMMA_CORRECTION",
        "Pictures hold radiance^(1/value).",
        {{"value", SdlType::number, "2.2", "the gamma", k_positive},
         {"table.size", SdlType::number, "4096", "of LuxCore's table; no effect"}}},
       {"NOP", "Nothing.", {}}}};
  return section;
}

ToneMap read_tone_map(SdlReader& reader) {
  ToneMap tone_map;
  const std::vector<std::string> steps = steps_in_order(reader.properties);
  if (steps.empty()) {
    tone_map.kind = ToneMap::Kind::autolinear;
    return tone_map;
  }
  PipelineReader pipeline(tone_map);
  for (const std::string& step : steps)
    pipeline.read(SdlNode(reader, SdlKind::film, step));
  return tone_map;
}

}  // namespace ds
