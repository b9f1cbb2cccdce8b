// SPDX-License-Identifier: Apache-2.0
#include "tracer/scene/sdl_reader.h"

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

float positive(const SdlNode& node, std::string_view property, float default_value) {
  const double value = node.number(property, double{default_value});
  if (value > 0) return static_cast<float>(value);
  node.error(property, "wanted a number above 0, found {}", value);
  return default_value;
}

class PipelineReader {
 public:
  explicit PipelineReader(ToneMap& tone_map) : tone_map_(tone_map) { tone_map_.gamma = 1; }

  void read(const SdlNode& node) {
    const std::string type = node.type("");
    if (type == "NOP") return;
    if (type == "GAMMA_CORRECTION") return read_gamma(node);
    if (type == "TONEMAP_LINEAR") {
      take_tone_map(node, ToneMap::Kind::linear);
      tone_map_.scale = positive(node, "scale", 1);
    } else if (type == "TONEMAP_REINHARD02") {
      take_tone_map(node, ToneMap::Kind::reinhard02);
      tone_map_.prescale = positive(node, "prescale", tone_map_.prescale);
      tone_map_.postscale = positive(node, "postscale", tone_map_.postscale);
      tone_map_.burn = positive(node, "burn", tone_map_.burn);
    } else if (type == "TONEMAP_AUTOLINEAR") {
      take_tone_map(node, ToneMap::Kind::autolinear);
    } else {
      node.refuse_type(type);
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
    tone_map_.gamma = positive(node, "value", 2.2f);
    node.number("table.size", 4096);
  }

  ToneMap& tone_map_;
  bool has_tone_map_ = false;
  bool has_gamma_ = false;
};

}  // namespace

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
