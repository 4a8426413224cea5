# What `cmake --install` puts where: a program that finds its libraries wherever the prefix is moved, and what others
# need to compile integrators of their own, found by find_package(etendue).
include(CMakePackageConfigHelpers)

set(modules etendue_plane_polygon)
foreach(level IN LISTS ETENDUE_ISAS)
  list(APPEND modules etendue_kernel_${level})
endforeach()
set_target_properties(etendue PROPERTIES INSTALL_RPATH "$ORIGIN/../lib")
set_target_properties(etendue_core ${modules} PROPERTIES INSTALL_RPATH "$ORIGIN")
install(TARGETS etendue RUNTIME DESTINATION bin)
install(TARGETS etendue_core ${modules} LIBRARY DESTINATION lib)

install(DIRECTORY include/etendue DESTINATION include)
install(DIRECTORY course DESTINATION share/etendue)
install(DIRECTORY scenes/ex3 DESTINATION share/etendue/scenes PATTERN "*.py" EXCLUDE)

install(TARGETS etendue_course EXPORT etendueTargets)
install(EXPORT etendueTargets NAMESPACE etendue:: DESTINATION lib/cmake/etendue)
file(WRITE ${CMAKE_BINARY_DIR}/etendueConfig.cmake
  "include(\${CMAKE_CURRENT_LIST_DIR}/etendueTargets.cmake)\n")
write_basic_package_version_file(${CMAKE_BINARY_DIR}/etendueConfigVersion.cmake COMPATIBILITY SameMinorVersion
  ARCH_INDEPENDENT)
install(FILES ${CMAKE_BINARY_DIR}/etendueConfig.cmake ${CMAKE_BINARY_DIR}/etendueConfigVersion.cmake
  DESTINATION lib/cmake/etendue)
