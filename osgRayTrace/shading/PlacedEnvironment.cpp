// PlacedEnvironment.cpp - from engine space to the space of the image and back. Layer: shading.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/shading/PlacedEnvironment.h"

#include "osgRayTrace/sampling/Sobol.h"

namespace osgRayTrace::engine
{

PlacedEnvironment::PlacedEnvironment(const Light& light, uint32_t index,
                                     const PlacedEnvironment* previous)
    : _tables(previous && previous->map().image() == light.environment.image
                  ? previous->_tables
                  : std::make_shared<Tables>(light.environment.image)),
      _index(index),
      _visible(light.environment.visible),
      _mapFromEngine(light.environment.mapFromEngine),
      _engineFromMap(glm::transpose(light.environment.mapFromEngine)),
      _scale(light.radiance)
{
}

EnvironmentSample PlacedEnvironment::sample(float u, float v, EnvironmentDensity density) const
{
    EnvironmentSample sample = map().sample(u, v, density);
    sample.direction = _engineFromMap * sample.direction;
    sample.radiance *= _scale;
    return sample;
}

std::vector<EnvironmentStratum> PlacedEnvironment::strata(int count) const
{
    std::vector<EnvironmentStratum> strata;
    {
        std::lock_guard<std::mutex> lock(_tables->mutex);
        if (_tables->count != count) _tables->strata = environmentStrata(map(), count);
        _tables->count = count;
        strata = _tables->strata;
    }
    for (EnvironmentStratum& stratum : strata)
    {
        stratum.direction = _engineFromMap * stratum.direction;
        stratum.integral *= _scale;
    }
    return strata;
}

float irradianceOf(const PlacedEnvironment& environment, Vec3 normal)
{
    constexpr uint32_t kSamples = 8192;
    double sum = 0.0;
    for (uint32_t i = 0; i < kSamples; ++i)
    {
        float u, v;
        sobol2(i, 0x9e3779b9u, u, v);
        const EnvironmentSample sample = environment.sample(u, v);
        const float cosine = glm::dot(sample.direction, normal);
        if (sample.pdfW > 0.0f && cosine > 0.0f)
            sum += double(luminance(sample.radiance)) * double(cosine / sample.pdfW);
    }
    return static_cast<float>(sum / kSamples);
}

} // namespace osgRayTrace::engine
