# Checks that static objects of the library and the plugins are never destroyed (see
# base/NeverDestroyed.h), and that no thread has objects that are: their object files must ask for
# neither. The one exception is the stream library's own object, which is safe.
# Usage: cmake -D NM=<nm> -D BUILD=<build folder> -P NoDestructors.cmake
# SPDX-License-Identifier: MIT
file(GLOB_RECURSE objects "${BUILD}/osgRayTrace/*.o" "${BUILD}/osgPlugins/*.o" "${BUILD}/apps/osgraytrace-run/*.o")
list(LENGTH objects count)
if(count LESS 50)
    message(FATAL_ERROR "only ${count} object files in ${BUILD}")
endif()
foreach(object IN LISTS objects)
    execute_process(COMMAND "${NM}" -u "${object}" OUTPUT_VARIABLE symbols COMMAND_ERROR_IS_FATAL ANY)
    if(symbols MATCHES "__cxa_thread_atexit" OR
       (symbols MATCHES "__cxa_atexit" AND NOT symbols MATCHES "_ZNSt8ios_base4InitD1Ev"))
        # OSG's own macros register plugins and wrappers by static objects.
        if(NOT symbols MATCHES "RegisterWrapperProxy|_ZN5osgDB8Registry")
            message(SEND_ERROR "${object} has static or thread-local objects that are destroyed")
        endif()
    endif()
endforeach()
