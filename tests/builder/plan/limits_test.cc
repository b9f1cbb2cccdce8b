// SPDX-License-Identifier: Apache-2.0
#include "builder/plan/limits.h"

#include "manifests/manifest.h"
#include "tests/builder/tiny_dataset.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace ds {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;

class LimitsTest : public TinyDataset {
 protected:
  static constexpr const char* k_bad = "box.off/2";

  LimitsTest() {
    calls.rejected["box.off/2"] = 3;  // of 1024
    calls.rejected["box.off/3"] = 1;
  }
  ImageRecord record(const std::string& id) const {
    for (const ImageRecord& image : read_images_manifest(output()))
      if (image.id == id) return image;
    fail(ErrorKind::io, "no image {}", id);
  }
};

TEST_F(LimitsTest, APictureOverTheLimitFailsWithItsCounts) {
  request.overrides = {"engine.rejected_limit=0.002"};
  const BuildResult result = build({true, false});
  EXPECT_EQ(result.failed, 1U);
  EXPECT_EQ(result.built, k_images - 1);
  ASSERT_THAT(result.failures, SizeIs(1));
  EXPECT_EQ(result.failures[0].first, k_bad);
  EXPECT_EQ(result.failures[0].second,
            "of 1024 samples 3 had to be left out (3 NaN, 0 infinite, 0 negative), more than the "
            "share of 0.002 that engine.rejected_limit allows");
  EXPECT_FALSE(contents().contains("images/box.off/2.png"));
  EXPECT_FALSE(contents().contains("images/box.off/2.mask.png"));
  EXPECT_EQ(read_images_manifest(output()).size(), k_images - 1);
  EXPECT_EQ(record("box.off/3").film.nan_samples, 1U);
  EXPECT_EQ(record("box.off/3").rejected_samples, 1U);
}

TEST_F(LimitsTest, ARefusedPictureIsNotTracedAgain) {
  request.overrides = {"engine.rejected_limit=0.002"};
  build({true, false});
  const BuildResult again = build({true, false});
  EXPECT_EQ(again.failed, 1U);
  EXPECT_THAT(calls.traced, IsEmpty());
  ASSERT_THAT(again.failures, SizeIs(1));
  EXPECT_THAT(again.failures[0].second, HasSubstr("3 had to be left out"));
  // With a higher limit it is there at once.
  request.overrides = {"engine.rejected_limit=0.003"};
  const BuildResult allowed = build();
  EXPECT_TRUE(allowed.ok());
  EXPECT_EQ(allowed.built, 1U);
  EXPECT_EQ(allowed.traced_samples, 0U);
  EXPECT_TRUE(contents().contains("images/box.off/2.png"));
}

TEST_F(LimitsTest, ALowerLimitTakesPicturesOutAgain) {
  request.overrides = {"engine.rejected_limit=1"};
  EXPECT_TRUE(build().ok());
  const auto all = contents();
  request.overrides = {"engine.rejected_limit=0"};
  const BuildResult result = build({true, false});
  EXPECT_EQ(result.failed, 2U);
  EXPECT_EQ(result.reused, k_images - 2);
  EXPECT_THAT(calls.traced, IsEmpty());
  EXPECT_FALSE(contents().contains("images/box.off/2.png"));
  EXPECT_FALSE(contents().contains("images/box.off/3.png"));
  request.overrides = {"engine.rejected_limit=1"};
  EXPECT_TRUE(build().ok());
  EXPECT_EQ(contents(), all);
}

TEST_F(LimitsTest, TheLimitIsInNoKey) {
  EXPECT_FALSE(build({true, false}).ok());  // 0.001 by default: three are too many
  request.overrides = {"engine.rejected_limit=0.5"};
  EXPECT_EQ(build().traced_samples, 0U);
}

TEST_F(LimitsTest, AnOlderRecordHasItsTotalOnly) {
  ImageSpec image;
  image.engine.width = image.engine.height = 10;
  image.engine.spp = 10;
  Recipe recipe;
  recipe.rejected_limit = 0.01;
  Product product;
  product.rejected_samples = 10;
  EXPECT_NO_THROW(check_limits(recipe, image, product));
  product.rejected_samples = 11;
  EXPECT_THROW(check_limits(recipe, image, product), Error);
}

}  // namespace
}  // namespace ds
