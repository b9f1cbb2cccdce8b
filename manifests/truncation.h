// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "manifests/manifest.h"

#include <functional>
#include <optional>

namespace ds {

/// `beyond` and `whole`: of the pixels that would show the model where nothing stands before it, on a
/// picture that goes on past its frame without end, those outside the frame, and all. A pixel shows what
/// lies at its centre. `beyond` alone, 0, where the box around the model is inside the frame already: then
/// `mesh` is not called, which gives the model in its file's coordinates. Both 0 where some of the model is
/// beside or behind the camera, whose picture has no end, and where it is too small for any pixel.
///
/// A silhouette far larger than its picture is counted on every k-th pixel of every k-th row (k such that
/// about 16 million are looked at), each for k * k. Nothing for an image without a pose. Double precision,
/// + - * / only: the same everywhere.
std::optional<PixelCounts> count_beyond(const ImageRecord& image,
                                        const std::function<const FileMesh&()>& mesh);
/// The same of another thing that the image shows, by its pose.
PixelCounts count_beyond(const ImageRecord& image, const ModelPose& pose,
                         const std::function<const FileMesh&()>& mesh);

}  // namespace ds
