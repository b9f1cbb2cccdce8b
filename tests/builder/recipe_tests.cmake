ds_test(recipe_test
  SOURCES camera_sets_test.cc expand_test.cc recipe_classes_test.cc recipe_keys_test.cc recipe_read_test.cc
          recipe_value_test.cc
  LIBS ds_recipe)
ds_test(camera_fit_test
  SOURCES camera_fit_test.cc
  LIBS ds_recipe)
