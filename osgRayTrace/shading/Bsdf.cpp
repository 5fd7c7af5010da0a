// Bsdf.cpp - samples and evaluates the surface model. Layer: shading.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/shading/Bsdf.h"

#include "osgRayTrace/shading/Fresnel.h"
#include "osgRayTrace/shading/LayeredBsdf.h"

#include <algorithm>
#include <cmath>

namespace osgRayTrace::engine
{

namespace
{

/// Returns whether refraction has a density. Microfacets turned by alpha bend refracted rays by
/// (eta - 1) alpha / cos^2. If directions in float do not resolve that to 1 %, refraction is a
/// delta function at any roughness.
bool refractsSmoothly(const Bsdf& bsdf, Vec3 wo)
{
    constexpr float kSmoothBend = 3e-5f;
    return bsdf.isSmooth() || std::fabs(bsdf.eta - 1.0f) * bsdf.alpha < kSmoothBend * wo.z * wo.z;
}

/// Returns the reflectance of the interface that the base and the transmission lie under. This is
/// the dearest term of the model: it is computed once for each cosine and handed on.
float interfaceFresnel(const Bsdf& bsdf, float cosTheta)
{
    return bsdf.coat > 0.0f ? fresnelDielectric(cosTheta, bsdf.eta) : 0.0f;
}

Vec3 reflectionFresnel(const Bsdf& bsdf, float cosTheta, float fresnel)
{
    return fresnelSchlick(cosTheta, bsdf.reflectance, bsdf.grazing) + Vec3(bsdf.coat * fresnel);
}

/// Returns the share of the light from or to a direction that the base does not get.
float coatAlbedo(const Bsdf& bsdf, float cosTheta, float fresnel)
{
    if (!bsdf.coatRows) return fresnel;
    const float first = bsdf.coatRows[0](cosTheta), second = bsdf.coatRows[1](cosTheta);
    return first + (second - first) * bsdf.coatFraction;
}

/// Returns f cos of the base.
Vec3 evalBase(const Bsdf& bsdf, Vec3 wo, float fresnelO, Vec3 wi)
{
    const Vec3 lambert = bsdf.diffuse * (kInvPi * wi.z);
    if (bsdf.coat == 0.0f || bsdf.diffuse == Vec3(0.0f)) return lambert;
    const float fresnelI = bsdf.coatRows ? 0.0f : interfaceFresnel(bsdf, wi.z);
    return lambert * ((1.0f - coatAlbedo(bsdf, wi.z, fresnelI)) *
                      (1.0f - coatAlbedo(bsdf, wo.z, fresnelO)) / (1.0f - coatAverage(bsdf)));
}

/// Holds the probabilities of the base and of the interface for wo; they sum to 1, or are all 0 for
/// a black surface.
struct LobePmf
{
    float base = 0.0f;
    float interface = 0.0f; ///< reflection and refraction
};

LobePmf lobePmf(const Bsdf& bsdf, Vec3 wo, float fresnelO)
{
    const float below = 1.0f - coatAlbedo(bsdf, wo.z, fresnelO);
    LobePmf pmf;
    pmf.base = luminance(bsdf.diffuse) * below;
    pmf.interface =
        luminance(reflectionFresnel(bsdf, wo.z, fresnelO)) + luminance(bsdf.transmission) * below;
    const float sum = pmf.base + pmf.interface;
    if (!(sum > 0.0f)) return {};
    pmf.base /= sum;
    pmf.interface /= sum;
    return pmf;
}

/// Returns the share of the interface that is reflected, at a microfacet that wo meets under this
/// cosine. The share has to be that of the facet and not of the surface: beyond the critical angle
/// a rough surface still has facets that light passes, and light that is never sampled is lost.
float reflectedShare(const Bsdf& bsdf, float cosH, float fresnelH)
{
    if (!bsdf.transmits()) return 1.0f;
    const float reflected = luminance(reflectionFresnel(bsdf, cosH, fresnelH));
    const float refracted = luminance(bsdf.transmission) * (1.0f - fresnelH);
    return refracted > 0.0f ? reflected / (reflected + refracted) : 1.0f;
}

/// Radiance is compressed into the smaller solid angle of the denser side [Veach97, sect. 5.2].
float refractionScale(const Bsdf& bsdf, Transport transport)
{
    return transport == Transport::Radiance ? 1.0f / (bsdf.eta * bsdf.eta) : 1.0f;
}

void addReflection(const Bsdf& bsdf, Vec3 wo, float fresnelO, Vec3 wi, float pmf, BsdfValue& value)
{
    const Vec3 sum = wo + wi;
    const float length2 = glm::dot(sum, sum);
    if (length2 < 1e-14f) return;
    const float length = std::sqrt(length2);
    const Vec3 h = sum / length;
    const float cosH = 0.5f * length; // equal for wo and wi, to the last bit
    const float d = evalGgx(h, bsdf.alpha);
    const float fresnelH = interfaceFresnel(bsdf, cosH);
    pmf *= refractsSmoothly(bsdf, wo) ? reflectedShare(bsdf, wo.z, fresnelO)
                                      : reflectedShare(bsdf, cosH, fresnelH);
    value.fCos +=
        reflectionFresnel(bsdf, cosH, fresnelH) * (d * ggxG2(wo, wi, bsdf.alpha) / (4.0f * wo.z));
    value.pdfW += pmf * ggxG1(wo, bsdf.alpha) * d / (4.0f * wo.z);
}

void addRefraction(const Bsdf& bsdf, Vec3 wo, Vec3 wi, float pmf, Transport transport,
                   BsdfValue& value)
{
    // h is wo + eta wi, in a form that keeps its digits if wi is nearly -wo.
    Vec3 h = -((wo + wi) + wi * (bsdf.eta - 1.0f));
    const float length2 = glm::dot(h, h);
    if (length2 < 1e-14f) return;
    h /= std::sqrt(length2);
    if (h.z < 0.0f) h = -h;
    const float cosO = glm::dot(wo, h);
    const float cosI = glm::dot(wi, h);
    if (cosO <= 0.0f || cosI >= 0.0f) return;

    const float d = evalGgx(h, bsdf.alpha);
    // (cosO + eta cosI)^2 of [Walter07, eq. 21] is the square of this vector's length, which loses
    // no digits.
    const float jacobian = bsdf.eta * bsdf.eta * -cosI / length2;
    const float fresnelH = interfaceFresnel(bsdf, cosO);
    const float transmittance = 1.0f - fresnelH;
    // Masking and shadowing on opposite sides multiply [Walter07, eq. 23].
    const float g = ggxG1(wo, bsdf.alpha) * ggxG1(-wi, bsdf.alpha);
    value.fCos += bsdf.transmission * (transmittance * d * g * cosO * jacobian *
                                       refractionScale(bsdf, transport) / wo.z);
    value.pdfW += pmf * (1.0f - reflectedShare(bsdf, cosO, fresnelH)) * ggxG1(wo, bsdf.alpha) *
                  cosO * d / wo.z * jacobian;
}

std::optional<BsdfSample> sampleSmooth(const Bsdf& bsdf, Vec3 wo, float fresnelO, float pmf,
                                       bool reflect, Transport transport)
{
    BsdfSample sample;
    sample.delta = true;
    if (reflect)
    {
        sample.wi = Vec3(-wo.x, -wo.y, wo.z);
        sample.pdfW = pmf;
        sample.weight = reflectionFresnel(bsdf, wo.z, fresnelO) / pmf;
        return sample;
    }
    const std::optional<Vec3> wi = refract(wo, Vec3(0.0f, 0.0f, 1.0f), bsdf.eta);
    if (!wi) return std::nullopt;
    sample.wi = *wi;
    sample.pdfW = pmf;
    sample.weight =
        bsdf.transmission * ((1.0f - fresnelO) * refractionScale(bsdf, transport) / pmf);
    sample.transmitted = true;
    return sample;
}

} // namespace

float coatAverage(const Bsdf& bsdf)
{
    if (!bsdf.coatRows) return bsdf.coatAverage;
    const float first = bsdf.coatRows[0].average, second = bsdf.coatRows[1].average;
    return first + (second - first) * bsdf.coatFraction;
}

std::optional<BsdfSample> sampleBsdf(const Bsdf& bsdf, Vec3 wo, float uLobe, float u, float v,
                                     Transport transport)
{
    if (!(wo.z > 0.0f)) return std::nullopt;
    if (bsdf.layered) return sampleLayered(bsdf, wo, uLobe, u, v, transport);
    const float fresnelO = interfaceFresnel(bsdf, wo.z);
    const LobePmf pmf = lobePmf(bsdf, wo, fresnelO);
    if (pmf.base + pmf.interface <= 0.0f) return std::nullopt;

    BsdfSample sample;
    if (uLobe < pmf.base)
    {
        sample.wi = squareToCosineHemisphere(u, v);
        if (!(sample.wi.z > 0.0f)) return std::nullopt;
    }
    else
    {
        const bool smooth = refractsSmoothly(bsdf, wo);
        const Vec3 h =
            bsdf.isSmooth() ? Vec3(0.0f, 0.0f, 1.0f) : sampleGgxVisible(wo, bsdf.alpha, u, v);
        const float cosH = glm::dot(wo, h);
        const float share =
            smooth ? reflectedShare(bsdf, wo.z, fresnelO)
                   : reflectedShare(bsdf, cosH,
                                    bsdf.transmits() ? interfaceFresnel(bsdf, cosH) : 0.0f);
        const bool reflect = share >= 1.0f || uLobe < pmf.base + pmf.interface * share;
        if (reflect ? bsdf.isSmooth() : smooth)
            return sampleSmooth(bsdf, wo, fresnelO,
                                pmf.interface * (reflect ? share : 1.0f - share), reflect,
                                transport);
        if (reflect)
        {
            sample.wi = h * (2.0f * cosH) - wo;
            if (!(sample.wi.z > 0.0f)) return std::nullopt;
        }
        else
        {
            const std::optional<Vec3> wi = refract(wo, h, bsdf.eta);
            if (!wi || !(wi->z < 0.0f)) return std::nullopt;
            sample.wi = *wi;
            sample.transmitted = true;
        }
    }
    const BsdfValue value = evalBsdf(bsdf, wo, sample.wi, transport);
    if (!(value.pdfW > 0.0f)) return std::nullopt;
    sample.pdfW = value.pdfW;
    sample.weight = value.fCos / value.pdfW;
    return sample;
}

BsdfValue evalBsdf(const Bsdf& bsdf, Vec3 wo, Vec3 wi, Transport transport)
{
    BsdfValue value;
    if (!(wo.z > 0.0f) || wi.z == 0.0f) return value;
    if (bsdf.layered) return evalLayered(bsdf, wo, wi, transport);
    const float fresnelO = interfaceFresnel(bsdf, wo.z);
    const LobePmf pmf = lobePmf(bsdf, wo, fresnelO);
    if (wi.z > 0.0f)
    {
        value.fCos = evalBase(bsdf, wo, fresnelO, wi);
        value.pdfW = pmf.base * squareToCosineHemispherePdf(wi.z);
        if (bsdf.reflects() && !bsdf.isSmooth())
            addReflection(bsdf, wo, fresnelO, wi, pmf.interface, value);
    }
    else if (bsdf.transmits() && !refractsSmoothly(bsdf, wo))
    {
        addRefraction(bsdf, wo, wi, pmf.interface, transport, value);
    }
    return value;
}

SpecularLobes specularLobes(const Bsdf& bsdf, Vec3 wo)
{
    SpecularLobes lobes;
    if (!(wo.z > 0.0f)) return lobes;
    if (bsdf.layered) return layeredLobes(bsdf, wo);
    const float fresnelO = interfaceFresnel(bsdf, wo.z);
    if (bsdf.reflects() && bsdf.isSmooth())
        lobes.reflection = reflectionFresnel(bsdf, wo.z, fresnelO);
    if (!bsdf.transmits() || !refractsSmoothly(bsdf, wo)) return lobes;
    const std::optional<Vec3> refracted = refract(wo, Vec3(0.0f, 0.0f, 1.0f), bsdf.eta);
    if (!refracted) return lobes;
    lobes.refracted = *refracted;
    lobes.refraction =
        bsdf.transmission * ((1.0f - fresnelO) * refractionScale(bsdf, Transport::Radiance));
    return lobes;
}

} // namespace osgRayTrace::engine
