// SPDX-License-Identifier: Apache-2.0
// A scene that another thread makes ready: handed over, or its error, or nothing.
#include "builder/make/scene_ahead.h"

#include "tracer/base/error.h"
#include "tracer/render/scene_maker.h"

#include <gtest/gtest.h>

#include <atomic>
#include <thread>

namespace ds {
namespace {

SceneSource source_of(const std::string& name, std::atomic<int>& made) {
  return [name, &made] {
    ++made;
    ReadyScenePointer scene(new ReadyScene);
    scene->scene.mended_meshes = {name};
    return scene;
  };
}

TEST(SceneAhead, HandsOverWhatWasBegun) {
  SceneAhead ahead;
  std::atomic<int> made{0};
  EXPECT_EQ(ahead.take("a"), nullptr);
  ahead.start("a", source_of("a", made));
  ahead.start("a", source_of("again", made));
  EXPECT_EQ(ahead.take("b"), nullptr) << "another scene";
  const ReadyScenePointer scene = ahead.take("a");
  ASSERT_NE(scene, nullptr);
  EXPECT_EQ(scene->scene.mended_meshes.front(), "a");
  EXPECT_EQ(ahead.take("a"), nullptr) << "it was taken";
  EXPECT_EQ(made, 1);
}

TEST(SceneAhead, DropsAWrongGuess) {
  SceneAhead ahead;
  std::atomic<int> made{0};
  ahead.start("a", source_of("a", made));
  ahead.start("b", source_of("b", made));
  EXPECT_EQ(ahead.take("a"), nullptr);
  EXPECT_NE(ahead.take("b"), nullptr);
  ahead.start("c", source_of("c", made));  // and is never taken
}

TEST(SceneAhead, ThrowsWhatMakingItThrewWhereItIsTaken) {
  SceneAhead ahead;
  ahead.start("a", []() -> ReadyScenePointer { fail(ErrorKind::asset, "no such model"); });
  try {
    ahead.take("a");
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::asset);
    EXPECT_STREQ(error.what(), "no such model");
  }
  EXPECT_EQ(ahead.take("a"), nullptr);
}

}  // namespace
}  // namespace ds
