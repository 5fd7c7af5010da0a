// MediumWay.cpp - lengths along rays through media that thin out. Layer: media.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/media/MediumWay.h"

#include <cmath>

namespace osgRayTrace::engine
{

namespace
{

/// Returns (1 - exp(-x)) / x.
float meanShare(float x)
{
    return x > 1e-4f ? -std::expm1(-x) / x : 1.0f - 0.5f * x;
}

} // namespace

void MediumWay::setHeights(const MediumRecord& medium, Vec3 origin, Vec3 direction)
{
    _thins = true;
    _rise = glm::dot(medium.rise, direction);
    _height = glm::dot(medium.rise, origin) - medium.base + _rise * _begin;
    const bool comesThrough = _rise > 0.0f ? _height < 0.0f : _height > 0.0f;
    _fold = comesThrough ? std::min(std::fabs(_height) / std::fabs(_rise), _length) : 0.0f;
}

float MediumWay::densityOf(float way) const
{
    return std::exp(-std::max(0.0f, _height + _rise * way));
}

float MediumWay::evenEnd(float distance) const
{
    constexpr float kStep = 2.0f, kNothing = 30.0f; // [scale heights]
    const float height = _height + _rise * (distance - _begin), rate = std::fabs(_rise);
    if (!_thins || !(rate > 0.0f)) return kInfinity;
    const bool rises = _rise > 0.0f;
    if (rises ? height > kNothing : height < 0.0f) return kInfinity;
    const float even = rises ? std::max(0.0f, -height) : std::max(0.0f, height - kNothing);
    const float end = distance + (even + kStep) / rate;
    return end > distance ? end : kInfinity; // far from the layer floats have no smaller steps
}

/// Returns the integral of the density over a stretch above the base.
float MediumWay::lengthAbove(float begin, float end) const
{
    const float low = std::max(0.0f, _height + _rise * (_rise > 0.0f ? begin : end));
    return std::exp(-low) * (end - begin) * meanShare(std::fabs(_rise) * (end - begin));
}

float MediumWay::lengthOf(float way) const
{
    const float first = std::min(way, _fold);
    if (_rise > 0.0f) return first + (way > _fold ? lengthAbove(_fold, way) : 0.0f);
    return (first > 0.0f ? lengthAbove(0.0f, first) : 0.0f) + (way - first);
}

/// Returns the way of a length at full density: the inverse of lengthOf().
float MediumWay::wayOf(float length) const
{
    const bool rises = _rise > 0.0f;
    if (rises && length <= _fold) return length;
    const float begin = rises ? _fold : 0.0f, end = rises ? _length : _fold;
    const float above = end > begin ? lengthAbove(begin, end) : 0.0f;
    const float within = rises ? length - _fold : length;
    if (!(within < above)) return rises ? _length : _fold + (within - above);
    // The share of the stretch's density that is nearer to its lower end.
    const float share = rises ? within / above : 1.0f - within / above;
    const float way = wayFromLowEnd(share, end - begin, within / above);
    return rises ? begin + way : end - way;
}

/// Returns how far from the lower end of a stretch above the base this share of its density lies.
/// before: the share that the ray comes through first.
float MediumWay::wayFromLowEnd(float share, float length, float before) const
{
    const float rise = std::fabs(_rise), scales = rise * length;
    if (scales < 1e-4f) return length * share * (1.0f - 0.5f * scales * (1.0f - share));
    if (_rise > 0.0f || scales < 1.0f) return -std::log1p(share * std::expm1(-scales)) / rise;
    // Far above the base next to nothing is left, of which 1 - share has lost its digits.
    return -std::log(std::exp(-scales) - before * std::expm1(-scales)) / rise;
}

} // namespace osgRayTrace::engine
