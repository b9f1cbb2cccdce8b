// SPDX-License-Identifier: Apache-2.0
#include "tracer/render/images.h"

#include "tracer/base/error.h"
#include "tracer/base/files.h"
#include "tracer/render/develop.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <fstream>
#include <limits>
#include <string>
#include <sys/resource.h>
#include <unistd.h>
#include <vector>
#include <zlib.h>

namespace ds {
namespace {

namespace fs = std::filesystem;
using testing::AllOf;
using testing::Each;
using testing::ElementsAre;
using testing::FloatEq;
using testing::Ge;
using testing::HasSubstr;
using Bytes = std::vector<unsigned char>;

void append_number(Bytes& to, std::size_t number) {
  for (const unsigned shift : {24u, 16u, 8u, 0u})
    to.push_back(static_cast<unsigned char>(number >> shift & 255u));
}

void append_chunk(Bytes& png, const std::string& name, const Bytes& data) {
  append_number(png, data.size());
  Bytes checked(name.begin(), name.end());
  checked.insert(checked.end(), data.begin(), data.end());
  png.insert(png.end(), checked.begin(), checked.end());
  append_number(png, crc32(0, checked.data(), static_cast<uInt>(checked.size())));
}

/// A PNG file made by hand (ISO/IEC 15948): big-endian samples, no row filter. `color_type`: 0
/// grey, 2 RGB, 4 grey and alpha, 6 RGBA.
std::string png_file(std::size_t width, std::size_t height, unsigned char bits,
                     unsigned char color_type, const Bytes& samples, int level = 6) {
  Bytes header;
  append_number(header, width);
  append_number(header, height);
  header.insert(header.end(), {bits, color_type, 0, 0, 0});
  Bytes rows;
  const std::size_t row_bytes = height == 0 ? 0 : samples.size() / height;
  for (std::size_t y = 0; y < height; ++y) {
    rows.push_back(0);
    rows.insert(rows.end(), samples.begin() + static_cast<std::ptrdiff_t>(y * row_bytes),
                samples.begin() + static_cast<std::ptrdiff_t>((y + 1) * row_bytes));
  }
  uLongf size = compressBound(rows.size());
  Bytes packed(size);
  compress2(packed.data(), &size, rows.data(), rows.size(), level);
  packed.resize(size);
  Bytes png{0x89, 'P', 'N', 'G', '\r', '\n', 0x1a, '\n'};
  append_chunk(png, "IHDR", header);
  append_chunk(png, "IDAT", packed);
  append_chunk(png, "IEND", {});
  return {png.begin(), png.end()};
}

class LoadImage : public testing::Test {
 protected:
  Image image_of(const std::string& content, const std::string& name = "a.png") const {
    Image image;
    image.file = folder_.path() / name;
    write_file_atomic(image.file, content);
    image.content = hash_text(content);
    return image;
  }
  Image image_of(const std::vector<std::byte>& content, const std::string& name) const {
    return image_of(std::string(reinterpret_cast<const char*>(content.data()), content.size()),
                    name);
  }
  static std::string error_of(Image image) {
    try {
      load_image(image);
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::asset);
      EXPECT_THAT(error.what(), HasSubstr(image.file.string()));
      return error.what();
    }
    ADD_FAILURE() << "no error was thrown";
    return {};
  }
  static std::vector<float> pixels_of(Image image) {
    load_image(image);
    return image.rgb;
  }

  TemporaryFolder folder_;
};

float decoded8(int stored, double gamma) {
  return static_cast<float>(std::pow(stored / 255.0, gamma));
}

TEST_F(LoadImage, EightBitsAreRaisedToGamma) {
  Image image = image_of(png_file(2, 1, 8, 2, {0, 128, 255, 1, 2, 3}));
  load_image(image);
  EXPECT_EQ(image.width, 2);
  EXPECT_EQ(image.height, 1);
  const double gamma = double{image.gamma};
  EXPECT_THAT(image.rgb,
              ElementsAre(0.0f, FloatEq(decoded8(128, gamma)), 1.0f, FloatEq(decoded8(1, gamma)),
                          FloatEq(decoded8(2, gamma)), FloatEq(decoded8(3, gamma))));
}

TEST_F(LoadImage, SixteenBitsKeepTheirPrecision) {
  Image image = image_of(png_file(1, 2, 16, 0, {0x12, 0x34, 0x12, 0x35}));
  image.gamma = 1.0f;
  image.gain = 2.0f;
  load_image(image);
  const auto upper = static_cast<float>(2 * (0x1234 / 65535.0)),
             lower = static_cast<float>(2 * (0x1235 / 65535.0));
  EXPECT_EQ(image.height, 2);
  EXPECT_THAT(image.rgb, ElementsAre(upper, upper, upper, lower, lower, lower));
}

TEST_F(LoadImage, ChannelsAreSelected) {
  Image image = image_of(png_file(1, 1, 8, 6, {51, 102, 204, 153}));
  image.gamma = 1.0f;
  const auto first = [&](ImageChannel channel) {
    Image copy = image;
    copy.channel = channel;
    const std::vector<float> rgb = pixels_of(copy);
    EXPECT_TRUE(channel == ImageChannel::rgb || (rgb[0] == rgb[1] && rgb[1] == rgb[2]));
    return rgb[0];
  };
  EXPECT_THAT(pixels_of(image), ElementsAre(FloatEq(0.2f), FloatEq(0.4f), FloatEq(0.8f)));
  EXPECT_FLOAT_EQ(first(ImageChannel::red), 0.2f);
  EXPECT_FLOAT_EQ(first(ImageChannel::green), 0.4f);
  EXPECT_FLOAT_EQ(first(ImageChannel::blue), 0.8f);
  EXPECT_FLOAT_EQ(first(ImageChannel::alpha), 0.6f);
  EXPECT_FLOAT_EQ(first(ImageChannel::mean), 1.4f / 3);
  EXPECT_FLOAT_EQ(first(ImageChannel::colored_mean),
                  0.212671f * 0.2f + 0.715160f * 0.4f + 0.072169f * 0.8f);
}

TEST_F(LoadImage, AlphaHasNoGammaAndMultipliesNothing) {
  Image image = image_of(png_file(1, 1, 8, 4, {255, 51}));
  EXPECT_THAT(pixels_of(image), Each(1.0f));
  image.channel = ImageChannel::alpha;
  EXPECT_THAT(pixels_of(image), Each(FloatEq(0.2f)));
}

TEST_F(LoadImage, FloatsAreTakenAsTheyAre) {
  Image image = image_of(encode_film_exr(Film{2, 1, {0.5f, 1e6f, 0, 1e-30f, 3, 7}, 0}), "a.exr");
  EXPECT_THAT(pixels_of(image), ElementsAre(0.5f, 1e6f, 0, 1e-30f, 3, 7));
  image.gain = 0.5f;
  EXPECT_THAT(pixels_of(image), ElementsAre(0.25f, 5e5f, 0, 0.5e-30f, 1.5f, 3.5f));
}

TEST_F(LoadImage, NanAndInfinityAreErrorsWithTheirPlace) {
  for (const float bad :
       {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity()}) {
    Film film{3, 2, std::vector<float>(18, 1.0f), 0};
    film.rgb[(1 * 3 + 2) * 3 + 1] = bad;
    EXPECT_THAT(error_of(image_of(encode_film_exr(film), "a.exr")), HasSubstr("x = 2, y = 1"));
  }
}

TEST_F(LoadImage, NegativeValuesAreCountedAndBecomeZero) {
  testing::internal::CaptureStderr();
  const Image image =
      image_of(encode_film_exr(Film{2, 1, {-0.5f, 1, 1, 1, -1e-9f, 1}, 0}), "a.exr");
  EXPECT_THAT(pixels_of(image), ElementsAre(0, 1, 1, 1, 0, 1));
  EXPECT_THAT(testing::internal::GetCapturedStderr(), HasSubstr("a.exr: 2 negative values of 6"));
}

TEST_F(LoadImage, WhatIsNoImageIsAnError) {
  Image missing;
  missing.file = folder_.path() / "missing.png";
  EXPECT_THAT(error_of(missing), HasSubstr("wanted an image file, found none"));
  missing.file = folder_.path();
  EXPECT_THAT(error_of(missing), HasSubstr("wanted an image file, found none"));
  EXPECT_THAT(error_of(image_of(std::string("no picture at all"))),
              HasSubstr("cannot be read as an image"));
  EXPECT_THAT(error_of(image_of(std::string())), HasSubstr("cannot be read as an image"));
  EXPECT_THAT(error_of(image_of(png_file(0, 0, 8, 2, {}))),
              HasSubstr("cannot be read as an image"));
}

// libpng writes "libpng warning: iCCP: ..." for a colour profile that is none.
TEST_F(LoadImage, ChunksThatNoPixelNeedsAreNotRead) {
  const std::string plain = png_file(1, 1, 8, 2, {51, 102, 204});
  constexpr std::size_t k_behind_header = 8 + 12 + 13;
  Bytes extended(plain.begin(), plain.begin() + k_behind_header);
  append_chunk(extended, "iCCP", {'x', 0, 0, 1, 2, 3});
  extended.insert(extended.end(), plain.begin() + k_behind_header, plain.end());
  Image wanted = image_of(plain),
        image = image_of(std::string(extended.begin(), extended.end()), "b.png");
  load_image(wanted);
  testing::internal::CaptureStderr();
  load_image(image);
  EXPECT_EQ(image.rgb, wanted.rgb);
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
}

TEST_F(LoadImage, CutOffFilesAreErrors) {
  const std::string png = png_file(64, 64, 8, 2, Bytes(64 * 64 * 3, 99), 0);
  EXPECT_THAT(error_of(image_of(png.substr(0, png.size() / 2))), HasSubstr("cannot"));
  const auto exr = encode_film_exr(Film{64, 64, std::vector<float>(64 * 64 * 3, 0.3f), 0});
  EXPECT_THAT(error_of(image_of(std::vector<std::byte>(exr.begin(), exr.end() - 40), "a.exr")),
              HasSubstr("cannot"));
}

/// Of address space, beyond what the process has.
void limit_memory(rlim_t more) {
  std::ifstream statm("/proc/self/statm");
  rlim_t pages = 0;
  statm >> pages;
  const rlim_t most = pages * static_cast<rlim_t>(getpagesize()) + more;
  const rlimit limit{most, most};
  ASSERT_EQ(setrlimit(RLIMIT_AS, &limit), 0);
}

std::string wide_hdr(int width) {
  return fmt::format("#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 2 +X {}\n", width) +
         std::string(30, '\0');
}

// The library's buffer of 256 rows of 888888 pixels would take 2.7 GB, for a file of 82 bytes.
TEST_F(LoadImage, WideFilesOfFewBytesTakeLittleMemory) {
  EXPECT_THAT(error_of(image_of(wide_hdr(888888), "a.hdr")),
              HasSubstr("wanted at most 131072 pixels a row, found 888888"));
  Image image = image_of(wide_hdr(131072), "a.hdr");
  EXPECT_THAT(error_of(image), HasSubstr("cannot"));
  GTEST_FLAG_SET(death_test_style, "threadsafe");  // the library has threads
  EXPECT_EXIT(
      {
        limit_memory(256 << 20);
        const std::string error = error_of(image);
        std::_Exit(error.find("not enough memory") == error.npos ? 0 : 1);
      },
      testing::ExitedWithCode(0), "");
}

// Its reader takes a canvas of what the head promises before it reads on.
TEST_F(LoadImage, AGifOfFewBytesIsNotBelievedALargeCanvas) {
  const std::string head("GIF89a\x60\xea\x60\xea\x80\0\0\0\0\0\xff\xff\xff", 19);
  const std::string frame(",\0\0\0\0\x60\xea\x60\xea\0\x02\x02\x44\x01\0;", 16);
  EXPECT_THAT(error_of(image_of(head + frame, "a.gif")), HasSubstr("promises 60000 x 60000"));
}

TEST_F(LoadImage, AFileThatChangedIsAnError) {
  Image image = image_of(png_file(1, 1, 8, 0, {5}));
  image.content = Hash128{1, 2};
  EXPECT_THAT(error_of(image), HasSubstr("changed since the scene was read"));
  image.content = {};
  EXPECT_EQ(pixels_of(image).size(), 3u);
}

TEST_F(LoadImage, AnAlphaThatIsNotThereIsAnError) {
  Image image = image_of(png_file(1, 1, 8, 2, {1, 2, 3}));
  image.channel = ImageChannel::alpha;
  EXPECT_THAT(error_of(image), HasSubstr("wanted the alpha channel, found none among 3 channels"));
}

TEST_F(LoadImage, WholeNumbersCalledFloatsAreAnError) {
  for (const char* name : {"a.exr", "a.HDR", "a.pfm"}) {
    EXPECT_THAT(error_of(image_of(png_file(1, 1, 8, 2, {1, 2, 3}), name)),
                HasSubstr("found whole numbers of 8 bits"));
    EXPECT_THAT(error_of(image_of(png_file(1, 1, 16, 0, {1, 2}), name)),
                HasSubstr("found whole numbers of 16 bits"));
  }
}

TEST_F(LoadImage, ImagesWithoutFilesAndLoadedOnesAreLeftAlone) {
  Scene scene;
  scene.images.resize(2);
  scene.images[0].rgb = {1, 2, 3};
  scene.images[1].file = folder_.path() / "missing.png";
  scene.images[1].rgb = {4, 5, 6};
  load_images(scene);
  EXPECT_THAT(scene.images[0].rgb, ElementsAre(1, 2, 3));
  EXPECT_THAT(scene.images[1].rgb, ElementsAre(4, 5, 6));
}

TEST_F(LoadImage, RealHdrisLoad) {
  const fs::path folder = fs::path(DS_SOURCE_DIR) / "../shared/data/hdri";
  if (!fs::exists(folder)) GTEST_SKIP() << folder << " is not there";
  for (const char* name : {"city.exr", "interior.exr", "studio.exr", "sunset.exr"}) {
    Image image;
    image.file = folder / name;
    load_image(image);
    EXPECT_EQ(image.width, 2 * image.height) << name;  // lat-long
    EXPECT_EQ(image.rgb.size(), static_cast<std::size_t>(image.width * image.height) * 3);
    EXPECT_THAT(image.rgb, Each(Ge(0.0f)));
    EXPECT_GT(*std::max_element(image.rgb.begin(), image.rgb.end()), 1.0f) << name;
  }
}

TEST(PixelHash, DoesNotSeeTheCompressionLevel) {
  Bytes samples(64 * 48 * 3);
  for (std::size_t i = 0; i < samples.size(); ++i)
    samples[i] = static_cast<unsigned char>(i * i / 7 & 255u);
  const auto encoded = [&](int level) {
    const std::string text = png_file(64, 48, 8, 2, samples, level);
    const auto bytes = bytes_of(text);
    return std::vector<std::byte>(bytes.begin(), bytes.end());
  };
  EXPECT_NE(encoded(1), encoded(9));
  EXPECT_EQ(pixel_hash(encoded(1), "a"), pixel_hash(encoded(9), "b"));
  BytePicture picture{64, 48, 3, {}};
  picture.pixels.assign(samples.begin(), samples.end());
  EXPECT_EQ(pixel_hash(encode_png(picture), "c"), pixel_hash(encoded(9), "b"));
}

}  // namespace
}  // namespace ds
