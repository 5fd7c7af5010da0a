// HeadPath.h - where the head is at a time. Layer: apps.
// SPDX-License-Identifier: MIT
#pragma once

#include "apps/cave/CaveSetup.h"

#include <string>
#include <vector>

namespace osgRayTrace::app
{

/// Poses at times that rise, from a text file: a line each, "seconds x y z h p r"; "#" begins a
/// comment.
class HeadPath
{
public:
    /// Throws Failure(kCannotLoad) with the line.
    static HeadPath read(const std::string& file);

    /// In between linearly, angles too; before and after it stays.
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
