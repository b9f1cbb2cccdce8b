// SPDX-License-Identifier: Apache-2.0
#include "builder/make/scene_ahead.h"

namespace ds {

void SceneAhead::start(const std::string& name, SceneSource source) {
  if (begun_ && begun_->name == name) return;
  begun_.reset();
  begun_ = Begun{name, std::async(std::launch::async, std::move(source))};
}

ReadyScenePointer SceneAhead::take(const std::string& name) {
  if (!begun_ || begun_->name != name) return nullptr;
  Begun begun = *std::exchange(begun_, std::nullopt);
  return begun.scene.get();
}

}  // namespace ds
