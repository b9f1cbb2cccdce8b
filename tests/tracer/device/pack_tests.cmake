ds_test(pack_test
  SOURCES effects_test.cc program_text_test.cc program_tokens_test.cc scene_pack_test.cc ties_test.cc
  LIBS ds_device ds_test_pictures)
