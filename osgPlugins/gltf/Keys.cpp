// Keys.cpp - reads keys; cubic splines become Bezier curves, rotations many short arcs. Layer:
// osgPlugins.
// SPDX-License-Identifier: MIT
#include "osgPlugins/gltf/Keys.h"

#include <osg/Quat>
#include <osg/Vec3>

#include <algorithm>

namespace osgRayTrace::gltf
{

namespace
{

constexpr std::size_t kMostWeights = 1024;
constexpr std::size_t kArcs = 16; ///< arcs that stand for a spline of rotations

Interpolation interpolationOf(const JsonPlace& sampler)
{
    const std::string word = sampler.textOr("interpolation", "LINEAR");
    if (word == "STEP") return Interpolation::Step;
    if (word == "LINEAR") return Interpolation::Linear;
    if (word == "CUBICSPLINE") return Interpolation::CubicSpline;
    sampler.at("interpolation").refuse("is '" + word + "'; STEP, LINEAR and CUBICSPLINE are known");
}

/// Returns a row's number of values as a vector, a rotation or a number.
template <typename T> T valueAt(const float* row);
template <> osg::Vec3 valueAt(const float* row)
{
    return {row[0], row[1], row[2]};
}
template <> osg::Quat valueAt(const float* row)
{
    const osg::Quat rotation(row[0], row[1], row[2], row[3]);
    const double length = rotation.length();
    return length > 0.0 ? rotation / length : osg::Quat();
}
template <> float valueAt(const float* row)
{
    return *row;
}

/// Gives the values of keys from a column on.
template <typename T> class Rows
{
public:
    Rows(const Keys& keys, std::size_t column) : _keys(&keys), _column(column) {}

    std::size_t count() const { return _keys->times.size(); }
    float time(std::size_t key) const { return _keys->times[key]; }

    T value(std::size_t key) const { return valueAt<T>(row(isSpline() ? 3 * key + 1 : key)); }
    T tangentIn(std::size_t key) const { return valueAt<T>(row(3 * key)); }
    T tangentOut(std::size_t key) const { return valueAt<T>(row(3 * key + 2)); }

    const float* row(std::size_t number) const
    {
        return _keys->values.data() + number * _keys->width + _column;
    }

private:
    bool isSpline() const { return _keys->interpolation == Interpolation::CubicSpline; }

    const Keys* _keys;
    std::size_t _column;
};

/// Returns a channel with a key for each of the file's.
template <typename ChannelType, typename T>
osg::ref_ptr<osgAnimation::Channel> plainChannel(const Rows<T>& rows)
{
    const osg::ref_ptr<ChannelType> channel = new ChannelType;
    auto* keys = channel->getOrCreateSampler()->getOrCreateKeyframeContainer();
    using Key = typename ChannelType::KeyframeContainerType::KeyType;
    if (rows.time(0) > 0.0f) keys->push_back(Key(0.0, rows.value(0)));
    for (std::size_t i = 0; i < rows.count(); ++i)
        keys->push_back(Key(rows.time(i), rows.value(i)));
    return channel;
}

/// Hermite's curve between two keys is Bezier's whose control points lie a third of the tangents
/// from its ends. osgAnimation keeps both control points with the first key.
template <typename ChannelType, typename T>
osg::ref_ptr<osgAnimation::Channel> splineChannel(const Rows<T>& rows)
{
    const osg::ref_ptr<ChannelType> channel = new ChannelType;
    auto* keys = channel->getOrCreateSampler()->getOrCreateKeyframeContainer();
    using Key = typename ChannelType::KeyframeContainerType::KeyType;
    using Bezier = osgAnimation::TemplateCubicBezier<T>;
    if (rows.time(0) > 0.0f) keys->push_back(Key(0.0, Bezier(rows.value(0))));
    for (std::size_t i = 0; i < rows.count(); ++i)
    {
        Bezier bezier(rows.value(i));
        if (i + 1 < rows.count())
        {
            const float third = (rows.time(i + 1) - rows.time(i)) / 3.0f;
            bezier.setControlPointIn(rows.value(i) + rows.tangentOut(i) * third);
            bezier.setControlPointOut(rows.value(i + 1) - rows.tangentIn(i + 1) * third);
        }
        keys->push_back(Key(rows.time(i), bezier));
    }
    return channel;
}

/// Returns Hermite's curve of the four numbers of rotations, made unit length.
osg::Quat splineRotation(const Rows<osg::Quat>& rows, std::size_t key, float t)
{
    const float duration = rows.time(key + 1) - rows.time(key);
    const float t2 = t * t, t3 = t2 * t;
    const float *p0 = rows.row(3 * key + 1), *m0 = rows.row(3 * key + 2);
    const float *m1 = rows.row(3 * key + 3), *p1 = rows.row(3 * key + 4);
    float sum[4];
    for (int c = 0; c < 4; ++c)
        sum[c] = (2 * t3 - 3 * t2 + 1) * p0[c] + (t3 - 2 * t2 + t) * duration * m0[c] +
                 (3 * t2 - 2 * t3) * p1[c] + (t3 - t2) * duration * m1[c];
    return valueAt<osg::Quat>(sum);
}

osg::ref_ptr<osgAnimation::Channel> splineOfRotations(const Rows<osg::Quat>& rows)
{
    const osg::ref_ptr<osgAnimation::QuatSphericalLinearChannel> channel =
        new osgAnimation::QuatSphericalLinearChannel;
    auto* keys = channel->getOrCreateSampler()->getOrCreateKeyframeContainer();
    if (rows.time(0) > 0.0f) keys->push_back(osgAnimation::QuatKeyframe(0.0, rows.value(0)));
    for (std::size_t i = 0; i + 1 < rows.count(); ++i)
        for (std::size_t arc = 0; arc < kArcs; ++arc)
        {
            const float t = static_cast<float>(arc) / kArcs;
            const float time = rows.time(i) + t * (rows.time(i + 1) - rows.time(i));
            keys->push_back(osgAnimation::QuatKeyframe(time, splineRotation(rows, i, t)));
        }
    const std::size_t last = rows.count() - 1;
    keys->push_back(osgAnimation::QuatKeyframe(rows.time(last), rows.value(last)));
    return channel;
}

void readTimes(const JsonPlace& input, AccessorReader& accessors, Keys& keys)
{
    const Accessor times = accessors.open(input, 1);
    if (times.type != ComponentType::Float) times.place.refuse("has times that are no floats");
    if (times.count == 0) times.place.refuse("has no times");
    accessors.document().take(times.count * 64, times.place);
    keys.times.resize(times.count);
    accessors.copyFloats(times, keys.times.data());
    for (std::size_t i = 0; i < keys.times.size(); ++i)
        if (keys.times[i] < (i == 0 ? 0.0f : keys.times[i - 1]))
            times.place.refuse("has times that do not ascend from 0");
}

} // namespace

Keys readKeys(const JsonPlace& sampler, unsigned int components, AccessorReader& accessors)
{
    Keys keys;
    keys.interpolation = interpolationOf(sampler);
    readTimes(sampler.at("input"), accessors, keys);
    const Accessor output = accessors.open(sampler.at("output"), components);
    const bool spline = keys.interpolation == Interpolation::CubicSpline;
    const std::size_t rows = keys.times.size() * (spline ? 3 : 1);
    if (output.count == 0 || output.count % rows != 0)
        output.place.refuse("has " + std::to_string(output.count) + " elements for " +
                            std::to_string(keys.times.size()) + " keys");
    keys.width = output.count / rows * components;
    if ((components > 1 && keys.width != components) || keys.width > kMostWeights)
        output.place.refuse("has " + std::to_string(keys.width) + " numbers for a key");
    // What osgAnimation makes of a number, and of a rotation in a spline.
    const std::uint64_t bytes = spline && components == 4 ? kArcs * 16 : 48;
    accessors.document().take(output.count * components * bytes, output.place);
    keys.values.resize(output.count * components);
    accessors.copyFloats(output, keys.values.data());
    return keys;
}

std::vector<float> lowestValues(const Keys& keys)
{
    std::vector<float> lowest;
    for (std::size_t column = 0; column < keys.width; ++column)
    {
        const Rows<float> rows(keys, column);
        float least = rows.value(0);
        for (std::size_t i = 0; i < rows.count(); ++i)
        {
            least = std::min(least, rows.value(i));
            if (keys.interpolation != Interpolation::CubicSpline || i + 1 == rows.count()) continue;
            const float third = (rows.time(i + 1) - rows.time(i)) / 3.0f;
            least = std::min(least, rows.value(i) + rows.tangentOut(i) * third);
            least = std::min(least, rows.value(i + 1) - rows.tangentIn(i + 1) * third);
        }
        lowest.push_back(least);
    }
    return lowest;
}

void shiftValues(const std::vector<float>& shifts, Keys& keys)
{
    const bool spline = keys.interpolation == Interpolation::CubicSpline;
    for (std::size_t row = spline ? 1 : 0; row * keys.width < keys.values.size();
         row += spline ? 3 : 1)
        for (std::size_t column = 0; column < std::min(keys.width, shifts.size()); ++column)
            keys.values[row * keys.width + column] += shifts[column];
}

osg::ref_ptr<osgAnimation::Channel> vectorChannel(const Keys& keys)
{
    const Rows<osg::Vec3> rows(keys, 0);
    switch (keys.interpolation)
    {
    case Interpolation::Step:
        return plainChannel<osgAnimation::Vec3StepChannel>(rows);
    case Interpolation::Linear:
        return plainChannel<osgAnimation::Vec3LinearChannel>(rows);
    case Interpolation::CubicSpline:
        break;
    }
    return splineChannel<osgAnimation::Vec3CubicBezierChannel>(rows);
}

osg::ref_ptr<osgAnimation::Channel> rotationChannel(const Keys& keys)
{
    const Rows<osg::Quat> rows(keys, 0);
    switch (keys.interpolation)
    {
    case Interpolation::Step:
        return plainChannel<osgAnimation::QuatStepChannel>(rows);
    case Interpolation::Linear:
        return plainChannel<osgAnimation::QuatSphericalLinearChannel>(rows);
    case Interpolation::CubicSpline:
        break;
    }
    return splineOfRotations(rows);
}

osg::ref_ptr<osgAnimation::Channel> weightChannel(const Keys& keys, std::size_t column)
{
    const Rows<float> rows(keys, column);
    switch (keys.interpolation)
    {
    case Interpolation::Step:
        return plainChannel<osgAnimation::FloatStepChannel>(rows);
    case Interpolation::Linear:
        return plainChannel<osgAnimation::FloatLinearChannel>(rows);
    case Interpolation::CubicSpline:
        break;
    }
    return splineChannel<osgAnimation::FloatCubicBezierChannel>(rows);
}

} // namespace osgRayTrace::gltf
