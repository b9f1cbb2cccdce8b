// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "builder/measure/accuracy.h"

#include <string>

namespace ds {

/// What stands on the charts' x axis.
enum class Against { both, spp, minutes };

/// The report as one HTML page that needs nothing else: no script, no request. `csv` is what
/// accuracy_csv gave and `csv_name` its file's name; the page holds it as a link too.
std::string accuracy_page(const Accuracy& accuracy, Against against, const std::string& csv,
                          const std::string& csv_name);

}  // namespace ds
