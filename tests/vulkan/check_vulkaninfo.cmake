# vulkaninfo prints its whole page about the driver, formats included, and exits with 0.
execute_process(COMMAND ${VULKANINFO} --show-formats OUTPUT_VARIABLE page RESULT_VARIABLE status)
if(NOT status EQUAL 0)
    message(FATAL_ERROR "vulkaninfo ended with ${status}\n${page}")
endif()
foreach(part "deviceName += Vernier \\(software, " "VkQueueFamilyProperties" "VkPhysicalDeviceMemoryProperties"
        "VkPhysicalDeviceFeatures:" "FORMAT_R8G8B8A8_UNORM")
    if(NOT page MATCHES "${part}")
        message(FATAL_ERROR "vulkaninfo's page has no ${part}\n${page}")
    endif()
endforeach()
