// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tracer/render/render.h"

#include <functional>
#include <future>
#include <optional>
#include <string>
#include <utility>

namespace ds {

/// What makes a scene ready, in whatever thread it is called.
using SceneSource = std::function<ReadyScenePointer()>;

/// A scene that is made ready in a thread of its own while another one is traced: one at a time, so
/// that no more than two are held. Called from one thread.
class SceneAhead {
 public:
  /// Starts to make it; nothing where the one of this name is under way or waits. One of another name
  /// is dropped.
  void start(const std::string& name, SceneSource source);
  /// The scene of this name once it is made, or nothing where it was not begun; one of another name
  /// stays. Throws what making it threw.
  ReadyScenePointer take(const std::string& name);

 private:
  struct Begun {
    std::string name;
    std::future<ReadyScenePointer> scene;  ///< its end waits for the thread
  };
  std::optional<Begun> begun_;
};

}  // namespace ds
