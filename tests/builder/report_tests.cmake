ds_test(report_test
  SOURCES report_accuracy_test.cc report_choices_test.cc report_errors_test.cc report_fit_test.cc report_forecast_test.cc
          report_geometry_test.cc report_page_test.cc
  LIBS ds_report ds_test_pictures)
