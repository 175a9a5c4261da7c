# Experiments need Eigen for small dense eigenproblems and least squares.
find_package(Eigen3 3.4 REQUIRED NO_MODULE)
target_link_libraries(loopwright_experiments PRIVATE $<BUILD_INTERFACE:Eigen3::Eigen>)
