// SPDX-License-Identifier: Apache-2.0
#include "tracer/render/loaded_images.h"

#include "tracer/base/canonical.h"
#include "tracer/render/images.h"

#include <algorithm>

namespace ds {
namespace {

std::string use_of(const Image& image) {
  CanonicalText text;
  text.add("file", image.file.string());
  text.add("content", image.content.hex());
  text.add("gamma", image.gamma);
  text.add("srgb", image.srgb);
  text.add("embedded", image.embedded);
  text.add("gain", image.gain);
  text.add("use", static_cast<int>(image.use));
  text.add("channel", static_cast<int>(image.channel));
  return text.text();
}

}  // namespace

void LoadedImages::load(Image& image) {
  if (!image.rgb.empty() || image.content == Hash128{}) return load_image(image);
  const std::string use = use_of(image);
  const auto found = std::find_if(known_.begin(), known_.end(),
                                  [&](const Known& known) { return known.use == use; });
  if (found != known_.end()) {
    known_.splice(known_.begin(), known_, found);
  } else {
    load_image(image);
    const std::size_t bytes = image.rgb.size() * sizeof(float);
    if (bytes > most_bytes_) return;
    known_.push_front({use, image.width, image.height, image.rgb});
    for (bytes_ += bytes; bytes_ > most_bytes_; known_.pop_back())
      bytes_ -= known_.back().rgb.size() * sizeof(float);
    return;
  }
  image.width = known_.front().width;
  image.height = known_.front().height;
  image.rgb = known_.front().rgb;
}

void LoadedImages::load(Scene& scene) {
  for (Image& image : scene.images)
    load(image);
}

}  // namespace ds
