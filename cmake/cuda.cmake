# BLUM_CUDA: the CUDA module, a shared library that is loaded when a CUDA device is first asked for. Everything else
# builds and runs without it.
set(BLUM_CUDA "AUTO" CACHE STRING "Build the CUDA module: AUTO (where a CUDA compiler is found), ON or OFF")
set_property(CACHE BLUM_CUDA PROPERTY STRINGS AUTO ON OFF)
if(NOT BLUM_CUDA MATCHES "^(AUTO|ON|OFF)$")
  message(FATAL_ERROR "BLUM_CUDA is \"${BLUM_CUDA}\"; it must be AUTO, ON or OFF")
endif()

set(BLUM_HAS_CUDA OFF)
if(NOT BLUM_CUDA STREQUAL "OFF")
  include(CheckLanguage)
  if(NOT CMAKE_CUDA_COMPILER)
    unset(CMAKE_CUDA_COMPILER CACHE)  # what an earlier run did not find may be there now
  endif()
  check_language(CUDA)
  if(CMAKE_CUDA_COMPILER)
    if(NOT DEFINED CMAKE_CUDA_ARCHITECTURES)
      set(CMAKE_CUDA_ARCHITECTURES 80-real 90)  # and PTX of the last, for what comes after it
    endif()
    # CMake 3.25 does not know how to ask nvcc for C++20.
    set(CMAKE_CUDA20_STANDARD_COMPILE_OPTION "-std=c++20")
    set(CMAKE_CUDA20_EXTENSION_COMPILE_OPTION "-std=c++20")
    enable_language(CUDA)
    set(BLUM_HAS_CUDA ON)
  elseif(BLUM_CUDA STREQUAL "ON")
    message(FATAL_ERROR "BLUM_CUDA is ON, but no CUDA compiler was found: name nvcc in CUDACXX (tools/cuda.sh takes one from PyPI), or set BLUM_CUDA=OFF")
  endif()
endif()
message(STATUS "CUDA module: ${BLUM_HAS_CUDA}")

# blum_set_cuda(TARGET): what every target with .cu files needs.
function(blum_set_cuda target)
  target_include_directories(${target} PRIVATE ${PROJECT_SOURCE_DIR}/include ${PROJECT_SOURCE_DIR}/src)
  # A toolkit from PyPI keeps CUB and Thrust where nvcc does not look.
  foreach(folder IN LISTS CMAKE_CUDA_TOOLKIT_INCLUDE_DIRECTORIES)
    if(EXISTS ${folder}/cccl)
      target_include_directories(${target} SYSTEM PRIVATE ${folder}/cccl)
    endif()
  endforeach()
  target_compile_options(${target} PRIVATE $<$<COMPILE_LANGUAGE:CUDA>:--expt-relaxed-constexpr
                                           $<$<BOOL:${BLUM_WERROR}>:-Werror=all-warnings>>)
  set_target_properties(${target} PROPERTIES CUDA_STANDARD 20 CUDA_STANDARD_REQUIRED ON CUDA_EXTENSIONS OFF
                                             CUDA_RUNTIME_LIBRARY Static)
endfunction()

# blum_add_cuda_module(): target blum_cuda, libblum_cuda.so beside the programs.
function(blum_add_cuda_module)
  file(GLOB sources CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/src/field/cuda/*.cu)
  add_library(blum_cuda MODULE ${sources})
  blum_set_cuda(blum_cuda)
  set_target_properties(blum_cuda PROPERTIES
    CUDA_VISIBILITY_PRESET hidden CXX_VISIBILITY_PRESET hidden VISIBILITY_INLINES_HIDDEN ON
    LIBRARY_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR}/bin)
endfunction()

# The programs of bench/gpu: they need a compiler and CUDA, and nothing else.
function(blum_add_gpu_programs)
  foreach(name check_gpu time_gpu)
    add_executable(${name} ${PROJECT_SOURCE_DIR}/bench/gpu/${name}.cu ${PROJECT_SOURCE_DIR}/src/field/image_request.cpp)
    blum_set_cuda(${name})
    target_include_directories(${name} PRIVATE ${PROJECT_SOURCE_DIR}/bench)
    target_link_libraries(${name} PRIVATE blum_field_reference blum_shapes blum_geometry blum_grid blum_core)
  endforeach()
endfunction()
