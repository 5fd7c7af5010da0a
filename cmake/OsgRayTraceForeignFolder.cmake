# Modules that other programs load from a folder of their own find our library from there, wherever
# that folder is.
# SPDX-License-Identifier: MIT

# Installs a module to a folder below the prefix, or to an absolute one. libraryDir is the library's
# folder below the prefix.
function(osgraytrace_install_module target folder libraryDir)
    install(TARGETS ${target} LIBRARY DESTINATION "${folder}")
    if(NOT IS_ABSOLUTE "${folder}")
        file(RELATIVE_PATH up "/prefix/${folder}" "/prefix")
        set_target_properties(${target} PROPERTIES INSTALL_RPATH "\$ORIGIN/${up}${libraryDir}")
        return()
    endif()

    # The prefix is known only when the module is installed (cmake --install --prefix): the path is
    # written then, into room that is made for it here.
    string(REPEAT "-" 1024 room)
    set(room "/written-when-installed${room}")
    set_target_properties(${target} PROPERTIES INSTALL_RPATH "${room}")
    install(CODE "
        set(module \"\$ENV{DESTDIR}${folder}/$<TARGET_FILE_NAME:${target}>\")
        get_filename_component(prefix \"\${CMAKE_INSTALL_PREFIX}\" ABSOLUTE)
        file(RPATH_CHANGE FILE \"\${module}\" OLD_RPATH \"${room}\" NEW_RPATH \"\${prefix}/${libraryDir}\")
        message(STATUS \"Run path of \${module}: \${prefix}/${libraryDir}\")")
endfunction()
