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
#include <numeric>
#include <tuple>

namespace osgRayTrace::engine
{

namespace
{

/// Holds a direction towards the eye and the facets that it sees.
struct Facets
{
    double along, across; ///< widths in the directions x and y
    double x, y, z;       ///< wo
    double lambdaO;
    float eta;
};

/// Returns the function Lambda of Smith's masking [Heitz14, eq. 72] for a direction, z > 0;
/// difference: the width across squared less that along.
OSGRAYTRACE_INLINE double smithLambda(double along, double difference, double y, double z)
{
    const double z2 = z * z;
    const double slope2 = along * along * (1.0 - z2) / z2 + difference * y * y / z2;
    return 0.5 * (std::sqrt(1.0 + slope2) - 1.0);
}

/// Returns F(wo h) G2 / G1(wo) of the facet whose normal is along a vector; 0 if it reflects into
/// the surface. The code has no branches, for loops over facets.
OSGRAYTRACE_INLINE double reflectedBy(const Facets& facets, double x, double y, double z)
{
    const double scale = 1.0 / std::sqrt(x * x + y * y + z * z);
    const double hx = x * scale, hy = y * scale, hz = z * scale;
    const double cosH = facets.x * hx + facets.y * hy + facets.z * hz;
    const double wiY = 2.0 * cosH * hy - facets.y, wiZ = 2.0 * cosH * hz - facets.z;
    const double cosI = wiZ > 0.0 ? std::min(wiZ, 1.0) : 1.0;
    const double difference = facets.across * facets.across - facets.along * facets.along;
    const double lambdaI = smithLambda(facets.along, difference, wiY, cosI);
    const double reflected = double(fresnelDielectric(static_cast<float>(cosH), facets.eta)) *
                             (1.0 + facets.lambdaO) / (1.0 + facets.lambdaO + lambdaI);
    return wiZ > 0.0 ? reflected : 0.0;
}

/// Returns the mean of F(wo h) G2 / G1(wo) over visible normals: all that single scattering
/// reflects. azimuth: of wo, against the direction in which the facets have the width along.
OSGRAYTRACE_KERNEL double albedoOf(double cosine, double azimuth, double along, double across,
                                   float eta)
{
    // Total reflection has an edge, which takes more points.
    constexpr int kMostTurns = 32;
    const int turns = eta < 1.0f ? kMostTurns : 12, heights = eta < 1.0f ? 96 : 48;
    const double sine = std::sqrt(1.0 - cosine * cosine);
    Facets facets{along, across, sine * std::cos(azimuth), sine * std::sin(azimuth), cosine,
                  0.0,   eta};
    facets.lambdaO = smithLambda(along, across * across - along * along, facets.y, cosine);
    const Vec3d stretched = glm::normalize(Vec3d(along * facets.x, across * facets.y, cosine));
    const double span = azimuth == 0.0 ? M_PI : 2.0 * M_PI;
    double cosines[kMostTurns], sines[kMostTurns];
    for (int i = 0; i < turns; ++i)
    {
        const double phi = span * (i + 0.5) / turns;
        cosines[i] = std::cos(phi);
        sines[i] = std::sin(phi);
    }
    double sums[kMostTurns] = {};
    for (int j = 0; j < heights; ++j)
    {
        // The points are those of sampleGgxVisible: a cap of the sphere by height and angle. One
        // half of the cap stands for both if wo is along.
        const double z = (1.0 - (j + 0.5) / heights) * (1.0 + stretched.z) - stretched.z;
        const double radius = std::sqrt(std::max(0.0, 1.0 - z * z));
        OSGRAYTRACE_SIMD
        for (int i = 0; i < turns; ++i)
            sums[i] += reflectedBy(facets, along * (radius * cosines[i] + stretched.x),
                                   across * (radius * sines[i] + stretched.y), z + stretched.z);
    }
    return std::accumulate(sums, sums + turns, 0.0) / (turns * heights);
}

/// Returns the largest albedo over azimuths, and over strengths of anisotropy up to the given one
/// if a texture decides on the strength.
double largestAlbedoOf(double cosine, double alpha, const CoatShape& shape)
{
    constexpr int kAzimuths = 4; // in a quarter
    const auto brushed = [&](double strength)
    {
        const double along = alpha + (1.0 - alpha) * strength * strength;
        double most = std::max(albedoOf(cosine, 0.0, along, alpha, shape.eta),
                               albedoOf(cosine, 0.0, alpha, along, shape.eta));
        // Outside of a body one of the axes has the largest albedo.
        for (int i = 1; i < kAzimuths && shape.eta < 1.0f; ++i)
            most = std::max(most,
                            albedoOf(cosine, 0.5 * M_PI * i / kAzimuths, along, alpha, shape.eta));
        return most;
    };
    const double strength = double(shape.anisotropy);
    if (strength > 0.0 && !shape.varies) return brushed(strength);
    const double plain = albedoOf(cosine, 0.0, alpha, alpha, shape.eta);
    if (strength == 0.0) return plain;
    return std::max({plain, brushed(0.5 * strength), brushed(strength)});
}

/// Returns the cosine of the critical angle, at which total reflection begins; 0 if there is none
/// or if that cosine is less than 0.05, where the steps of rows from outside are dense enough.
double criticalCosineOf(double eta)
{
    constexpr double kLeastCosine = 0.05;
    const double cosine = std::sqrt(std::max(1.0 - eta * eta, 0.0));
    return eta < 1.0 && cosine > kLeastCosine ? cosine : 0.0;
}

/// Returns the cosine of a place between two nodes of a row: the inverse of coatRowAlbedo's and
/// insideRowAlbedo's steps, x in [0, 1].
double cosineAt(double x, double critical)
{
    if (critical == 0.0) return x * x;
    const double u = 2.0 * x;
    if (u < 0.5) return critical * 2.0 * u * u;
    if (u < 1.0) return critical * (1.0 - 2.0 * (1.0 - u) * (1.0 - u));
    return critical + (1.0 - critical) * (u - 1.0) * (u - 1.0);
}

/// Returns int 2 E c dc for the interpolated E, by the midpoint rule in fine steps.
double averageOf(const CoatAlbedoRow& row)
{
    constexpr int kSteps = kCoatSteps * 16;
    double sum = 0.0;
    for (int i = 0; i < kSteps; ++i)
    {
        const double x = (i + 0.5) / kSteps;
        if (row.critical == 0.0f)
        {
            sum += row(static_cast<float>(x * x)) * 4.0 * x * x * x;
            continue;
        }
        const double low = cosineAt(double(i) / kSteps, double(row.critical));
        const double high = cosineAt((i + 1.0) / kSteps, double(row.critical));
        sum += row(static_cast<float>(cosineAt(x, double(row.critical)))) *
               (high * high - low * low) * kSteps;
    }
    return sum / kSteps;
}

} // namespace

std::shared_ptr<CoatAlbedo> CoatAlbedo::ofShape(const CoatShape& shape)
{
    using CoatKey = std::tuple<float, float, bool>;
    const CoatKey key(shape.eta, shape.anisotropy, shape.varies);
    static std::mutex mutex;
    static NeverDestroyed<std::map<CoatKey, std::weak_ptr<CoatAlbedo>>> kept;
    const std::lock_guard<std::mutex> lock(mutex);
    std::map<CoatKey, std::weak_ptr<CoatAlbedo>>& tables = *kept;
    for (auto entry = tables.begin(); entry != tables.end();)
        entry = entry->second.expired() ? tables.erase(entry) : std::next(entry);
    std::shared_ptr<CoatAlbedo> table = tables[key].lock();
    if (!table) tables[key] = table = std::make_shared<CoatAlbedo>(shape);
    return table;
}

void CoatAlbedo::makeRow(int row)
{
    OSGRAYTRACE_ASSERT(_mutex.isHeld());
    if (_made[static_cast<std::size_t>(row)]) return;
    constexpr int kSteps = kCoatSteps, kFine = 4; // kFine: steps between two nodes
    const double roughness = double(row) / kRoughnessSteps;
    const double alpha = std::max(roughness * roughness, double(kSmoothAlpha));
    const double critical = criticalCosineOf(double(_shape.eta));
    double fine[kSteps * kFine + 1];
    for (int i = 0; i <= kSteps * kFine; ++i)
    {
        const double x = double(i) / (kSteps * kFine);
        fine[i] = largestAlbedoOf(std::clamp(cosineAt(x, critical), 1e-6, 1.0), alpha, _shape);
    }
    CoatAlbedoRow& result = _rows[static_cast<std::size_t>(row)];
    result.critical = static_cast<float>(critical);
    for (int i = 0; i <= kSteps; ++i)
        result.albedo[static_cast<std::size_t>(i)] = static_cast<float>(fine[i * kFine]);
    // The interpolated value is never less than the albedo, also at the critical angle: the
    // base may get too little there, but not more than there is.
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
