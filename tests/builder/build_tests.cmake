ds_test(db_test
  SOURCES db_database_test.cc db_sqlite_test.cc stamps_ahead_test.cc
  LIBS ds_db)
target_link_libraries(db_test PRIVATE PkgConfig::SQLITE)
ds_test(build_test
  SOURCES build_faults_test.cc build_test.cc hash_index_test.cc keys_test.cc limits_test.cc plan_test.cc shard_test.cc store_test.cc store_database_test.cc build_texts_test.cc text_form_test.cc build_verify_test.cc manifest_state_test.cc nothing_to_do_test.cc
  LIBS ds_build)
ds_test(cmd_test
  SOURCES stop_signal_test.cc
  LIBS ds_cmd)
ds_test(concerns_test
  SOURCES dataset_concerns_test.cc
  LIBS ds_build)
