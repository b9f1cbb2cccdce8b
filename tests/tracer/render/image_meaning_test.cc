// SPDX-License-Identifier: Apache-2.0
// What files say of their pixels, and what damaged ones promise.
#include "tracer/render/image_meaning.h"

#include "tests/tracer/render/exr_file.h"
#include "tracer/base/error.h"
#include "tracer/base/files.h"
#include "tracer/render/images.h"

#include <OpenImageIO/imageio.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <string>
#include <vector>

namespace ds {
namespace {

using samples::exr_attribute;
using samples::ExrFile;
using testing::Each;
using testing::FloatNear;
using testing::HasSubstr;
using testing::Not;

class Meaning : public testing::Test {
 protected:
  Image image_of(const std::string& content, const std::string& name = "a.exr",
                 ImageUse use = ImageUse::texture) const {
    Image image;
    image.file = folder_.path() / name;
    image.gamma = 1;
    image.use = use;
    write_file_atomic(image.file, content);
    return image;
  }
  Image loaded(const std::string& content, const std::string& name = "a.exr",
               ImageUse use = ImageUse::texture) const {
    Image image = image_of(content, name, use);
    load_image(image);
    return image;
  }
  std::string error_of(const std::string& content, const std::string& name = "a.exr",
                       ImageUse use = ImageUse::texture) const {
    Image image = image_of(content, name, use);
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

  TemporaryFolder folder_;
};

float at(const Image& image, int x, int y, int channel = 0) {
  return image.rgb[static_cast<std::size_t>((y * image.width + x) * 3 + channel)];
}

TEST_F(Meaning, TheDisplayWindowIsThePicture) {
  ExrFile part;
  part.display = {10, 20, 13, 23};
  part.data = {11, 21, 12, 21};
  part.value = [](const std::string&, int x, int) { return static_cast<float>(x); };
  const Image image = loaded(part.bytes());
  ASSERT_EQ(image.width, 4);
  ASSERT_EQ(image.height, 4);
  for (int y = 0; y < 4; ++y)
    for (int x = 0; x < 4; ++x)
      EXPECT_EQ(at(image, x, y), y == 1 && (x == 1 || x == 2) ? static_cast<float>(10 + x) : 0.0f);
}

TEST_F(Meaning, WhatIsStoredAroundThePictureIsCutOff) {
  ExrFile overscan;
  overscan.display = {0, 0, 1, 0};
  overscan.data = {-2, -1, 4, 3};
  overscan.value = [](const std::string&, int x, int y) {
    return static_cast<float>(100 + x + 10 * y);
  };
  const Image image = loaded(overscan.bytes());
  ASSERT_EQ(image.width, 2);
  ASSERT_EQ(image.height, 1);
  EXPECT_EQ(at(image, 0, 0), 100);
  EXPECT_EQ(at(image, 1, 0), 101);
}

TEST_F(Meaning, ColoursOfAnExrAreMultipliedByAlpha) {
  ExrFile file;
  file.channels = {"A", "B", "G", "R"};
  file.value = [](const std::string& channel, int x, int) {
    return channel == "A" ? (x == 0 ? 0.0f : 0.5f) : 0.25f;
  };
  const Image texture = loaded(file.bytes());
  EXPECT_EQ(at(texture, 0, 0), 0.25f);  // light without a surface
  EXPECT_EQ(at(texture, 1, 0), 0.5f);
  EXPECT_EQ(at(loaded(file.bytes(), "a.exr", ImageUse::light), 1, 0), 0.25f);
}

std::string chromaticities(const std::array<float, 8>& values) {
  std::string value;
  for (const float x : values)
    samples::put_little(value, x);
  return exr_attribute("chromaticities", "chromaticities", value);
}

TEST(ToRec709, AgreesWithPublishedMatrices) {
  // ITU-R BT.2087, and ACEScg's as the Academy's transforms have it (Bradford, D60 to D65).
  const ColorMatrix rec2020{1.6605,  -0.5876, -0.0728, -0.1246, 1.1329,
                            -0.0083, -0.0182, -0.1006, 1.1187};
  const ColorMatrix aces_cg{1.70505,  -0.62179, -0.08326, -0.13026, 1.14080,
                            -0.01055, -0.02400, -0.12897, 1.15297};
  const auto found2020 = to_rec709({0.708, 0.292, 0.170, 0.797, 0.131, 0.046, 0.3127, 0.3290});
  const auto found_cg = to_rec709({0.713, 0.293, 0.165, 0.830, 0.128, 0.044, 0.32168, 0.33767});
  ASSERT_TRUE(found2020 && found_cg);
  for (std::size_t i = 0; i < 9; ++i) {
    EXPECT_NEAR((*found2020)[i], rec2020[i], 1e-4) << i;
    EXPECT_NEAR((*found_cg)[i], aces_cg[i], 1e-4) << i;
  }
  EXPECT_FALSE(to_rec709({0.64, 0.33, 0.30, 0.60, 0.15, 0.06, 0.3127, 0.329}));
  EXPECT_FALSE(to_rec709({0.1, 0.1, 0.2, 0.2, 0.3, 0.3, 0.3127, 0.329}));
  EXPECT_FALSE(to_rec709({0.64, 0.33, 0.30, 0.60, 0.15, 0.06, 0.3, 0}));
}

TEST_F(Meaning, ChromaticitiesAreConverted) {
  ExrFile file;
  file.more = chromaticities({0.708f, 0.292f, 0.170f, 0.797f, 0.131f, 0.046f, 0.3127f, 0.329f});
  file.value = [](const std::string& channel, int, int) { return channel == "R" ? 0.5f : 0.25f; };
  const Image image = loaded(file.bytes());
  EXPECT_THAT(at(image, 0, 0, 0), FloatNear(0.25f + 0.25f * 1.6605f, 1e-4f));
  EXPECT_THAT(at(image, 0, 0, 1), FloatNear(0.25f - 0.25f * 0.1246f, 1e-4f));
  EXPECT_THAT(at(image, 0, 0, 2), FloatNear(0.25f - 0.25f * 0.0182f, 1e-4f));
  file.more = chromaticities({0, 0, 0, 0, 0, 0, 0, 0});
  EXPECT_THAT(error_of(file.bytes()), HasSubstr("span no colours"));
}

TEST_F(Meaning, RadiancePrimariesAreConverted) {
  const std::string pixel("\x80\x80\x80\x81", 4);
  const std::string head = "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n";
  const Image plain = loaded(head + "\n-Y 1 +X 1\n" + pixel, "a.hdr");
  EXPECT_EQ(at(plain, 0, 0), 1.0f);
  const std::string red("\x80\0\0\x81", 4);
  const Image wide = loaded(
      head + "PRIMARIES= .708 .292 .170 .797 .131 .046 .3127 .329\n\n-Y 1 +X 1\n" + red, "a.hdr");
  EXPECT_THAT(at(wide, 0, 0), FloatNear(1.6605f, 1e-4f));
  EXPECT_THAT(error_of("#?RADIANCE\nFORMAT=32-bit_rle_xyze\n\n-Y 1 +X 1\n" + pixel, "a.hdr"),
              HasSubstr("found XYZ"));
}

TEST_F(Meaning, RadianceScalesThatNobodyAppliesAreSaid) {
  const std::string pixel("\x80\x80\x80\x81", 4);
  const std::string head = "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n";
  testing::internal::CaptureStderr();
  EXPECT_EQ(
      at(loaded(head + "EXPOSURE=10\nCOLORCORR= 1 2 1\n\n-Y 1 +X 1\n" + pixel, "a.hdr"), 0, 0),
      1.0f);
  EXPECT_THAT(testing::internal::GetCapturedStderr(),
              HasSubstr("header lines EXPOSURE=10, header lines COLORCORR= 1 2 1 are not used"));
  testing::internal::CaptureStderr();
  loaded(head + "EXPOSURE=1.000\nCOLORCORR=1 1 1\n\n-Y 1 +X 1\n" + pixel, "b.hdr");
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
}

TEST_F(Meaning, AFirstPartWithoutColoursIsNoPicture) {
  // Two parts of 2 x 1 pixels: "depth" with Z = 0.9, then "beauty" with R = G = B = 0.4.
  const std::string file = read_text_file(std::filesystem::path(DS_SOURCE_DIR) /
                                          "tests/fuzz/corpus/image/two_parts.exr");
  EXPECT_THAT(error_of(file), HasSubstr("in its first part, found Z"));
}

TEST_F(Meaning, ChannelsAreUsedByTheirNamesOrRefused) {
  ExrFile file;
  file.value = [](const std::string& channel, int, int) {
    return channel.ends_with('R') || channel == "Y" || channel == "V" ? 0.5f
           : channel == "A"                                           ? 1.0f
                                                                      : 0.25f;
  };
  const auto with = [&](std::vector<std::string> channels) {
    file.channels = std::move(channels);
    return file.bytes();
  };
  for (const auto& channels : {std::vector<std::string>{"Y"},
                               {"A", "Y"},
                               {"V"},
                               {"B", "G", "R"},
                               {"A", "B", "G", "R"},
                               {"v.B", "v.G", "v.R"}}) {
    const Image image = loaded(with(channels));
    EXPECT_EQ(at(image, 0, 0, 0), 0.5f);
    EXPECT_EQ(at(image, 0, 0, 1), channels.size() < 3 ? 0.5f : 0.25f);
  }
  for (const auto& channels : {std::vector<std::string>{"G", "R"},
                               {"A", "Z"},
                               {"A", "G", "R"},
                               {"BY", "RY", "Y"},
                               {"X", "Z"},
                               {"R"},
                               {"d.B", "d.G", "s.R"}})
    EXPECT_THAT(error_of(with(channels)), HasSubstr(channels.back()));
  EXPECT_THAT(error_of(with({"A"})), HasSubstr("found alpha alone"));
  for (const char* depth : {"Z", "ZBack", "view.Z"})
    EXPECT_THAT(error_of(with({depth})),
                HasSubstr(std::string("found the depth channel ") + depth + " alone"));
  testing::internal::CaptureStderr();
  EXPECT_EQ(at(loaded(with({"A", "B", "G", "R", "Z"})), 0, 0), 0.5f);
  EXPECT_THAT(testing::internal::GetCapturedStderr(), HasSubstr("1 of 5 channels are not used"));
  file.sampling = 2;
  EXPECT_THAT(error_of(with({"BY", "RY", "Y"})), HasSubstr("luminance and chroma"));
}

TEST_F(Meaning, ACubeIsNoLight) {
  ExrFile file;
  file.more = exr_attribute("envmap", "envmap", std::string(1, '\1'));
  EXPECT_EQ(loaded(file.bytes()).width, 4);
  EXPECT_THAT(error_of(file.bytes(), "a.exr", ImageUse::light), HasSubstr("faces of a cube"));
}

TEST_F(Meaning, APictureOfWhichNothingIsStoredIsSaid) {
  ExrFile outside;
  outside.display = {0, 0, 3, 3};
  outside.data = {4, 0, 7, 3};
  for (const ImageUse use : {ImageUse::light, ImageUse::texture}) {
    const std::string name = use == ImageUse::light ? "light.exr" : "texture.exr";
    testing::internal::CaptureStderr();
    EXPECT_THAT(loaded(outside.bytes(), name, use).rgb, Each(0.0f));
    EXPECT_THAT(testing::internal::GetCapturedStderr(),
                testing::EndsWith(name + ": its data window lies wholly outside of its display "
                                         "window, which is the picture: it is black throughout\n"));
  }
}

TEST_F(Meaning, ABlackLightIsSaid) {
  ExrFile file;
  file.value = [](const std::string&, int, int) { return 0.0f; };
  testing::internal::CaptureStderr();
  loaded(file.bytes(), "dark.exr", ImageUse::light);
  loaded(file.bytes(), "texture.exr");
  const std::string said = testing::internal::GetCapturedStderr();
  EXPECT_THAT(said, HasSubstr("dark.exr: all 16 pixels are black"));
  EXPECT_THAT(said, testing::Not(HasSubstr("texture.exr")));
}

/// A picture whose first stored row is white at its start, grey at its end.
std::string jpeg(int orientation) {
  constexpr int k_width = 32, k_height = 16;
  std::vector<unsigned char> pixels(std::size_t{k_width} * k_height * 3, 0);
  for (int y = 0; y < 8; ++y)
    for (int x = 0; x < k_width; ++x)
      std::fill_n(pixels.begin() + (y * k_width + x) * 3, 3,
                  static_cast<unsigned char>(x < 8     ? 255
                                             : x >= 24 ? 128
                                                       : 0));
  OIIO::ImageSpec spec(k_width, k_height, 3, OIIO::TypeDesc::UINT8);
  spec.attribute("Orientation", orientation);
  spec.attribute("CompressionQuality", 100);
  const TemporaryFolder folder;
  const std::string file = (folder.path() / "a.jpg").string();
  const auto output = OIIO::ImageOutput::create(file);
  EXPECT_TRUE(output && output->open(file, spec) &&
              output->write_image(OIIO::TypeDesc::UINT8, pixels.data()) && output->close());
  return read_text_file(file);
}

TEST_F(Meaning, OrientationTurnsThePicture) {
  // Exif 2.3, tag 274: the sides of the picture that row 0 and column 0 are, from which where the
  // first row starts and ends: 0 top left, 1 top right, 2 bottom right, 3 bottom left.
  const int start[] = {0, 1, 2, 3, 0, 1, 2, 3}, end[] = {1, 0, 3, 2, 3, 2, 1, 0};
  for (int orientation = 1; orientation <= 8; ++orientation) {
    const Image image = loaded(jpeg(orientation), "a.jpg");
    EXPECT_EQ(image.width, orientation < 5 ? 32 : 16);
    EXPECT_EQ(image.height, orientation < 5 ? 16 : 32);
    const int right = image.width - 1, bottom = image.height - 1;
    const float corners[] = {at(image, 0, 0), at(image, right, 0), at(image, right, bottom),
                             at(image, 0, bottom)};
    EXPECT_NEAR(corners[start[orientation - 1]], 1.0f, 0.02f) << orientation;
    EXPECT_NEAR(corners[end[orientation - 1]], 0.5f, 0.02f) << orientation;
  }
}

TEST_F(Meaning, ACutJpegIsAnError) {
  const std::string whole = jpeg(1);
  EXPECT_THAT(error_of(whole.substr(0, whole.size() / 2), "a.jpg"), HasSubstr("cut off"));
  EXPECT_THAT(error_of(whole.substr(0, whole.size() - 2), "a.jpg"), HasSubstr("cut off"));
}

TEST_F(Meaning, RadiancesOldRunsAreNamed) {
  // Old runs: 1 1 1 3 repeats the pixel before. As pixels that stand as they are there would be four.
  const std::string old = "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 2 +X 2\n\x80\x80\x80\x81";
  EXPECT_THAT(error_of(old + "\x01\x01\x01\x03", "a.hdr"),
              HasSubstr("a.hdr: its pixels are in Radiance's old run-length encoding"));
  EXPECT_THAT(error_of(old, "a.hdr"), Not(HasSubstr("old run-length"))) << "cut off";
  loaded(old + "\x01\x01\x01\x03\x80\x80\x80\x81\x80\x80\x80\x81", "whole.hdr");
}

TEST_F(Meaning, PromisesAreSetAgainstTheFile) {
  EXPECT_THAT(error_of("#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 4 +X 8888888\n", "a.hdr"),
              HasSubstr("8888888 x 4"));
  ExrFile file;
  const auto promise = [&](ExrBox data, ExrBox display) {
    ExrFile huge = file;
    huge.data = data;
    huge.display = display;
    return huge.head() + std::string(64, '\0');
  };
  const ExrBox small{0, 0, 3, 3}, wide{0, 0, 1 << 26, 15}, far{0, 0, (1 << 30) + 1, 3};
  EXPECT_THAT(error_of(promise(wide, small)), HasSubstr("promises 67108865 x 16 pixels"));
  EXPECT_THAT(error_of(promise(small, wide)), HasSubstr("promises 67108865 x 16 pixels"));
  EXPECT_THAT(error_of(promise(small, far)), HasSubstr("a window reaches to 1073741825"));
  EXPECT_THAT(error_of(promise({0, 0, 3, -1}, small)), HasSubstr("a window of 4 x 0"));
  EXPECT_THAT(error_of(promise({0, 0, 3, 100}, small)), HasSubstr("promises 101 chunks"));
  // 256 rows of a chunk, for a picture of one.
  file.compression = 9;
  EXPECT_THAT(error_of(promise({0, 0, 1 << 20, 0}, small)), HasSubstr("1048577 x 256 pixels"));
  file.compression = 0;
  file.more = exr_attribute("note", "string", "hello");
  std::string longer = file.bytes();
  longer[longer.find("hello") - 1] = '\x7f';
  EXPECT_THAT(error_of(longer), HasSubstr("attribute note promises"));
  file.more = exr_attribute("preview", "preview", std::string("\xff\xff\0\0\xff\xff\0\0", 8));
  EXPECT_THAT(error_of(file.bytes()), HasSubstr("a preview of 65535 x 65535"));
}

TEST_F(Meaning, EveryChunkIsWhereItShouldBe) {
  const ExrFile file;
  const std::string whole = file.bytes();
  EXPECT_EQ(loaded(whole).width, 4);
  const std::size_t table = file.head().size();
  std::string changed = whole;
  changed[table + 8] = '\0';
  changed[table + 9] = '\0';
  EXPECT_THAT(error_of(changed), HasSubstr("the chunk at 1 is not there"));
  changed = whole;
  changed[table + 8] = changed[table];
  changed[table + 9] = changed[table + 1];
  EXPECT_THAT(error_of(changed), HasSubstr("the chunk at 1 is another"));
  changed = whole;
  changed[table + 32 + 4] = 1;  // of its 48 bytes
  EXPECT_THAT(error_of(changed), HasSubstr("the chunk at 0 holds 1 bytes of 48"));
  for (std::size_t size = 0; size < whole.size(); ++size)
    EXPECT_THROW(decode_image_bytes(bytes_of(whole.substr(0, size)), "a.exr", Halves::widen), Error)
        << size;
}

TEST_F(Meaning, EveryChangedByteIsReadOrRefused) {
  const std::string whole = ExrFile().bytes();
  for (std::size_t i = 0; i < whole.size(); ++i)
    for (const char c : {'\x00', '\x01', '\x7f', '\x80', '\xff'}) {
      std::string changed = whole;
      changed[i] = c;
      try {
        const DecodedImage decoded = decode_image_bytes(bytes_of(changed), "a.exr", Halves::widen);
        image_meaning(bytes_of(changed), decoded, "a.exr");
      } catch (const Error& error) {
        EXPECT_EQ(error.kind(), ErrorKind::asset);
      }
    }
}

}  // namespace
}  // namespace ds
