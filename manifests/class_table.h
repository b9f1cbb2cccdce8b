// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "manifests/classification.h"

#include <string>
#include <string_view>
#include <vector>

namespace ds {

/// A table of models and their classes, as comma-separated values (RFC 4180: fields may be in double
/// quotes, which are doubled inside them; lines end with LF, CRLF or CR):
///
///   file   = header {row}
///   header = the names of the columns: "name" and "class", and "split" where there is one; in any order
///   name   = what a class file may call a model: file name, stem, number, path (Labels)
///   class  = from the root down, with "/" between: "vehicle/car"; empty: none
///   split  = "train", "val", "test", what split_named takes for one of them, or empty
///
/// Further columns are not read, nor are empty lines. Throws Error(asset), all findings with file:line: a
/// column missing or there twice, a row of another length, a name that is empty or stands twice, a class
/// with an empty part, one of 0 . .. or with a control character, another split, a quote that is not closed.
/// Blanks around a class's parts are none of it.
std::vector<LabelledModel> parse_class_table(std::string_view text, const std::string& name);

/// A class path without the blanks (spaces and tabs) around its parts, which lists of classes a line do not
/// hold and nobody sees.
std::string trimmed_class(std::string_view path);

}  // namespace ds
