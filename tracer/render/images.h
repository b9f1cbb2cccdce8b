// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "tracer/scene/scene.h"

namespace ds {

/// Fills width, height and rgb of the image from its file; one with no file name or with pixels is
/// left as it is.
///
/// 8- and 16-bit files: linear = (stored / greatest)^gamma * gain. Files of floats (EXR, Radiance
/// HDR): stored * gain. Then the channel: `rgb` repeats a grey image's one channel; `red`, `green`,
/// `blue` and `alpha` (linear, no gamma) repeat that channel; `mean` is (r + g + b) / 3;
/// `colored_mean` is Rec.709 luminance as LuxCore weighs it (0.212671, 0.715160, 0.072169). Colours
/// are not multiplied by alpha: EXR files, which store them so, are divided by it for a texture.
/// What the file says of windows, primaries, channels and which way up it is: image_meaning.h. The
/// same bits on every machine for the same decoded file.
///
/// Warnings: negative values, which resampling leaves in HDR images, become 0, and are counted;
/// channels and parts that nothing reads; a light's image that is black throughout; one of whose
/// picture nothing is stored. Throws
/// Error(asset) for a file that is missing, is no image, is cut off, promises more pixels than a
/// file of its size can hold or over 2^28, has channels that make no picture, has another hash than
/// `content` (unless that is zero), lacks the channel asked for, is called as files of floats are and holds none, is a cube map for a light, or
/// holds a NaN or an infinity, which is named by its place.
void load_image(Image& image);

/// Loads every image of the scene.
void load_images(Scene& scene);

}  // namespace ds
