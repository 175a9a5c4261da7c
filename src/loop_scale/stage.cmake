find_package(Eigen3 3.4 REQUIRED NO_MODULE)
target_link_libraries(loopwright_loop_scale PRIVATE $<BUILD_INTERFACE:Eigen3::Eigen>)
