// OutsidePython.h - work without the interpreter's lock that survives its end. Layer: apps.
// SPDX-License-Identifier: MIT
#pragma once

#include <pybind11/pybind11.h>

#include <osgRayTrace/Renderer>

namespace osgRayTrace::python
{

/// Gives the interpreter's lock (GIL) up while it exists. Python ends threads that ask for the lock
/// after the interpreter's end by unwinding them, which ends the process if C++ functions are on
/// the way. Threads that are too late wait here for the end of the process instead.
class OutsidePython
{
public:
    OutsidePython();
    ~OutsidePython();

    OutsidePython(const OutsidePython&) = delete;
    OutsidePython& operator=(const OutsidePython&) = delete;

    /// Returns whether the interpreter is about to end: nobody may enter it again.
    static bool isEnding();

    /// Stops all renders, and returns when no thread is outside any more. Python calls it at exit.
    static void endAll();

private:
    PyThreadState* _state;
};

/// Lets endAll() stop a render, while it exists. Only within an OutsidePython.
class StoppableRender
{
public:
    explicit StoppableRender(Renderer& renderer);
    ~StoppableRender();

    StoppableRender(const StoppableRender&) = delete;
    StoppableRender& operator=(const StoppableRender&) = delete;

private:
    Renderer& _renderer;
};

} // namespace osgRayTrace::python
