// ThinFilm.cpp - interference of light that a film reflects at its two faces. Layer: shading.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/shading/ThinFilm.h"

#include "osgRayTrace/shading/Fresnel.h"

#include <cmath>

namespace osgRayTrace::engine
{

namespace
{

/// Returns the Fourier transform of the eye's response for a difference of ways [nm], in XYZ over
/// that of white: a Gaussian for each colour and a second one for X [Belcour17, sect. 4; glTF20,
/// KHR_materials_iridescence].
Vec3 responseXyz(float way)
{
    struct Gaussian
    {
        float height, place, variance; ///< of wave numbers [1/m]
    };
    constexpr Gaussian kX{5.4856e-13f, 1.6810e6f, 4.3278e9f}, kY{4.4201e-13f, 1.7953e6f, 9.3046e9f},
        kZ{5.2481e-13f, 2.2084e6f, 6.6121e9f}, kBlueOfX{9.7470e-14f, 2.2399e6f, 4.5282e9f};
    constexpr float kWhite = 1.0685e-7f;
    const float phase = std::fmin(2.0f * kPi * way * 1e-9f, 1.0f); // there nothing is left
    const auto at = [&](const Gaussian& g)
    {
        return g.height * std::sqrt(2.0f * kPi * g.variance) * std::cos(g.place * phase) *
               std::exp(-g.variance * phase * phase) / kWhite;
    };
    return Vec3(at(kX) + at(kBlueOfX), at(kY), at(kZ));
}

/// Returns colours of ITU-R BT.709 of XYZ [IEC61966].
Vec3 rgbOf(Vec3 xyz)
{
    return {3.2404542f * xyz.x - 1.5371385f * xyz.y - 0.4985314f * xyz.z,
            -0.9692660f * xyz.x + 1.8760108f * xyz.y + 0.0415560f * xyz.z,
            0.0556434f * xyz.x - 0.2040259f * xyz.y + 1.0572252f * xyz.z};
}

/// Returns the index of a dielectric in air by its reflectance at normal incidence.
Vec3 indexOf(Vec3 normalReflectance)
{
    const Vec3 root = glm::sqrt(glm::clamp(normalReflectance, 0.0f, 0.9999f));
    return (Vec3(1.0f) + root) / (Vec3(1.0f) - root);
}

} // namespace

Vec3 filmReflectance(float cosTheta, ThinFilm film, Vec3 normalReflectance)
{
    constexpr float kFading = 30.0f; // [nm]
    const float t = glm::clamp(film.thickness / kFading, 0.0f, 1.0f);
    const float ior = 1.0f + (film.ior - 1.0f) * t * t * (3.0f - 2.0f * t);
    const float sine2 = (1.0f - cosTheta * cosTheta) / (ior * ior);
    const float cosFilm = std::sqrt(std::fmax(1.0f - sine2, 0.0f));

    const float r12 = fresnelDielectric(cosTheta, ior), t121 = 1.0f - r12;
    const Vec3 base = indexOf(normalReflectance), root = (base - ior) / (base + ior);
    const Vec3 r23 = fresnelSchlick(cosFilm, root * root, 1.0f);

    // Light that is reflected m times within the film has gone m ways to and fro. Where the base
    // has the higher index both faces turn the phase, and odd orders have the other sign.
    const float way = 2.0f * ior * film.thickness * cosFilm;
    const Vec3 r123 = glm::clamp(r12 * r23, 0.0f, 0.9999f), amplitude = glm::sqrt(r123);
    const Vec3 around = t121 * t121 * r23 / (Vec3(1.0f) - r123);
    Vec3 sum = Vec3(r12) + around, term = around - t121;
    for (int m = 1; m <= 2; ++m)
    {
        term *= amplitude;
        const Vec3 response = 2.0f * rgbOf(responseXyz(static_cast<float>(m) * way));
        for (int c = 0; c < 3; ++c)
            sum[c] += term[c] * (m == 1 && base[c] >= ior ? -response[c] : response[c]);
    }
    return glm::clamp(sum, 0.0f, 1.0f);
}

} // namespace osgRayTrace::engine
