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
#include <cstdint>
#include <string>
#include <utility>
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

TEST_F(Meaning, RadiancesLinesRunAnyWay) {
  // Of "-Y 2 +X 3" the first word is what lines count and the second what pixels in a line do: +X is to
  // the right, +Y up (Radiance's file formats). Pixel k of the file has the grey k + 1.
  for (const std::string lines : {"-Y", "+Y", "-X", "+X"})
    for (const std::string pixels : {"-Y", "+Y", "-X", "+X"}) {
      if (lines[1] == pixels[1]) continue;
      const auto length = [](const std::string& axis) { return axis[1] == 'X' ? 3 : 2; };
      std::string file = fmt::format("#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n{} {} {} {}\n", lines,
                                     length(lines), pixels, length(pixels));
      for (int k = 0; k < 6; ++k) {
        const char mantissa = static_cast<char>(128 + 8 * k);
        file += {mantissa, mantissa, mantissa, static_cast<char>(136)};
      }
      const Image image = loaded(file, "a.hdr");
      ASSERT_EQ(image.width, 3) << lines << pixels;
      ASSERT_EQ(image.height, 2) << lines << pixels;
      for (int k = 0; k < 6; ++k) {
        int x = 0, y = 0;
        for (const auto& [axis, step] :
             {std::pair(lines, k / length(pixels)), std::pair(pixels, k % length(pixels))}) {
          if (axis[1] == 'X') x = axis[0] == '+' ? step : 2 - step;
          if (axis[1] == 'Y') y = axis[0] == '-' ? step : 1 - step;
        }
        EXPECT_NEAR(at(image, x, y), 128 + 8 * k, 1) << lines << pixels << k;
      }
    }
}

/// Little-endian TIFF of one strip; `entries` are tag, type, count and value or place.
std::string tiff(const std::vector<std::array<std::uint32_t, 4>>& entries,
                 const std::string& pixels) {
  std::string file = "II*";
  const auto put = [&](std::uint32_t value, int width) {
    for (int i = 0; i < width; ++i)
      file += static_cast<char>(value >> (8 * i));
  };
  file += '\0';
  put(8, 4);
  put(static_cast<std::uint32_t>(entries.size()), 2);
  for (const auto& [tag, type, count, value] : entries) {
    put(tag, 2);
    put(type, 2);
    put(count, 4);
    put(value, 4);
  }
  put(0, 4);
  file.resize(512, '\0');
  return file + pixels;
}

/// One row of two pixels of `samples` bytes each.
std::vector<std::array<std::uint32_t, 4>> tiff_entries(std::uint32_t samples,
                                                       std::uint32_t photometric) {
  return {{256, 3, 1, 2},       {257, 3, 1, 1},           {258, 3, 1, 8},
          {259, 3, 1, 1},       {262, 3, 1, photometric}, {273, 4, 1, 512},
          {277, 3, 1, samples}, {278, 3, 1, 1},           {279, 4, 1, 2 * samples}};
}

TEST_F(Meaning, ColoursThatATiffMultipliesByAlphaAreDivided) {
  auto entries = tiff_entries(2, 1);  // grey and alpha
  entries.push_back({338, 3, 1, 1});  // associated: TIFF 6.0, ExtraSamples
  const std::string pixels = {60, static_cast<char>(120), 60, static_cast<char>(240)};
  const Image associated = loaded(tiff(entries, pixels), "a.tif");
  EXPECT_FLOAT_EQ(at(associated, 0, 0), 0.5f);
  EXPECT_FLOAT_EQ(at(associated, 1, 0), 0.25f);
  entries.back()[3] = 2;  // unassociated
  const Image straight = loaded(tiff(entries, pixels), "b.tif");
  EXPECT_FLOAT_EQ(at(straight, 0, 0), 60 / 255.0f);
  EXPECT_FLOAT_EQ(at(straight, 1, 0), 60 / 255.0f);
}

TEST_F(Meaning, WhatATiffFileLacksOrMeansIsNamed) {
  const std::string pixels = {10, 20, 30, 40, 50, 60};
  EXPECT_NEAR(at(loaded(tiff(tiff_entries(3, 2), pixels), "a.tif"), 1, 0), 40 / 255.0f, 1e-6f);
  auto without_bits = tiff_entries(3, 2);
  without_bits.erase(without_bits.begin() + 2);
  EXPECT_THAT(error_of(tiff(without_bits, pixels), "a.tif"), HasSubstr("states no bits a sample"));
  EXPECT_THAT(error_of(tiff(tiff_entries(3, 2), pixels.substr(1)), "a.tif"),
              HasSubstr("the TIFF file is cut off: pixels at byte 512 to 518 of 517"));
  EXPECT_THAT(error_of(tiff(tiff_entries(3, 32845), pixels), "a.tif"), HasSubstr("LogLuv"));
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
  const std::string pair =
      "\x80\x80\x80\x81\x01\x01\x01\x01";  // of two pixels each: as many as there are
  EXPECT_THAT(error_of(old.substr(0, old.size() - 4) + pair + pair, "a.hdr"),
              HasSubstr("old run-length"));
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
