# Installs the build into a fresh prefix, then builds and runs the programs of CONSUMER and copies of the projects of STARTER
# against it: through find_package, and with make and pkg-config.
include(${CMAKE_CURRENT_LIST_DIR}/must.cmake)

file(REMOVE_RECURSE ${WORK})
# Sanitized libraries need the compiler that sanitized them.
set(ENV{CC} ${CC})
set(ENV{CXX} ${CXX})
must(${CMAKE_COMMAND} --install ${BUILD} --prefix ${WORK}/prefix)
must(${CMAKE_COMMAND} -S ${CONSUMER} -B ${WORK}/consumer -DCMAKE_PREFIX_PATH=${WORK}/prefix
     "-DCMAKE_C_FLAGS=${SANITIZER_FLAGS}" "-DCMAKE_CXX_FLAGS=${SANITIZER_FLAGS}")
must(${CMAKE_COMMAND} --build ${WORK}/consumer)
must(${WORK}/consumer/consumer)
must(${WORK}/consumer/consumer_cpp)

# The prefix was given at installation: the files must find it by themselves.
file(GLOB_RECURSE pc_files ${WORK}/prefix/vernier.pc)
list(GET pc_files 0 pc_file)
get_filename_component(pc_dir ${pc_file} DIRECTORY)
set(ENV{PKG_CONFIG_PATH} ${pc_dir})
set(ENV{CFLAGS} "${SANITIZER_FLAGS}")
set(ENV{CXXFLAGS} "${SANITIZER_FLAGS}")
file(MAKE_DIRECTORY ${WORK}/make)
must(make -C ${WORK}/make -f ${CONSUMER}/Makefile SOURCE=${CONSUMER})
must(${WORK}/make/consumer_c)
must(${WORK}/make/consumer_cpp)

# The starters are copied, as their users do; both ways of building give a picture, and the same one.
foreach(language c cpp)
    file(COPY ${STARTER}/${language} DESTINATION ${WORK}/starter)
    set(project ${WORK}/starter/${language})
    must(${CMAKE_COMMAND} -S ${project} -B ${project}/build -DCMAKE_PREFIX_PATH=${WORK}/prefix
         "-DCMAKE_C_FLAGS=${SANITIZER_FLAGS}" "-DCMAKE_CXX_FLAGS=${SANITIZER_FLAGS}")
    must(${CMAKE_COMMAND} --build ${project}/build)
    must(${project}/build/starter ${project}/cmake.ppm)
    must(make -C ${project})
    must(${project}/starter ${project}/make.ppm)
    must(${CMAKE_COMMAND} -E compare_files ${project}/cmake.ppm ${project}/make.ppm)
    file(SIZE ${project}/cmake.ppm bytes)
    if(bytes LESS 200000)
        message(FATAL_ERROR "the picture of the starter in ${language} has only ${bytes} bytes")
    endif()
endforeach()

# Programs start on the installed driver.
if(EXISTS ${WORK}/prefix/bin/vernier)
    must(${WORK}/prefix/bin/vernier run sh -c "test -f \$VK_DRIVER_FILES")
endif()
