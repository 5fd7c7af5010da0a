// Medium.cpp - keeps coefficients in range, and makes them from colours. Layer: public API.
// SPDX-License-Identifier: MIT
#include <osgRayTrace/Medium>

#include "osgRayTrace/bridge/common/WarnOnce.h"
#include "osgRayTrace/media/PhaseFunction.h"
#include "osgRayTrace/scene/Medium.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <tuple>

namespace osgRayTrace
{

namespace
{

constexpr float kLargest = std::numeric_limits<float>::max();

/// Sets member to the value nearest to it within the range; leaves member if the value is NaN or
/// infinite.
void assign(const char* name, float& member, float value, float minimum, float maximum)
{
    if (!std::isfinite(value))
    {
        engine::warnOnce(std::string("Medium: ") + name + " is not finite; left as it was");
        return;
    }
    member = std::clamp(value, minimum, maximum);
    if (member != value)
        engine::warnOnce(std::string("Medium: ") + name + " out of range; clamped");
}

void assign(const char* name, osg::Vec3& member, const osg::Vec3& value, float maximum)
{
    for (int c = 0; c < 3; ++c)
        assign(name, member[c], value[c], 0.0f, maximum);
}

} // namespace

Medium::Medium() = default;

Medium::Medium(const Medium& other, const osg::CopyOp& copyop)
    : osg::Object(other, copyop),
      _absorption(other._absorption),
      _scattering(other._scattering),
      _emission(other._emission),
      _anisotropy(other._anisotropy),
      _phase(other._phase),
      _dropletSize(other._dropletSize),
      _priority(other._priority)
{
}

Medium::~Medium() = default;

int Medium::compare(const Medium& other) const
{
    const auto values = [](const Medium& m)
    {
        return std::tie(m._absorption, m._scattering, m._emission, m._anisotropy, m._phase,
                        m._dropletSize, m._priority);
    };
    if (values(*this) < values(other)) return -1;
    return values(other) < values(*this) ? 1 : 0;
}

void Medium::setAbsorption(const osg::Vec3& value)
{
    assign("absorption", _absorption, value, kLargest);
}

void Medium::setScattering(const osg::Vec3& value)
{
    assign("scattering", _scattering, value, kLargest);
}

void Medium::setAttenuation(const osg::Vec3& color, float distance)
{
    osg::Vec3 share(1.0f, 1.0f, 1.0f);
    float length = 0.0f;
    assign("attenuation color", share, color, 1.0f);
    assign("attenuation distance", length, distance, 0.0f, kLargest);
    const engine::Vec3 absorption =
        engine::absorptionOf(engine::Vec3(share.x(), share.y(), share.z()), length);
    _absorption.set(absorption.x, absorption.y, absorption.z);
    _scattering.set(0.0f, 0.0f, 0.0f);
}

void Medium::setMultiscatterColor(const osg::Vec3& color)
{
    osg::Vec3 clamped;
    assign("multiscatter color", clamped, color, 1.0f);
    const float g =
        _phase == DROPLETS ? engine::meanCosine(engine::dropletPhase(_dropletSize)) : _anisotropy;
    for (int i = 0; i < 3; ++i)
    {
        const double albedo = engine::albedoOfColor(double(clamped[i]), double(g));
        const float extinction = _absorption[i] + _scattering[i];
        _scattering[i] = extinction * static_cast<float>(albedo);
        _absorption[i] = extinction - _scattering[i];
    }
}

void Medium::setEmission(const osg::Vec3& value)
{
    assign("emission", _emission, value, kLargest);
}

void Medium::setAnisotropy(float value)
{
    assign("anisotropy", _anisotropy, value, -engine::kLargestAnisotropy,
           engine::kLargestAnisotropy);
}

void Medium::setDropletSize(float micrometres)
{
    assign("droplet size", _dropletSize, micrometres, engine::kSmallestDroplet,
           engine::kLargestDroplet);
}

} // namespace osgRayTrace
