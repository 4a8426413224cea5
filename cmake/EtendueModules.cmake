# The kernels: one source, one module for each instruction set. Everything in a module but its entry is hidden,
# so that no inline function compiled for AVX-512 can be picked by the linker for the rest of the program.
# etendue_add_modules(NAME SOURCE): for each of ETENDUE_ISAS NAME_scalar, NAME_v2 ... as lib/libetendue_NAME_LEVEL.so, and target NAME.
function(etendue_add_modules name source)
  set(flags_scalar -DETENDUE_SCALAR_LANES)
  set(flags_v2 -march=x86-64-v2)
  # GCC copies aggregates of batches in halves unless told not to, and the whole load that follows then stalls.
  set(flags_v3 -march=x86-64-v3 $<$<CXX_COMPILER_ID:GNU>:-mmove-max=256;-mstore-max=256>)
  set(flags_v4 -march=x86-64-v4 $<$<CXX_COMPILER_ID:GNU>:-mmove-max=512;-mstore-max=512>)
  add_custom_target(etendue_${name})
  foreach(level IN LISTS ETENDUE_ISAS)
    set(target etendue_${name}_${level})
    add_library(${target} MODULE ${source})
    target_compile_options(${target} PRIVATE ${flags_${level}} -fno-math-errno -fno-trapping-math)
    target_compile_definitions(${target} PRIVATE ETENDUE_ISA_NAME="${level}")
    set_target_properties(${target} PROPERTIES CXX_VISIBILITY_PRESET hidden VISIBILITY_INLINES_HIDDEN ON
      BUILD_RPATH "$ORIGIN")
    target_link_libraries(${target} PRIVATE etendue_core)
    target_link_options(${target} PRIVATE
      "-Wl,--version-script=${CMAKE_SOURCE_DIR}/cmake/module_exports.map")
    set_property(TARGET ${target} APPEND PROPERTY LINK_DEPENDS ${CMAKE_SOURCE_DIR}/cmake/module_exports.map)
    add_dependencies(etendue_${name} ${target})
  endforeach()
endfunction()

# etendue_inline_stages(NAME): a kernel's stages are long chains of small functions on registers, and a call would spill
# them all. It costs compile time, so it is for what renders.
function(etendue_inline_stages name)
  if(CMAKE_BUILD_TYPE STREQUAL "Debug" OR ETENDUE_SANITIZE)
    return()
  endif()
  foreach(level IN LISTS ETENDUE_ISAS)
    target_compile_options(etendue_${name}_${level} PRIVATE -O3
      $<$<CXX_COMPILER_ID:GNU>:-finline-limit=100000;--param=inline-unit-growth=2000;--param=large-function-growth=10000;--param=max-inline-insns-auto=1000;--param=large-function-insns=100000;--param=large-stack-frame-growth=10000;--param=early-inlining-insns=1000;--param=max-inline-insns-single=2000>)
  endforeach()
endfunction()
