// ErrorLine.h - a program's messages on standard error. Layer: apps.
// SPDX-License-Identifier: MIT
#pragma once

#include <iostream>
#include <string>

namespace osgRayTrace::app
{

/// Prints "program: text" as a line on standard error. It is one write, as mpirun mixes the writes
/// of its processes. Any thread may call it.
inline void printError(const std::string& program, const std::string& text)
{
    std::cerr << program + ": " + text + '\n';
}

} // namespace osgRayTrace::app
