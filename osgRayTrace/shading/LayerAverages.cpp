// LayerAverages.cpp - means and bounds over angles of what layers leave. Layer: shading.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/shading/LayeredBsdf.h"
#include "osgRayTrace/shading/LayeredTerms.h"

namespace osgRayTrace::engine
{

namespace
{

/// Returns the mean of S over the azimuths of directions with a cosine. The plane of both normals
/// is one of symmetry.
double layersAround(const Bsdf& b, float cosTheta)
{
    constexpr int kAzimuths = 8; // in a half circle
    const float sine = std::sqrt(std::max(0.0f, 1.0f - cosTheta * cosTheta));
    const Vec3 n = toFacets(b, b.coatNormal);
    const Vec2 along = Vec2(n) / glm::length(Vec2(n)), across(-along.y, along.x);
    double sum = 0.0;
    for (int i = 0; i < kAzimuths; ++i)
    {
        const float phi = kPi * (static_cast<float>(i) + 0.5f) / kAzimuths;
        const Vec2 w = (along * std::cos(phi) + across * std::sin(phi)) * sine;
        sum += double(belowLayers(b, Vec3(w, cosTheta)));
    }
    return sum / kAzimuths;
}

/// Returns int 2 A c dc by the rule of Gauss and Legendre with 12 nodes, for surfaces on which A
/// takes long: those with a film, or with a coat that has a normal of its own.
double gaussianAverage(const Bsdf& b, bool tilted)
{
    constexpr double kNodes[] = {0.1252334085114689, 0.3678314989981802, 0.5873179542866175,
                                 0.7699026741943047, 0.9041172563704749, 0.9815606342467192};
    constexpr double kWeights[] = {0.2491470458134028, 0.2334925365383548, 0.2031674267230659,
                                   0.1600783285433462, 0.1069393259953184, 0.0471753363865118};
    double sum = 0.0;
    for (int i = 0; i < 6; ++i)
        for (const double node : {0.5 - 0.5 * kNodes[i], 0.5 + 0.5 * kNodes[i]})
        {
            const auto c = static_cast<float>(node);
            const double a = tilted ? double(belowInterface(b, c)) * layersAround(b, c)
                                    : double(aboveBase(b, Vec3(0.0f, 0.0f, c)));
            sum += kWeights[i] * node * a;
        }
    return sum;
}

} // namespace

float baseAverageOf(const Bsdf& b)
{
    const bool tilted = b.coatTilted && !b.inside && Vec2(b.coatNormal) != Vec2(0.0f);
    if (tilted || b.film > 0.0f)
        return static_cast<float>(std::max(gaussianAverage(b, tilted), 1e-6));
    constexpr int kSteps = 64;
    double sum = 0.0;
    for (int i = 0; i < kSteps; ++i)
    {
        // The integral is int A dx with x = c^2, refined towards grazing by x = s^2.
        const double s = (i + 0.5) / kSteps;
        sum += aboveBase(b, Vec3(0.0f, 0.0f, static_cast<float>(s))) * 2.0 * s;
    }
    return static_cast<float>(std::max(sum / kSteps, 1e-6));
}

float filmRiseOf(const Bsdf& b)
{
    // Cosines closer to grazing would take more from the base at all angles than rough facets,
    // which average over their angles, reflect at any.
    constexpr int kSteps = 7;
    constexpr float kLeastCosine = 1.0f / 12.0f;
    float rise = 0.0f;
    for (int i = 0; i <= kSteps; ++i)
    {
        const float cosTheta =
            kLeastCosine + (1.0f - kLeastCosine) * static_cast<float>(i) / kSteps;
        const Vec3 face = tinted(b, fresnelDielectric(cosTheta, b.eta));
        const Vec3 bare = isFilmOnAir(b) ? Vec3(fresnelDielectric(cosTheta, b.filmIor)) : face;
        const Vec3 added = withFilm(b, cosTheta, face) - bare, left = Vec3(1.0f) - bare;
        for (int c = 0; c < 3; ++c)
            if (left[c] > 0.0f) rise = std::max(rise, added[c] / left[c]);
    }
    return std::min(rise, 1.0f);
}

Vec3 straightTransmittance(const Bsdf& b, float cosTheta)
{
    if (!b.thin || !b.isSmooth() || !b.transmits()) return Vec3(0.0f);
    return b.transmission * (Vec3(1.0f) - interfaceFresnel(b, cosTheta)) *
           passedLayers(b, Vec3(0.0f, 0.0f, cosTheta), Vec3(0.0f, 0.0f, cosTheta));
}

} // namespace osgRayTrace::engine
