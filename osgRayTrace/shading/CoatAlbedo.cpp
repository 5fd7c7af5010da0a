// CoatAlbedo.cpp - albedos of rough interfaces by quadrature, in double. Layer: shading.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/shading/CoatAlbedo.h"

#include "osgRayTrace/base/NeverDestroyed.h"
#include "osgRayTrace/shading/Fresnel.h"
#include "osgRayTrace/shading/Ggx.h"

#include <algorithm>
#include <iterator>
#include <map>
#include <mutex>

namespace osgRayTrace::engine
{

namespace
{

/// Returns the mean of F(wo h) G2 / G1(wo) over visible normals: all that single scattering
/// reflects.
double albedoOf(double cosine, double alpha, float eta)
{
    // Total reflection has an edge, which takes more points.
    const int turns = eta < 1.0f ? 32 : 12, heights = eta < 1.0f ? 96 : 48;
    const double sine = std::sqrt(1.0 - cosine * cosine);
    const auto lambda = [alpha](double z)
    { return 0.5 * (std::sqrt(1.0 + alpha * alpha * (1.0 - z * z) / (z * z)) - 1.0); };
    const double lambdaO = lambda(cosine);
    const Vec3d stretched = glm::normalize(Vec3d(alpha * sine, 0.0, cosine));
    double sum = 0.0;
    for (int j = 0; j < heights; ++j)
    {
        // The points are those of sampleGgxVisible: a cap of the sphere by height and angle. One
        // half of the cap stands for both.
        const double z = (1.0 - (j + 0.5) / heights) * (1.0 + stretched.z) - stretched.z;
        const double radius = std::sqrt(std::max(0.0, 1.0 - z * z));
        for (int i = 0; i < turns; ++i)
        {
            const double phi = M_PI * (i + 0.5) / turns;
            const Vec3d cap = Vec3d(radius * std::cos(phi), radius * std::sin(phi), z) + stretched;
            const Vec3d h = glm::normalize(Vec3d(alpha * cap.x, alpha * cap.y, cap.z));
            const double cosH = sine * h.x + cosine * h.z;
            const double wiZ = 2.0 * cosH * h.z - cosine;
            if (!(wiZ > 0.0)) continue;
            sum += fresnelDielectric(static_cast<float>(cosH), eta) * (1.0 + lambdaO) /
                   (1.0 + lambdaO + lambda(std::min(wiZ, 1.0)));
        }
    }
    return sum / (turns * heights);
}

/// Returns the cosine at which total reflection ends, 0 if there is none or if it is all but
/// grazing.
double bendOf(double eta)
{
    constexpr double kLeastBend = 0.05;
    const double bend = std::sqrt(std::max(1.0 - eta * eta, 0.0));
    return eta < 1.0 && bend > kLeastBend ? bend : 0.0;
}

/// Returns the cosine of a place between two nodes of a row: the inverse of coatRowAlbedo's and
/// bentRowAlbedo's steps, x in [0, 1].
double cosineAt(double x, double bend)
{
    if (bend == 0.0) return x * x;
    const double u = 2.0 * x;
    if (u < 0.5) return bend * 2.0 * u * u;
    if (u < 1.0) return bend * (1.0 - 2.0 * (1.0 - u) * (1.0 - u));
    return bend + (1.0 - bend) * (u - 1.0) * (u - 1.0);
}

/// Returns int 2 E c dc for the interpolated E, by the midpoint rule in fine steps.
double averageOf(const CoatAlbedoRow& row)
{
    constexpr int kSteps = kCoatSteps * 16;
    double sum = 0.0;
    for (int i = 0; i < kSteps; ++i)
    {
        const double x = (i + 0.5) / kSteps;
        if (row.bend == 0.0f)
        {
            sum += row(static_cast<float>(x * x)) * 4.0 * x * x * x;
            continue;
        }
        const double low = cosineAt(double(i) / kSteps, double(row.bend));
        const double high = cosineAt((i + 1.0) / kSteps, double(row.bend));
        sum += row(static_cast<float>(cosineAt(x, double(row.bend)))) * (high * high - low * low) *
               kSteps;
    }
    return sum / kSteps;
}

} // namespace

std::shared_ptr<CoatAlbedo> CoatAlbedo::ofIndex(float eta)
{
    static std::mutex mutex;
    static NeverDestroyed<std::map<float, std::weak_ptr<CoatAlbedo>>> kept;
    const std::lock_guard<std::mutex> lock(mutex);
    std::map<float, std::weak_ptr<CoatAlbedo>>& tables = *kept;
    for (auto entry = tables.begin(); entry != tables.end();)
        entry = entry->second.expired() ? tables.erase(entry) : std::next(entry);
    std::shared_ptr<CoatAlbedo> table = tables[eta].lock();
    if (!table) tables[eta] = table = std::make_shared<CoatAlbedo>(eta);
    return table;
}

void CoatAlbedo::makeRow(int row)
{
    OSGRAYTRACE_ASSERT(_mutex.isHeld());
    if (_made[static_cast<std::size_t>(row)]) return;
    constexpr int kSteps = kCoatSteps, kFine = 4; // kFine: steps between two nodes
    const double roughness = double(row) / kRoughnessSteps;
    const double alpha = std::max(roughness * roughness, double(kSmoothAlpha));
    const double bend = bendOf(double(_eta));
    double fine[kSteps * kFine + 1];
    for (int i = 0; i <= kSteps * kFine; ++i)
    {
        const double x = double(i) / (kSteps * kFine);
        fine[i] = albedoOf(std::clamp(cosineAt(x, bend), 1e-6, 1.0), alpha, _eta);
    }
    CoatAlbedoRow& result = _rows[static_cast<std::size_t>(row)];
    result.bend = static_cast<float>(bend);
    for (int i = 0; i <= kSteps; ++i)
        result.albedo[static_cast<std::size_t>(i)] = static_cast<float>(fine[i * kFine]);
    // The interpolated value is never less than the albedo, also at the bend that total reflection
    // makes: the base may get too little there, but not more than there is.
    for (int i = 0; i < kSteps; ++i)
    {
        float &low = result.albedo[static_cast<std::size_t>(i)],
              &high = result.albedo[static_cast<std::size_t>(i) + 1];
        for (int k = 1; k < kFine; ++k)
        {
            const float t = static_cast<float>(k) / kFine;
            const float lack = static_cast<float>(fine[i * kFine + k]) - (low + (high - low) * t);
            if (lack <= 0.0f) continue;
            low = std::fmin(low + lack, 1.0f);
            high = std::fmin(high + lack, 1.0f);
        }
    }
    result.albedo[kSteps + 1] = result.albedo[kSteps];
    result.average = static_cast<float>(averageOf(result));
    _made[static_cast<std::size_t>(row)] = true;
}

void CoatAlbedo::prepare(float roughness)
{
    const int row = static_cast<int>(roughness * kRoughnessSteps);
    const std::lock_guard<CheckedMutex> lock(_mutex);
    makeRow(std::min(row, kRoughnessSteps - 1));
    makeRow(std::min(row, kRoughnessSteps - 1) + 1);
}

void CoatAlbedo::prepareAll()
{
    const std::lock_guard<CheckedMutex> lock(_mutex);
    for (int row = 0; row <= kRoughnessSteps; ++row)
        makeRow(row);
}

CoatAlbedo::Place CoatAlbedo::at(float roughness) const
{
    const float x = std::fmin(std::fmax(roughness, 0.0f), 1.0f) * kRoughnessSteps;
    const int row = std::min(static_cast<int>(x), kRoughnessSteps - 1);
    return {&_rows[static_cast<std::size_t>(row)], x - static_cast<float>(row)};
}

} // namespace osgRayTrace::engine
