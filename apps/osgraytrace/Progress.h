// Progress.h - the progress bar. Layer: apps.
// SPDX-License-Identifier: MIT
#pragma once

#include "Options.h"

#include <osgRayTrace/Statistics>

#include <chrono>

namespace osgRayTrace::app
{

/// Shows one line on standard error, written over again and again; silent if that is no terminal.
class Progress
{
public:
    explicit Progress(const Options& options);
    ~Progress(); ///< wipes the line

    Progress(const Progress&) = delete;
    Progress& operator=(const Progress&) = delete;

    void show(const Statistics& statistics);

    /// Returns the wall clock time since construction.
    double seconds() const;

private:
    double fraction(const Statistics& statistics) const;

    const Options& _options;
    bool _terminal;
    std::chrono::steady_clock::time_point _start;
    double _lastShown = -1.0; ///< [s]
};

} // namespace osgRayTrace::app
