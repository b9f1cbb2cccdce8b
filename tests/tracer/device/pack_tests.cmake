ds_test(pack_test
  SOURCES program_text_test.cc scene_pack_test.cc
  LIBS ds_device ds_test_pictures)
