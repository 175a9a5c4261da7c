# Dynamics needs Eigen for the sparse factorisation of constrained motion.
find_package(Eigen3 3.4 REQUIRED NO_MODULE)
target_link_libraries(loopwright_dynamics PRIVATE $<BUILD_INTERFACE:Eigen3::Eigen>)
