// HeadPath.h - the poses of the head over time. Layer: apps.
// SPDX-License-Identifier: MIT
#pragma once

#include "apps/cave/CaveSetup.h"

#include <string>
#include <vector>

namespace osgRayTrace::app
{

/// Holds poses at rising times, from a text file: a line each, "seconds x y z h p r"; "#" begins a
/// comment.
class HeadPath
{
public:
    /// Reads a path. Throws Failure(kCannotLoad) with the line.
    static HeadPath read(const std::string& file);

    /// Returns the pose at a time: in between linearly, angles too; before and after the path it
    /// stays.
    CavePose at(double seconds) const;

    double end() const { return _keys.back().seconds; }

private:
    struct Key
    {
        double seconds = 0.0;
        CavePose pose;
    };
    std::vector<Key> _keys; ///< never empty
};

} // namespace osgRayTrace::app
