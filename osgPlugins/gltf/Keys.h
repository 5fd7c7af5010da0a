// Keys.h - the keys of an animation's sampler as channels of osgAnimation. Layer: osgPlugins.
// SPDX-License-Identifier: MIT
#pragma once

#include "osgPlugins/gltf/Accessor.h"

#include <osgAnimation/Channel>

#include <vector>

namespace osgRayTrace::gltf
{

enum class Interpolation
{
    Step,
    Linear,
    CubicSpline
};

/// The keys of a sampler. A key has a row of values; of a cubic spline three: tangent in, value,
/// tangent out.
struct Keys
{
    Interpolation interpolation = Interpolation::Linear;
    std::vector<float> times;  ///< ascending, at least one [s]
    std::vector<float> values; ///< rows * width
    std::size_t width = 1;     ///< numbers in a row
};

/// Reads a sampler whose rows have a multiple of so many numbers. Throws GltfError.
Keys readKeys(const JsonPlace& sampler, unsigned int components, AccessorReader& accessors);

/// Returns for each number of a row the least that it becomes, or less; of splines by their Bezier
/// control points.
std::vector<float> lowestValues(const Keys& keys);

/// Adds to the numbers of each row, whose curves move as they are. A shift that is missing is 0.
void shiftValues(const std::vector<float>& shifts, Keys& keys);

/// Return a channel of the keys; weightChannel: of one number of each row. All begin at time 0,
/// with the first value: osgAnimation repeats what lies between the first and the last key.
osg::ref_ptr<osgAnimation::Channel> vectorChannel(const Keys& keys);
osg::ref_ptr<osgAnimation::Channel> rotationChannel(const Keys& keys);
osg::ref_ptr<osgAnimation::Channel> weightChannel(const Keys& keys, std::size_t column);

} // namespace osgRayTrace::gltf
