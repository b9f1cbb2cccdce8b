// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "manifests/gallery/gallery_data.h"

#include <string>

namespace ds {

/// page/gallery.html with its style sheet and scripts in it, as ci/embed_page.cmake joins them.
extern const char* const k_gallery_page[];

/// index.html: the page with the dataset's name and what those see who run no scripts.
std::string gallery_page(const GalleryFacts& facts);

}  // namespace ds
