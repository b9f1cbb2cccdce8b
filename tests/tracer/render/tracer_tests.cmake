ds_test(tracer_test
  SOURCES film_file_test.cc path_programs_test.cc pixel_filter_test.cc tracer_test.cc view_test.cc
  LIBS ds_test_pictures ds_render
  LABELS render)
