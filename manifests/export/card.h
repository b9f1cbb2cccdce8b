// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "manifests/export/exporter.h"

namespace ds {

/// Adds README.md, the data card (with the front matter of Hugging Face's hub: what, how many, under
/// which licence), and LICENSES/, each licence's text once.
/// `lines` is Exporter::card_lines.
void write_card(const ExportInput& input, const ExporterType& type, const std::string& lines,
                ExportFolder& to);

}  // namespace ds
