// SPDX-License-Identifier: Apache-2.0
#include "tracer/render/film_file.h"

#include "tracer/base/error.h"
#include "tracer/base/hash.h"
#include "tracer/kernels/layout.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

namespace ds {
namespace {

using testing::HasSubstr;

/// Every number another; planes from k_film_nan on are empty but for the outliers.
FilmSums some_film() {
  FilmSums film = empty_film(11, 9);
  for (std::size_t i = 0; i < film.tile_spp.size(); ++i)
    film.tile_spp[i] = static_cast<std::uint32_t>(16u << i);
  float next = -100;
  for (std::size_t tile = 0; tile < film.tile_spp.size(); ++tile)
    for (std::size_t plane = 0; plane < kernels::k_film_nan; ++plane)
      for (float& value : film.row(tile, plane))
        value = next += 0.37f;
  film.row(1, kernels::k_film_outliers)[5] = 1;
  film.schedule.tone_scale = 0.1;
  film.schedule.least_bound = 0.25;
  return film;
}

std::string text_of(std::span<const std::byte> bytes) {
  std::string text;
  for (const std::byte b : bytes)
    text.push_back(static_cast<char>(b));
  return text;
}

std::vector<std::byte> bytes_with_checksum(const std::string& content) {
  const auto text = bytes_of(content);
  std::vector<std::byte> bytes(text.begin(), text.end());
  const std::string hex = hash_text(content).hex();
  for (std::size_t i = 0; i < hex.size(); i += 2)
    bytes.push_back(static_cast<std::byte>(std::stoi(hex.substr(i, 2), nullptr, 16)));
  return bytes;
}

std::string refusal(const std::vector<std::byte>& bytes) {
  try {
    decode_film_sums(bytes, "the film");
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::asset);
    return error.what();
  }
  return "taken";
}

TEST(FilmFile, ReadsBackWhatWasWritten) {
  FilmSums film = some_film();
  for (const bool scheduled : {true, false}) {
    if (!scheduled) film.schedule = {};
    const FilmSums back = decode_film_sums(encode_film_sums(film), "the film");
    EXPECT_EQ(back.width, 11);
    EXPECT_EQ(back.height, 9);
    EXPECT_EQ(back.tile_spp, film.tile_spp);
    EXPECT_EQ(back.planes, film.planes);
    EXPECT_EQ(back.schedule, film.schedule);
  }
}

TEST(FilmFile, IsWhatItsGrammarSays) {
  FilmSums film = empty_film(1, 1);
  film.tile_spp[0] = 0x01020304;
  film.row(0, kernels::k_film_sum + 1)[0] = 1;
  film.schedule.tone_scale = 0.5;
  const std::string content =
      "dsbuild film 2\nwidth=1\nheight=1\nplanes=1\ntone_scale=0x1p-1\nleast_bound=inf\n\n"
      "\x04\x03\x02\x01" +
      std::string("\0\0\x80\x3f", 4) + std::string(60, '\0');
  EXPECT_EQ(text_of(encode_film_sums(film)), text_of(bytes_with_checksum(content)));
}

TEST(FilmFile, ALostByteIsNoticedWhereverItWas) {
  const std::vector<std::byte> whole = encode_film_sums(some_film());
  for (std::size_t i = 0; i < whole.size(); i += 7) {
    std::vector<std::byte> damaged = whole;
    damaged[i] ^= std::byte{1};
    EXPECT_THAT(refusal(damaged), HasSubstr("the film: no film of this version: its checksum"));
    damaged.resize(i);
    EXPECT_THAT(refusal(damaged), HasSubstr("the film: no film of this version: "));
  }
}

TEST(FilmFile, RefusesWhatAnotherVersionWouldHaveWritten) {
  const std::vector<std::byte> whole = encode_film_sums(some_film());
  const std::string content = text_of(std::span(whole).first(whole.size() - 16));
  ASSERT_EQ(refusal(bytes_with_checksum(content)), "taken");
  const auto changed = [&](const std::string& from, const std::string& to) {
    std::string text = content;
    return refusal(bytes_with_checksum(text.replace(text.find(from), from.size(), to)));
  };
  EXPECT_THAT(changed("film 2", "film 1"), HasSubstr("it begins otherwise"));
  EXPECT_THAT(changed("width=11", "width=0"), HasSubstr("wanted a number in [1, 16384]"));
  EXPECT_THAT(changed("width=11", "width=11x"), HasSubstr("wanted a number"));
  EXPECT_THAT(changed("height=9", "height=8"), HasSubstr("it is longer"));
  EXPECT_THAT(changed("height=9", "height=16"), HasSubstr("it is cut off"));
  EXPECT_THAT(changed("height=9", "breadth=9"), HasSubstr("wanted height=..."));
  EXPECT_THAT(changed("planes=0 1", "planes=1 0"), HasSubstr("out of order"));
  EXPECT_THAT(changed("planes=0 1", "planes=0 49"), HasSubstr("wanted a number in [0, 48]"));
  EXPECT_THAT(changed("least_bound=0x", "least_bound=0y"), HasSubstr("hexadecimal float"));
  EXPECT_THAT(changed("least_bound=0x", "least_bound=0x-"), HasSubstr("hexadecimal float"));
  EXPECT_THAT(changed("tone_scale=0x1.999999999999ap-4", "tone_scale=inf"),
              HasSubstr("hexadecimal float"));
  EXPECT_THAT(changed("tone_scale=0x", "tone_scale=zx"), HasSubstr("hexadecimal float"));
  EXPECT_THAT(changed("\n\n", "\nmore=1\n\n"), HasSubstr("its head is longer"));
}

/// Tracing on from any of these would spoil the picture, or count what no number holds.
TEST(FilmFile, RefusesValuesThatNoSamplesAddUpTo) {
  const auto written = [](std::size_t plane, float value) {
    FilmSums film = some_film();
    film.row(2, plane)[5] = value;
    return refusal(encode_film_sums(film));
  };
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const float infinity = std::numeric_limits<float>::infinity();
  for (const float value : {nan, infinity, -infinity}) {
    EXPECT_THAT(written(kernels::k_film_sum, value), HasSubstr("a value that is not finite"));
    EXPECT_THAT(written(kernels::k_film_removed, value), HasSubstr("a value that is not finite"));
  }
  EXPECT_EQ(written(kernels::k_film_halves, -3), "taken");
  EXPECT_THAT(written(kernels::k_film_infinite, -1), HasSubstr("a count below 0"));
  EXPECT_EQ(written(kernels::k_film_nan, 0x1p24f), "taken");
  EXPECT_THAT(written(kernels::k_film_nan, 0x1p25f), HasSubstr("a count that is too large"));
  EXPECT_EQ(written(kernels::k_film_removed, 0x1p25f), "taken");
}

/// What is read is written as the same bytes again.
TEST(FilmFile, RefusesOtherSpellingsOfAFilm) {
  const auto film = [](const std::string& width, const std::string& planes,
                       const std::string& bound, const std::string& values) {
    return refusal(bytes_with_checksum(
        "dsbuild film 2\nwidth=" + width + "\nheight=1\nplanes=" + planes +
        "\ntone_scale=none\nleast_bound=" + bound + "\n\n\1" + std::string(3, '\0') + values));
  };
  const std::string ones(64, '\1'), zeros(64, '\0');
  ASSERT_EQ(film("4", "9 10", "0x1p-4", ones + ones), "taken");
  EXPECT_THAT(film("04", "9 10", "0x1p-4", ones + ones), HasSubstr("spelled otherwise"));
  EXPECT_THAT(film("4", "9  10", "0x1p-4", ones + ones), HasSubstr("spelled otherwise"));
  EXPECT_THAT(film("4", "9 10", "0x8p-7", ones + ones), HasSubstr("spelled otherwise"));
  EXPECT_THAT(film("4", "9 10", "0x1p-4", ones + zeros), HasSubstr("a plane that is all zero"));
  EXPECT_THAT(film("4", "", "0x1p-4", ""), HasSubstr("it holds no samples"));
}

}  // namespace
}  // namespace ds
