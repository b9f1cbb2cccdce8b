// SPDX-License-Identifier: Apache-2.0
#include "tracer/render/develop.h"

#include "tracer/base/error.h"
#include "tracer/base/files.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <string>
#include <thread>

namespace ds {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

constexpr float k_nan = std::numeric_limits<float>::quiet_NaN();
constexpr float k_infinity = std::numeric_limits<float>::infinity();

Film grey_film(std::vector<float> values) {
  Film film;
  film.width = static_cast<int>(values.size());
  film.height = 1;
  for (const float value : values)
    film.rgb.insert(film.rgb.end(), {value, value, value});
  return film;
}

/// A picture whose every byte is used, so that a mixed-up row or channel shows.
Film gradient_film(int width, int height) {
  Film film{width, height, {}, 17};
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      film.rgb.insert(film.rgb.end(), {static_cast<float>(x) / static_cast<float>(width),
                                       static_cast<float>(y) / static_cast<float>(height),
                                       static_cast<float>((x * 7 + y * 13) % 31) / 31.0f});
  return film;
}

ToneMap tone_map(ToneMap::Kind kind, float gamma = 2.2f) {
  ToneMap map;
  map.kind = kind;
  map.gamma = gamma;
  return map;
}

int developed_grey(float value, const ToneMap& map) {
  return develop(grey_film({value}), map).pixels[0];
}

std::string as_text(const std::vector<std::byte>& bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

TEST(Develop, LinearScalesAndRoundsHalvesUp) {
  ToneMap map = tone_map(ToneMap::Kind::linear, 1.0f);
  EXPECT_EQ(developed_grey(0.0f, map), 0);
  EXPECT_EQ(developed_grey(1.0f, map), 255);
  EXPECT_EQ(developed_grey(0.5f, map), 128);  // 127.5
  EXPECT_EQ(developed_grey(std::nextafter(0.5f, 0.0f), map), 127);
  EXPECT_EQ(developed_grey(100.0f / 255.0f, map), 100);
  map.scale = 0.25f;
  EXPECT_EQ(developed_grey(2.0f, map), 128);
  EXPECT_EQ(tone_map_scale(grey_film({3}), map), 0.25);
}

TEST(Develop, GammaIsAPower) {
  const ToneMap map = tone_map(ToneMap::Kind::linear);
  for (int level = 0; level <= 255; ++level) {
    const double linear = std::pow(level / 255.0, double{map.gamma});
    EXPECT_EQ(developed_grey(static_cast<float>(linear), map), level);
  }
}

TEST(Develop, WhatIsOutsideTheRangeIsClamped) {
  const ToneMap map = tone_map(ToneMap::Kind::linear);
  EXPECT_EQ(developed_grey(-1.0f, map), 0);
  EXPECT_EQ(developed_grey(1e30f, map), 255);
  EXPECT_EQ(developed_grey(k_infinity, map), 255);
  EXPECT_EQ(developed_grey(k_nan, map), 0);
}

TEST(Develop, ChannelsAndRowsStayInPlace) {
  Film film{2, 2, {1, 0, 0, 0, 1, 0, 0, 0, 1, 1, 1, 1}, 0};
  const BytePicture picture = develop(film, tone_map(ToneMap::Kind::linear));
  EXPECT_EQ(picture.width, 2);
  EXPECT_EQ(picture.height, 2);
  EXPECT_EQ(picture.channels, 3);
  EXPECT_THAT(picture.pixels, ElementsAre(255, 0, 0, 0, 255, 0, 0, 0, 255, 255, 255, 255));
}

TEST(Develop, AutolinearBringsTheMeanToAFixedGrey) {
  // A film of one grey: 1.25 (118 / 255)^gamma whatever the grey, so 118 * 1.25^(1 / 2.2) after
  // gamma.
  const ToneMap map = tone_map(ToneMap::Kind::autolinear);
  const int expected = static_cast<int>(std::lround(118 * std::pow(1.25, 1 / 2.2)));
  for (const float grey : {1e-4f, 0.3f, 1.0f, 7e5f})
    EXPECT_EQ(developed_grey(grey, map), expected) << grey;
}

TEST(Develop, AutolinearScaleIsTheFormula) {
  const ToneMap map = tone_map(ToneMap::Kind::autolinear, 1.8f);
  const Film film{2, 1, {0.5f, 0.25f, 2.0f, 0, 0, 0}, 0};
  const double mean = (0.212671 * 0.5 + 0.715160 * 0.25 + 0.072169 * 2.0) / 2;
  const double expected = 1.25 / mean * std::pow(118.0 / 255.0, double{map.gamma});
  EXPECT_NEAR(tone_map_scale(film, map) / expected, 1.0, 1e-13);
}

TEST(Develop, AutolinearLeavesBlackAndBrokenPixelsOut) {
  const ToneMap map = tone_map(ToneMap::Kind::autolinear);
  EXPECT_EQ(tone_map_scale(grey_film({0, 0, 0}), map), 1.0);
  EXPECT_EQ(tone_map_scale(grey_film({1, -5}), map), tone_map_scale(grey_film({1, 0}), map));
  EXPECT_EQ(tone_map_scale(grey_film({1, k_infinity}), map),
            tone_map_scale(grey_film({1, k_nan}), map));
}

TEST(Develop, ReinhardIsTheFormula) {
  ToneMap map = tone_map(ToneMap::Kind::reinhard02, 1.0f);
  map.prescale = 2.0f;
  const Film film = grey_film({0.2f, 0.8f});
  const double scale = 0.1 / std::sqrt(0.2 * 0.8);  // the mean of logarithms is the geometric mean
  EXPECT_NEAR(tone_map_scale(film, map) / scale, 1.0, 1e-7);
  const BytePicture picture = develop(film, map);
  for (std::size_t i = 0; i < 2; ++i) {
    const double value = double{film.rgb[i * 3]}, y = value * scale / 2;
    const double mapped = value * scale * double{map.postscale} * (1 + y / (3.75 * 3.75)) / (1 + y);
    EXPECT_EQ(picture.pixels[i * 3], std::lround(255 * mapped)) << i;
  }
}

TEST(Develop, ReinhardStandsBlackAndNoBurn) {
  ToneMap map = tone_map(ToneMap::Kind::reinhard02);
  EXPECT_EQ(developed_grey(0.0f, map), 0);
  map.burn = 0;
  EXPECT_EQ(developed_grey(1.0f, map), 255);
}

FloatPicture depths(int width, int height, std::vector<float> values) {
  return {width, height, {"Z"}, std::move(values)};
}

TEST(Encoding, TheSameBytesEachTimeAndFromEachThread) {
  const Film film = gradient_film(97, 61);
  const BytePicture picture = develop(film, tone_map(ToneMap::Kind::linear));
  const FloatPicture geometry = depths(97, 61, std::vector<float>(97 * 61, 0.25f));
  const auto png = encode_png(picture), exr = encode_film_exr(film),
             depth = encode_exr(geometry, false);
  std::vector<std::thread> threads;
  for (int i = 0; i < 3; ++i)
    threads.emplace_back([&] {
      EXPECT_EQ(encode_png(picture), png);
      EXPECT_EQ(encode_film_exr(film), exr);
      EXPECT_EQ(encode_exr(geometry, false), depth);
    });
  for (std::thread& thread : threads)
    thread.join();
  // A time of writing has a resolution of a second.
  std::this_thread::sleep_for(std::chrono::milliseconds(1100));
  EXPECT_EQ(encode_png(picture), png);
  EXPECT_EQ(encode_film_exr(film), exr);
  EXPECT_EQ(encode_exr(geometry, false), depth);
}

TEST(Encoding, APngHoldsPixelsAndNothingElse) {
  for (const int channels : {1, 3}) {
    const BytePicture picture{
        3, 2, channels, std::vector<std::uint8_t>(static_cast<std::size_t>(6 * channels), 77)};
    const std::string png = as_text(encode_png(picture));
    std::vector<std::string> chunks;
    for (std::size_t at = 8; at + 8 <= png.size();) {
      std::uint32_t size = 0;
      for (std::size_t i = 0; i < 4; ++i)
        size = size << 8 | static_cast<unsigned char>(png[at + i]);
      chunks.push_back(png.substr(at + 4, 4));
      at += 12 + size;
    }
    EXPECT_THAT(chunks, ElementsAre("IHDR", "oFFs", "IDAT", "IEND"));
    EXPECT_EQ(png[24], 8);                      // bits a sample
    EXPECT_EQ(png[25], channels == 1 ? 0 : 2);  // grey, RGB
    EXPECT_EQ(png[28], 0);                      // not interlaced
  }
}

TEST(Encoding, AnExrNamesNoDateAndNoProgram) {
  for (const std::string& exr : {as_text(encode_film_exr(gradient_film(8, 8))),
                                 as_text(encode_exr(depths(2, 1, {1, 2}), false))}) {
    const std::string header = exr.substr(0, exr.find("screenWindowWidth"));
    ASSERT_LT(header.size(), exr.size());
    for (const char* text : {"OpenImageIO", "oftware", "host", "utor", "wner"})
      EXPECT_EQ(header.find(text), std::string::npos) << text;
    // OpenImageIO always writes this attribute; ours is a text of no length.
    EXPECT_NE(header.find(std::string("capDate\0string\0\0\0\0\0", 19)), std::string::npos);
  }
}

TEST(Encoding, AFilmComesBackExactly) {
  Film film = gradient_film(33, 20);
  film.rejected_samples = std::uint64_t{1} << 40;
  film.rgb[0] = std::numeric_limits<float>::denorm_min();
  film.rgb[1] = std::numeric_limits<float>::max();
  film.rgb[2] = -0.0f;
  const Film back = decode_film_exr(encode_film_exr(film), "film");
  EXPECT_EQ(back.width, film.width);
  EXPECT_EQ(back.height, film.height);
  EXPECT_EQ(back.rejected_samples, film.rejected_samples);
  ASSERT_EQ(back.rgb.size(), film.rgb.size());
  EXPECT_EQ(std::memcmp(back.rgb.data(), film.rgb.data(), film.rgb.size() * sizeof(float)), 0);
}

TEST(Encoding, WhatIsNoFilmIsAnAssetError) {
  const auto message = [](const std::vector<std::byte>& bytes) -> std::string {
    try {
      decode_film_exr(bytes, "store/film");
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::asset);
      return error.what();
    }
    return "no error";
  };
  const std::vector<std::byte> film = encode_film_exr(gradient_film(64, 64));
  EXPECT_THAT(message({}), HasSubstr("store/film: cannot be read as an image: wanted EXR"));
  EXPECT_THAT(message(encode_png(BytePicture{1, 1, 3, {1, 2, 3}})),
              HasSubstr("store/film: no film of ours"));
  EXPECT_THAT(message(encode_exr(depths(1, 1, {1}), false)), HasSubstr("found 1 of float"));
  for (const std::size_t kept :
       {std::size_t{4}, std::size_t{100}, film.size() / 2, film.size() - 1}) {
    const std::vector<std::byte> torn(film.begin(),
                                      film.begin() + static_cast<std::ptrdiff_t>(kept));
    EXPECT_THAT(message(torn), HasSubstr("store/film: cannot")) << kept;
  }
}

TEST(PixelHash, IsTheHashOfHeaderAndPixels) {
  const BytePicture picture{2, 1, 3, {1, 2, 3, 4, 5, 250}};
  EXPECT_EQ(pixel_hash(encode_png(picture), "p"),
            hash_text(std::string("2x1x3 uint8\n\1\2\3\4\5\372", 18)));
  const FloatPicture geometry = depths(2, 1, {1.0f, -2.0f});
  EXPECT_EQ(pixel_hash(encode_exr(geometry, false), "d"),
            hash_text(std::string("2x1x1 float\n\0\0\x80\x3f\0\0\0\xc0", 20)));
}

TEST(PixelHash, SeesEveryPixelAndTheShape) {
  const BytePicture picture{2, 3, 1, {1, 2, 3, 4, 5, 6}};
  BytePicture changed = picture, turned = picture;
  changed.pixels[5] ^= 1;
  std::swap(turned.width, turned.height);
  const Hash128 hash = pixel_hash(encode_png(picture), "p");
  EXPECT_NE(hash, pixel_hash(encode_png(changed), "p"));
  EXPECT_NE(hash, pixel_hash(encode_png(turned), "p"));
}

TEST(PixelHash, ReadsFilesAndNamesThemInErrors) {
  const TemporaryFolder folder;
  const BytePicture picture{2, 3, 1, {1, 2, 3, 4, 5, 6}};
  write_file_atomic(folder.path() / "a.png", encode_png(picture));
  EXPECT_EQ(pixel_hash(folder.path() / "a.png"), pixel_hash(encode_png(picture), "p"));
  EXPECT_THROW(pixel_hash(folder.path() / "b.png"), Error);
  write_file_atomic(folder.path() / "c.png", "not a picture");
  EXPECT_THROW(pixel_hash(folder.path() / "c.png"), Error);
}

/// What `develop` rounds is what the curve says, for every kind of tone map.
TEST(ToneCurve, IsWhatDevelopRounds) {
  Film film = gradient_film(40, 30);
  for (std::size_t i = 0; i < film.rgb.size(); i += 5)
    film.rgb[i] *= 1e-4f;
  film.rgb[7] = 1e-12f;
  film.rgb[8] = 1e12f;
  for (const auto kind :
       {ToneMap::Kind::linear, ToneMap::Kind::reinhard02, ToneMap::Kind::autolinear})
    for (const float gamma : {1.0f, 1.8f, 2.2f}) {
      const ToneMap map = tone_map(kind, gamma);
      const ToneCurve curve(map, tone_map_scale(film, map));
      const BytePicture picture = develop(film, map);
      for (std::size_t i = 0; i < film.rgb.size(); i += 3) {
        const auto values = curve.at({film.rgb[i], film.rgb[i + 1], film.rgb[i + 2]});
        for (std::size_t c = 0; c < 3; ++c)
          ASSERT_NEAR(255 * values[c], picture.pixels[i + c], 0.5 + 255e-4) << gamma << " " << i;
      }
    }
}

TEST(ToneCurve, IsTheFormula) {
  ToneMap map = tone_map(ToneMap::Kind::linear);
  const ToneCurve curve(map, 0.5);
  for (double x = 1e-10; x < 2; x *= 1.0173) {
    const auto value = static_cast<float>(2 * x);
    EXPECT_NEAR(curve.at({value, 0, 0})[0], std::pow(std::min(double{value} / 2, 1.0), 1 / 2.2),
                1e-4)
        << x;
  }
  EXPECT_EQ(curve.at({-1, 0, k_nan})[0], 0);
  EXPECT_EQ(curve.at({-1, 0, k_nan})[2], 0);
}

}  // namespace
}  // namespace ds
