// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "builder/measure/accuracy.h"

#include <string>

namespace ds {

/// Every number of the report, one a line (RFC 4180, UTF-8, "\n", a line of names first). Columns:
///   section      "ladder", "fit", "target", "geometry", "choice", "reference"
///   environment, material, image
///   name         of the choice ("path depth 4"), of the fit's number ("slope"), else empty
///   metric       metric_name, "estimate", "seconds", "mask_rms", "bias", ...
///   spp          samples (geometry: rays) a pixel, or empty
///   seconds      of one picture at that spp, or empty
///   value, low, high    low and high are 95 % bounds of errors, the range of times; or empty:
///                       no bound is known on that side
/// Numbers have as many digits as they need; what could not be told has no line.
std::string accuracy_csv(const Accuracy& accuracy);

/// "data:text/csv;charset=utf-8;base64,...": the text as a link that holds it.
std::string csv_link(const std::string& csv);

/// RFC 4648, with padding.
std::string base64(const std::string& bytes);

}  // namespace ds
