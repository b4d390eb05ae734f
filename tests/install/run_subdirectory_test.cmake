# Uses the sources through add_subdirectory: the tests and tools of Vernier stay out of the project, and its settings out of
# the project's own programs. With BUILD_ALL all of Vernier is built along and the programs are run (minutes).
include(${CMAKE_CURRENT_LIST_DIR}/must.cmake)

file(REMOVE_RECURSE ${WORK})
must(${CMAKE_COMMAND} -S ${CONSUMER} -B ${WORK} -DVERNIER_SOURCE=${SOURCE} -DCMAKE_BUILD_TYPE=Release
     -DCMAKE_EXPORT_COMPILE_COMMANDS=ON)
file(STRINGS ${WORK}/compile_commands.json commands REGEX "\"command\"")
foreach(line IN LISTS commands)
    if(line MATCHES " -c ${SOURCE}/(tests|bench|conformance|samples)/" AND NOT line MATCHES " -c ${CONSUMER}/")
        message(FATAL_ERROR "a subproject builds what only Vernier itself needs: ${line}")
    endif()
    if(line MATCHES "consumer\\.c" AND line MATCHES "-Werror|-std=c99|-ffp-contract")
        message(FATAL_ERROR "Vernier's own settings reach the program: ${line}")
    endif()
endforeach()
if(BUILD_ALL)
    must(${CMAKE_COMMAND} --build ${WORK} --target consumer consumer_cpp --parallel)
    must(${WORK}/consumer)
    must(${WORK}/consumer_cpp)
endif()
