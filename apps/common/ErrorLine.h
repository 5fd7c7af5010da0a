// ErrorLine.h - a program's messages on standard error. Layer: apps.
// SPDX-License-Identifier: MIT
#pragma once

#include <iostream>
#include <new>
#include <string>
#include <string_view>

namespace osgRayTrace::app
{

/// Prints "program: text" as a line on standard error. It is one write, as mpirun mixes the writes
/// of its processes; several if there is no memory. Any thread may call it.
inline void printError(std::string_view program, std::string_view text)
{
    std::string line;
    try
    {
        line.append(program).append(": ").append(text).append("\n");
    }
    catch (const std::bad_alloc&)
    {
        std::cerr << program << ": " << text << '\n';
        return;
    }
    std::cerr << line;
}

} // namespace osgRayTrace::app
