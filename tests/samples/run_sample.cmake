# Runs PROGRAM --headless PICTURE ARGUMENTS and compares the pixels with HASH and the thumbnail with THUMBNAIL.
file(REMOVE ${PICTURE})
foreach(command "${PROGRAM};--headless;${PICTURE};${ARGUMENTS}" "${TOOL};check;${PICTURE};${HASH}"
        "${TOOL};check-thumbnail;${PICTURE};${THUMBNAIL}")
    execute_process(COMMAND ${command} RESULT_VARIABLE status ERROR_VARIABLE errors)
    if(NOT status EQUAL 0)
        string(JOIN " " text ${command})
        message(FATAL_ERROR "${text}\nended with ${status}\n${errors}")
    endif()
    # Vernier tells what was wrong in a call on the standard error output.
    if(NOT errors STREQUAL "")
        message(FATAL_ERROR "${command} complained:\n${errors}")
    endif()
endforeach()
file(SIZE ${THUMBNAIL} bytes)
if(bytes GREATER 30000)
    message(FATAL_ERROR "${THUMBNAIL} has ${bytes} bytes; thumbnails have at most 30000")
endif()
