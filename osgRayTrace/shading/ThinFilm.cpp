// ThinFilm.cpp - interference of light that a film reflects at its two faces. Layer: shading.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/shading/ThinFilm.h"

#include "osgRayTrace/shading/Fresnel.h"

#include <cmath>

namespace osgRayTrace::engine
{

namespace
{

/// Holds XYZ over that of white for the first two orders of interference.
struct Responses
{
    Vec3 first, second;
};

/// Returns the Fourier transform of the eye's response for an optical path difference [nm] and for
/// twice of it, in XYZ over that of white: a Gaussian for each colour and a second one for X
/// [Belcour17, sect. 4; glTF20, KHR_materials_iridescence].
Responses responsesXyz(float pathDifference)
{
    struct Gaussian
    {
        float height, place, variance; ///< of wave numbers [1/m]
    };
    constexpr Gaussian kX{5.4856e-13f, 1.6810e6f, 4.3278e9f}, kY{4.4201e-13f, 1.7953e6f, 9.3046e9f},
        kZ{5.2481e-13f, 2.2084e6f, 6.6121e9f}, kBlueOfX{9.7470e-14f, 2.2399e6f, 4.5282e9f};
    constexpr float kWhite = 1.0685e-7f;
    const float phase =
        std::fmin(2.0f * kPi * pathDifference * 1e-9f, 1.0f); // the response is 0 from there on
    Vec2 sums[4];
    const Gaussian gaussians[] = {kX, kY, kZ, kBlueOfX};
    for (int k = 0; k < 4; ++k)
    {
        const Gaussian& g = gaussians[k];
        const float peak = g.height * std::sqrt(2.0f * kPi * g.variance) / kWhite;
        const float wave = std::cos(g.place * phase), fade = std::exp(-g.variance * phase * phase);
        const float fade2 = fade * fade; // twice the phase has the fourth power
        sums[k] = peak * Vec2(wave * fade, (2.0f * wave * wave - 1.0f) * fade2 * fade2);
    }
    const auto xyz = [&](int order)
    { return Vec3(sums[0][order] + sums[3][order], sums[1][order], sums[2][order]); };
    return {xyz(0), xyz(1)};
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

    // The order m of interference is light that the base has reflected m times; its optical path
    // difference is m times that of the first. Where the base has the higher index, both faces
    // shift the phase by pi, and odd orders have the other sign.
    const float pathDifference = 2.0f * ior * film.thickness * cosFilm;
    const Vec3 r123 = glm::clamp(r12 * r23, 0.0f, 0.9999f), amplitude = glm::sqrt(r123);
    const Vec3 around = t121 * t121 * r23 / (Vec3(1.0f) - r123);
    Vec3 sum = Vec3(r12) + around, term = around - t121;
    const Responses responses = responsesXyz(pathDifference);
    for (int m = 1; m <= 2; ++m)
    {
        term *= amplitude;
        const Vec3 response = 2.0f * rgbOf(m == 1 ? responses.first : responses.second);
        for (int c = 0; c < 3; ++c)
            sum[c] += term[c] * (m == 1 && base[c] >= ior ? -response[c] : response[c]);
    }
    return glm::clamp(sum, 0.0f, 1.0f);
}

} // namespace osgRayTrace::engine
