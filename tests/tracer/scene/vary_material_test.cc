// SPDX-License-Identifier: Apache-2.0
#include "tracer/scene/vary_material.h"

#include "tracer/scene/sdl.h"
#include "tracer/scene/type_tables.h"

#include <gtest/gtest.h>

#include <array>
#include <span>
#include <string>

namespace ds {
namespace {

Scene material(const char* name) {
  return read_material(std::string(DS_SOURCE_DIR "/assets/materials/") + name + ".mat");
}

TEST(WithValues, PutsThemWhereThePatternSays) {
  const PropertyValue values[] = {{"*.uroughness", {0.25, 0.25, 0.25}},
                                  {"red-*.kd", {0.1, 0.2, 0.3}}};
  const Scene red = with_values(material("red-plastic"), values);
  const NodeType& type = material_types()[static_cast<std::size_t>(red.materials[0].type)];
  const auto input = [&](const char* name) {
    return red.materials[0].inputs[static_cast<std::size_t>(find_input(type, name))].constant;
  };
  EXPECT_EQ(input("uroughness").x, 0.25F);
  EXPECT_EQ(input("vroughness").x, 0.06F);
  EXPECT_EQ(input("kd"), (Vec3{0.1F, 0.2F, 0.3F}));
  // Another material is called otherwise: nothing but the roughness.
  const Scene before = material("marbled-plastic"), after = with_values(before, values);
  EXPECT_NE(canonical_material(after), canonical_material(before));
  EXPECT_EQ(canonical_material(with_values(before, std::span(values).subspan(1))),
            canonical_material(before));
}

TEST(WithValues, ReplacesTexturesAndReachesIntoThem) {
  const Scene before = material("marbled-plastic");
  const Scene plain = with_values(before, std::array{PropertyValue{"*.kd", {0.5, 0.5, 0.5}}});
  EXPECT_EQ(plain.materials[0].inputs[0].texture, -1);
  const Scene tinted =
      with_values(before, std::array{PropertyValue{"tinted.texture2", {0.9, 0.1, 0.1}}});
  EXPECT_NE(canonical_material(tinted), canonical_material(before));
  EXPECT_EQ(tinted.materials[0].inputs[0].texture, before.materials[0].inputs[0].texture);
}

TEST(FitOf, CountsWhatAPatternNames) {
  const Scene red = material("red-plastic"), marble = material("marbled-plastic");
  EXPECT_EQ(fit_of(red, "*.uroughness").count, 1);
  EXPECT_FALSE(fit_of(red, "*.uroughness").colour);
  EXPECT_TRUE(fit_of(red, "*.kd").colour);
  EXPECT_EQ(fit_of(red, "r*d-p*c.ks").count, 1);
  EXPECT_EQ(fit_of(red, "*.no-such").count, 0);
  EXPECT_EQ(fit_of(red, "kd").count, 0);
  EXPECT_EQ(fit_of(red, "blue.kd").count, 0);
  EXPECT_TRUE(fit_of(red, "*.doublesided").flag);
  EXPECT_EQ(fit_of(marble, "*.texture2").count, 2);  // of both textures that have one
  EXPECT_EQ(fit_of(marble, "tinted.texture2").count, 1);
}

}  // namespace
}  // namespace ds
