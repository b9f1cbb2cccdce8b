ds_test(tracer_test
  SOURCES tracer_test.cc view_test.cc
  LIBS ds_test_pictures ds_render
  LABELS render)
