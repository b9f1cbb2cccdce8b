// SPDX-License-Identifier: Apache-2.0
#include "builder/recipe/class_keys.h"

#include <array>

namespace ds {
namespace {

constexpr KeyRange k_share{.least = 0, .most = 1};

using enum KeyType;
using enum Moves;

constexpr std::array k_class_keys = {
    KeySpec{"classes.train",
            manifest,
            path,
            "",
            "",
            {},
            "",
            "",
            "Class file (.cla) of the training models. {models.dir} in it stands for models.dir, "
            "and the key counts as unset where models.files is used instead"},
    KeySpec{"classes.test",
            manifest,
            path,
            "",
            "",
            {},
            "",
            "",
            "Class file of the test models, likewise"},
    KeySpec{"classes.from",
            manifest,
            path,
            "",
            "",
            {},
            "",
            "",
            "Where classes come from instead: \"folder\" (a model's class is the folder of "
            "models.dir it lies "
            "in) or \"folders\" (all folders down to it), or a file, .csv with columns name, "
            "class and split, or .cla: see Classes and splits"},
    KeySpec{
        "classes.more",
        manifest,
        path_list,
        "",
        "",
        {},
        "",
        "",
        "Further classifications, .cla or .csv files, whose classes stand beside the others' in "
        "the "
        "manifest and can be exported in their place. One is called as its files are, less Train "
        "or Test behind it: coarse1Train.cla and coarse1Test.cla are of coarse1"},
    KeySpec{
        "classes.ids",
        manifest,
        path,
        "",
        "",
        {},
        "",
        "",
        "Text file of class paths, one a line: a class's id is its place, from 0. Classes that it "
        "does "
        "not name come behind, sorted, as all do without it; so a class that is added at its end "
        "changes no other's id. dsbuild classes --ids prints one"},
    KeySpec{"classes.split_folders",
            manifest,
            boolean,
            "",
            "true",
            {},
            "",
            "",
            "With classes.from = \"folder\" or \"folders\": folders called {split names} tell the "
            "split "
            "and are no classes: train and test themselves wherever they are, the others where all "
            "folders beside them are called so. false: they are classes as any"},
    KeySpec{"classes.split.test", manifest, number, "", "", k_share, "", "",
            "Share of what split.by names to put into the test split, where nothing else says what "
            "is test. Without it, split.val and split.held_out there is no split"},
    KeySpec{
        "classes.split.val", manifest, number, "", "", k_share, "", "",
        "Share to put into the validation split, val: of all beside split.test, or else of what "
        "held_out or class files leave for training"},
    KeySpec{"classes.split.train", manifest, number, "", "", k_share, "", "",
            "What split.test and split.val leave, if it is to be written down: it must be that"},
    KeySpec{
        "classes.split.by",
        manifest,
        choice,
        "",
        "\"model\"",
        {},
        R"("model" | "class" | "material" | "environment" | "view")",
        "",
        "What is split: all images of a model (class, material, ...) stay together, chosen by a "
        "hash of dataset.seed and its name; of as many classes, materials, environments or views "
        "as there are splits, or more, one at least is in each"},
    KeySpec{"classes.split.stratified",
            manifest,
            boolean,
            "",
            "false",
            {},
            "",
            R"(classes.split.by = "model")",
            "Shares are of each class's models, rounded, at least one in each split where it has "
            "enough. Each fold of split.folds has as many of a class as any other, give or take "
            "one"},
    KeySpec{"classes.split.held_out",
            manifest,
            text_list,
            "",
            "",
            {},
            "",
            "",
            "Names of the models, classes, materials, environments or views (split.by) that are "
            "the test split, in place of a share; a class's are of those below it, too"},
    KeySpec{"classes.split.held_out_val",
            manifest,
            text_list,
            "",
            "",
            {},
            "",
            "",
            "Likewise of those that are the validation split"},
    KeySpec{"classes.split.folds",
            manifest,
            integer,
            "",
            "",
            {.least = 2, .most = 1000},
            "",
            "",
            "Cross-validation: each image that is not of the splits test and val gets a fold in "
            "the manifest, from 0 to one less, by a hash of what split.by names"},
    KeySpec{"classes.missing",
            manifest,
            choice,
            "",
            "\"ignore\"",
            {},
            R"("ignore" | "error")",
            "",
            "A model that a class file lists and that has no file: count it, or fail"},
    KeySpec{"classes.unlisted",
            images,
            choice,
            "",
            "\"keep\"",
            {},
            R"("keep" | "skip" | "error")",
            "",
            "A model file that no class file lists: build it with class and split \"\", leave it "
            "out, or fail"},
    KeySpec{
        "classes.unshared",
        manifest,
        choice,
        "",
        "\"keep\"",
        {},
        R"("keep" | "error")",
        "",
        "A class that has models in one of the two class files only, as where it was renamed in "
        "one: count it, or fail"},
};

}  // namespace

std::span<const KeySpec> class_keys() {
  return k_class_keys;
}

}  // namespace ds
