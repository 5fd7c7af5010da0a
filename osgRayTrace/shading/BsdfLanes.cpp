// BsdfLanes.cpp - sixteen surfaces that transmit nothing, as vector code. Layer: shading.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/shading/BsdfLanes.h"

#include "osgRayTrace/shading/Fresnel.h"

#include <cmath>

namespace osgRayTrace::engine
{

namespace
{

/// Tells the rows of the coats of lanes: none, from outside, or from inside.
enum class Rows
{
    None,
    Plain,
    Inside,
};

/// Holds two rows of a coat, between whose roughnesses that of the coat is.
struct TwoRows
{
    const float *first = nullptr, *second = nullptr;
    float critical = 0.0f;
};

/// Returns the albedo of a coat.
template <Rows kRows> OSGRAYTRACE_INLINE float between(TwoRows rows, float fraction, float cosTheta)
{
    const float a = kRows == Rows::Inside ? insideRowAlbedo(rows.first, rows.critical, cosTheta)
                                          : coatRowAlbedo(rows.first, cosTheta);
    const float b = kRows == Rows::Inside ? insideRowAlbedo(rows.second, rows.critical, cosTheta)
                                          : coatRowAlbedo(rows.second, cosTheta);
    return a + (b - a) * fraction;
}

/// Returns Smith's Lambda [Heitz14, eq. 72]; it is infinite next to grazing incidence.
OSGRAYTRACE_INLINE float lambdaOf(float alpha2, float cosTheta)
{
    const float cos2 = cosTheta * cosTheta, tan2 = (1.0f - cos2) / cos2;
    return 0.5f * (std::sqrt(1.0f + alpha2 * select(tan2 > 0.0f, tan2, 0.0f)) - 1.0f);
}

/// Evaluates the formulas that Bsdf.h and Bsdf.cpp explain.
template <Rows kRows>
OSGRAYTRACE_INLINE void evalLanes(const BsdfLanes& s, const CoatAlbedoRow* rows,
                                  const Vec3Lanes& normal, const Vec3Lanes& wo, const Vec3Lanes& wi,
                                  LaneMask lanes, Vec3Lanes& fCos, FloatLanes& pdfW)
{
    constexpr bool kHasRows = kRows != Rows::None;
    const TwoRows two =
        kHasRows ? TwoRows{rows[0].albedo.data(), rows[1].albedo.data(), rows[0].critical}
                 : TwoRows();
    OSGRAYTRACE_SIMD
    for (int i = 0; i < kLanes; ++i)
    {
        const float nx = normal.x[i], ny = normal.y[i], nz = normal.z[i];
        const float ox = wo.x[i], oy = wo.y[i], oz = wo.z[i];
        const float ix = wi.x[i], iy = wi.y[i], iz = wi.z[i];
        const float cosO = ox * nx + oy * ny + oz * nz, cosI = ix * nx + iy * ny + iz * nz;
        const uint32_t above = maskOf(cosI > 0.0f) & maskOf(cosO > 0.0f);

        const float eta = s.eta[i], coat = s.coat[i], fraction = s.coatFraction[i];
        const float fresnelO = select(coat > 0.0f, fresnelDielectric(cosO, eta), 0.0f);
        const float belowO = 1.0f - (kHasRows ? between<kRows>(two, fraction, cosO) : fresnelO);
        const float belowI =
            1.0f - (kHasRows ? between<kRows>(two, fraction, cosI) : fresnelDielectric(cosI, eta));
        const float left = select(s.coated[i], belowI * belowO / s.belowAverage[i], 1.0f);
        const float lambert = kInvPi * cosI * left;

        // D uses the half vector's tangential part, which keeps its digits near the peak.
        const float sumX = ox + ix, sumY = oy + iy, sumZ = oz + iz;
        const float length2 = sumX * sumX + sumY * sumY + sumZ * sumZ;
        const float length = std::sqrt(length2), inverse = 1.0f / length, cosH = 0.5f * length;
        const float cosN = (sumX * nx + sumY * ny + sumZ * nz) * inverse;
        const float hx = sumX * inverse - nx * cosN, hy = sumY * inverse - ny * cosN,
                    hz = sumZ * inverse - nz * cosN;
        const float alpha2 = s.alpha[i] * s.alpha[i];
        const float spread = hx * hx + hy * hy + hz * hz + alpha2 * cosN * cosN;
        const float d = alpha2 / (kPi * spread * spread * 4.0f * cosO);
        const float lambdaO = lambdaOf(alpha2, cosO), lambdaI = lambdaOf(alpha2, cosI);
        // The selection comes last: without facets the terms above may be no numbers.
        const uint32_t shines = s.shines[i] & maskOf(length2 >= 1e-14f);
        const float facets = select(shines, d / (1.0f + lambdaO + lambdaI), 0.0f);
        const float facetsPdf = select(shines, d / (1.0f + lambdaO), 0.0f);

        const float grazing = s.grazing[i], toGrazing = schlickShare(cosH);
        const float coatH = coat * fresnelDielectric(cosH, eta);
        const float rx = s.reflectance.x[i], ry = s.reflectance.y[i], rz = s.reflectance.z[i];
        const float dx = s.diffuse.x[i], dy = s.diffuse.y[i], dz = s.diffuse.z[i];
        const float x = dx * lambert + (rx + (grazing - rx) * toGrazing + coatH) * facets;
        const float y = dy * lambert + (ry + (grazing - ry) * toGrazing + coatH) * facets;
        const float z = dz * lambert + (rz + (grazing - rz) * toGrazing + coatH) * facets;

        // Lobes are chosen by the luminance of what they send towards wo.
        const float toGrazingO = schlickShare(cosO), reflectance = luminanceOf(rx, ry, rz);
        const float base = luminanceOf(dx, dy, dz) * belowO;
        const float interface =
            reflectance + (grazing - reflectance) * toGrazingO + coat * fresnelO;
        const float sum = base + interface;
        const float pdf = (base * kInvPi * cosI + interface * facetsPdf) / sum;

        const uint32_t in = laneBit(lanes, i), lit = above & maskOf(sum > 0.0f);
        fCos.x[i] = select(in, select(above, x, 0.0f), fCos.x[i]);
        fCos.y[i] = select(in, select(above, y, 0.0f), fCos.y[i]);
        fCos.z[i] = select(in, select(above, z, 0.0f), fCos.z[i]);
        pdfW[i] = select(in, select(lit, pdf, 0.0f), pdfW[i]);
    }
}

/// Evaluates lanes whose coats have the same rows, or none.
OSGRAYTRACE_KERNEL
void evalAlike(const BsdfLanes& bsdfs, const CoatAlbedoRow* rows, const Vec3Lanes& normal,
               const Vec3Lanes& wo, const Vec3Lanes& wi, LaneMask lanes, Vec3Lanes& fCos,
               FloatLanes& pdfW)
{
    if (!rows)
        evalLanes<Rows::None>(bsdfs, nullptr, normal, wo, wi, lanes, fCos, pdfW);
    else if (rows->critical == 0.0f)
        evalLanes<Rows::Plain>(bsdfs, rows, normal, wo, wi, lanes, fCos, pdfW);
    else
        evalLanes<Rows::Inside>(bsdfs, rows, normal, wo, wi, lanes, fCos, pdfW);
}

} // namespace

BsdfLanes bsdfLanes(const Bsdf* bsdfs, LaneMask lanes)
{
    BsdfLanes result;
    for (int i = 0; i < kLanes; ++i)
    {
        const Bsdf& bsdf = bsdfs[(lanes >> i) & 1u ? i : firstLane(lanes)];
        const bool coated = bsdf.coat > 0.0f && bsdf.diffuse != Vec3(0.0f);
        setLane(result.diffuse, i, bsdf.diffuse);
        setLane(result.reflectance, i, bsdf.reflectance);
        result.grazing[i] = bsdf.grazing;
        result.coat[i] = bsdf.coat;
        result.eta[i] = bsdf.eta;
        result.alpha[i] = bsdf.alpha;
        result.coatFraction[i] = bsdf.coatFraction;
        result.belowAverage[i] = coated ? 1.0f - coatAverage(bsdf) : 1.0f;
        result.coated[i] = maskOf(coated);
        result.shines[i] = maskOf(bsdf.reflects() && !bsdf.isSmooth());
        result.coatRows[i] = bsdf.coatRows;
    }
    return result;
}

void evalBsdfLanes(const BsdfLanes& bsdfs, const Vec3Lanes& normal, const Vec3Lanes& wo,
                   const Vec3Lanes& wi, LaneMask lanes, Vec3Lanes& fCos, FloatLanes& pdfW)
{
    fCos = {};
    pdfW = {};
    for (LaneMask left = lanes, same; left; left &= ~same) // one round for one material
    {
        const CoatAlbedoRow* rows = bsdfs.coatRows[firstLane(left)];
        same = 0;
        for (const int i : lanesIn(left))
            same |= static_cast<LaneMask>(bsdfs.coatRows[i] == rows) << i;
        evalAlike(bsdfs, rows, normal, wo, wi, same, fCos, pdfW);
    }
}

} // namespace osgRayTrace::engine
