// LayeredBsdf.cpp - samples and evaluates surfaces with layers. Layer: shading.
// SPDX-License-Identifier: MIT
#include "osgRayTrace/shading/LayeredBsdf.h"

#include "osgRayTrace/shading/ClearCoat.h"
#include "osgRayTrace/shading/Facet.h"
#include "osgRayTrace/shading/LayeredTerms.h"

#include <algorithm>
#include <cmath>

namespace osgRayTrace::engine
{

namespace
{

/// Returns the widths of the facets along the tangent and across.
GgxWidths widthsOf(const Bsdf& b)
{
    return {b.isAnisotropic() ? b.alphaTangent : b.alpha, b.alpha};
}

Vec3 fromFacets(const Bsdf& b, Vec3 w)
{
    if (!b.isAnisotropic()) return w;
    const Vec2 t = b.tangent;
    return {w.x * t.x - w.y * t.y, w.x * t.y + w.y * t.x, w.z};
}

/// Returns whether light passes the interface by a delta lobe; as for surfaces without layers.
bool transmitsSmoothly(const Bsdf& b, Vec3 wo)
{
    constexpr float kSmoothBend = 3e-5f;
    if (b.isSmooth()) return true;
    const float widest = std::max(b.alpha, b.alphaTangent);
    return !b.thin && std::fabs(b.eta - 1.0f) * widest < kSmoothBend * wo.z * wo.z;
}

float reflectedLayers(const Bsdf& b, Vec3 wo, Vec3 wi)
{
    return b.inside ? 1.0f : std::min(belowLayers(b, wo), belowLayers(b, wi));
}

float refractionScale(const Bsdf& b, Transport transport)
{
    const float eta = b.transmittedEta();
    return transport == Transport::Radiance ? 1.0f / (eta * eta) : 1.0f;
}

/// Holds the probabilities of the lobes for wo: they sum to 1, or are all 0.
struct LobePmf
{
    float sheen = 0.0f, clearcoat = 0.0f, base = 0.0f;
    float through = 0.0f;   ///< diffuse transmission
    float interface = 0.0f; ///< reflection and transmission
    bool any = false;
};

LobePmf lobePmf(const Bsdf& b, Vec3 wo)
{
    LobePmf pmf;
    if (hasSheen(b)) pmf.sheen = luminance(b.sheen) * sheenAlbedo(b.sheenAlpha, wo.z);
    float below = b.inside ? 1.0f : belowSheen(b, wo.z);
    if (hasClearcoat(b))
    {
        const float cosCoat = coatCosine(b, wo);
        const float albedo = b.clearcoat * clearcoatAlbedo(b, cosCoat);
        if (cosCoat > 0.0f) pmf.clearcoat = albedo * below;
        below *= 1.0f - albedo;
    }
    const Vec3 fresnel = interfaceFresnel(b, wo.z);
    const float toBase = belowInterface(b, wo.z);
    pmf.base = luminance(b.diffuse) * toBase * below;
    pmf.through = luminance(b.diffuseTransmission) * toBase * below;
    pmf.interface = (luminance(reflectionFresnel(b, wo.z)) +
                     luminance(b.transmission * (Vec3(1.0f) - fresnel))) *
                    below;
    const float sum = pmf.sheen + pmf.clearcoat + pmf.base + pmf.interface + pmf.through;
    if (!(sum > 0.0f)) return {};
    pmf.sheen /= sum;
    pmf.clearcoat /= sum;
    pmf.base /= sum;
    pmf.through /= sum;
    pmf.interface /= sum;
    pmf.any = true;
    return pmf;
}

/// Returns the share of the interface that is reflected at a facet that wo meets under a cosine.
float reflectedShare(const Bsdf& b, float cosH)
{
    if (!b.transmits()) return 1.0f;
    const float reflected = luminance(reflectionFresnel(b, cosH));
    const float passed = luminance(b.transmission * (Vec3(1.0f) - interfaceFresnel(b, cosH)));
    return passed > 0.0f ? reflected / (reflected + passed) : 1.0f;
}

/// Adds a rough clear coat with the normal of the surface.
void addClearcoat(const Bsdf& b, Vec3 wo, Vec3 wi, float pmf, BsdfValue& value)
{
    const Facet facet = facetOf(wo, wi, b.clearcoatAlpha);
    const float below = std::min(belowSheen(b, wo.z), belowSheen(b, wi.z));
    value.fCos +=
        Vec3(b.clearcoat * fresnelDielectric(facet.cosH, kClearcoatIndex) * facet.value * below);
    value.pdfW += pmf * facet.pdfW;
}

void addSameSide(const Bsdf& b, Vec3 wo, Vec3 wi, const LobePmf& pmf, Transport transport,
                 BsdfValue& value)
{
    const float uniform = squareToCosineHemispherePdf(wi.z);
    if (b.diffuse != Vec3(0.0f))
        value.fCos +=
            b.diffuse * (kInvPi * wi.z * aboveBase(b, wi) * aboveBase(b, wo) / b.baseAverage);
    value.pdfW += (pmf.base + pmf.sheen) * uniform;
    if (hasSheen(b)) value.fCos += b.sheen * (evalSheen(b.sheenAlpha, wo, wi) * wi.z);
    if (hasClearcoat(b) && !isClearcoatSmooth(b))
    {
        if (b.coatTilted)
            addTiltedClearcoat(b, wo, wi, pmf.clearcoat, transport, value);
        else
            addClearcoat(b, wo, wi, pmf.clearcoat, value);
    }
    if (b.reflects() && !b.isSmooth())
    {
        const Facet facet = facetOf(wo, wi, widthsOf(b));
        const float share = reflectedShare(b, transmitsSmoothly(b, wo) ? wo.z : facet.cosH);
        value.fCos += reflectionFresnel(b, facet.cosH) * (facet.value * reflectedLayers(b, wo, wi));
        value.pdfW += pmf.interface * share * facet.pdfW;
    }
}

/// Adds light that the base diffuses to the other side.
void addDiffused(const Bsdf& b, Vec3 wo, Vec3 wi, const LobePmf& pmf, BsdfValue& value)
{
    value.fCos += b.diffuseTransmission *
                  (kInvPi * -wi.z * aboveBase(b, wi) * aboveBase(b, wo) / b.baseAverage);
    value.pdfW += pmf.through * squareToCosineHemispherePdf(-wi.z);
}

/// Adds light that passes the facets of a rough thin wall: their reflection, on the other side.
void addThrough(const Bsdf& b, Vec3 wo, Vec3 wi, const LobePmf& pmf, BsdfValue& value)
{
    const Facet facet = facetOf(wo, Vec3(wi.x, wi.y, -wi.z), widthsOf(b));
    const Vec3 passed = b.transmission * (Vec3(1.0f) - interfaceFresnel(b, facet.cosH));
    value.fCos += passed * (facet.value * passedLayers(b, wo, wi));
    value.pdfW += pmf.interface * (1.0f - reflectedShare(b, facet.cosH)) * facet.pdfW;
}

/// Adds refraction, as for surfaces without layers [Walter07, eq. 21]: see Bsdf.cpp.
void addRefraction(const Bsdf& b, Vec3 wo, Vec3 wi, const LobePmf& pmf, Transport transport,
                   BsdfValue& value)
{
    Vec3 h = -((wo + wi) + wi * (b.eta - 1.0f));
    const float length2 = glm::dot(h, h);
    if (length2 < 1e-14f) return;
    h /= std::sqrt(length2);
    if (h.z < 0.0f) h = -h;
    const float cosO = glm::dot(wo, h), cosI = glm::dot(wi, h);
    if (cosO <= 0.0f || cosI >= 0.0f) return;
    const GgxWidths alpha = widthsOf(b);
    const float d = evalGgx(h, alpha) * cosO / wo.z;
    const float jacobian = b.eta * b.eta * -cosI / length2;
    const float g1 = ggxG1(wo, alpha);
    const Vec3 passed = b.transmission * (Vec3(1.0f) - interfaceFresnel(b, cosO));
    value.fCos += passed * (d * g1 * ggxG1(-wi, alpha) * jacobian * refractionScale(b, transport) *
                            passedLayers(b, wo, wi));
    value.pdfW += pmf.interface * (1.0f - reflectedShare(b, cosO)) * g1 * d * jacobian;
}

Vec3 passedShare(const Bsdf& b, Vec3 wo, Vec3 wi, Transport transport)
{
    return b.transmission * (Vec3(1.0f) - interfaceFresnel(b, wo.z)) *
           (refractionScale(b, transport) * passedLayers(b, wo, wi));
}

Vec3 mirroredShare(const Bsdf& b, Vec3 wo)
{
    return reflectionFresnel(b, wo.z) * reflectedLayers(b, wo, Vec3(-wo.x, -wo.y, wo.z));
}

std::optional<BsdfSample> deltaSample(Vec3 wi, Vec3 share, float pmf)
{
    BsdfSample sample;
    sample.wi = wi;
    sample.pdfW = pmf;
    sample.weight = share / pmf;
    sample.delta = true;
    sample.transmitted = wi.z < 0.0f;
    if (!(pmf > 0.0f) || wi.z == 0.0f) return std::nullopt;
    return sample;
}

std::optional<BsdfSample> sampleSmoothCoat(const Bsdf& b, Vec3 wo, float pmf, Transport transport)
{
    const Vec3 wi = clearcoatMirrored(b, wo);
    if (!(wi.z > 0.0f)) return std::nullopt;
    return deltaSample(wi, clearcoatShare(b, wo, wi, transport), pmf);
}

/// Returns a direction from the interface, nothing if there is none. The result is complete if it
/// is a delta lobe; otherwise its density and weight are not set.
std::optional<BsdfSample> sampleInterface(const Bsdf& b, Vec3 wo, float uShare, float pmf, float u,
                                          float v, Transport transport)
{
    const bool smooth = transmitsSmoothly(b, wo);
    const Vec3 h = b.isSmooth() ? Vec3(0.0f, 0.0f, 1.0f) : sampleGgxVisible(wo, widthsOf(b), u, v);
    const float cosH = glm::dot(wo, h);
    const float share = reflectedShare(b, smooth ? wo.z : cosH);
    const bool reflect = share >= 1.0f || uShare < share;
    if (reflect && b.isSmooth())
        return deltaSample(Vec3(-wo.x, -wo.y, wo.z), mirroredShare(b, wo), pmf * share);
    BsdfSample sample;
    if (reflect || (b.thin && !smooth))
    {
        sample.wi = h * (2.0f * cosH) - wo;
        if (!(sample.wi.z > 0.0f)) return std::nullopt;
        if (reflect) return sample;
        sample.wi.z = -sample.wi.z;
    }
    else
    {
        const std::optional<Vec3> wi = smooth
                                           ? refract(wo, Vec3(0.0f, 0.0f, 1.0f), b.transmittedEta())
                                           : refract(wo, h, b.eta);
        if (!wi || !(wi->z < 0.0f)) return std::nullopt;
        if (smooth)
            return deltaSample(*wi, passedShare(b, wo, *wi, transport), pmf * (1.0f - share));
        sample.wi = *wi;
    }
    sample.transmitted = true;
    return sample;
}

/// Returns a direction in the frame of the facets, nothing if there is none. The result is complete
/// if it is a delta lobe; otherwise its density and weight are not set.
std::optional<BsdfSample> sampleFacets(const Bsdf& b, Vec3 wo, float uLobe, float u, float v,
                                       Transport transport)
{
    const LobePmf pmf = lobePmf(b, wo);
    if (!pmf.any) return std::nullopt;
    BsdfSample sample;
    const float cosine = pmf.sheen + pmf.base, coated = cosine + pmf.clearcoat;
    const float interface = coated + pmf.interface;
    if (uLobe < cosine)
    {
        sample.wi = squareToCosineHemisphere(u, v);
        if (!(sample.wi.z > 0.0f)) return std::nullopt;
    }
    else if (uLobe < coated)
    {
        if (isClearcoatSmooth(b)) return sampleSmoothCoat(b, wo, pmf.clearcoat, transport);
        const Vec3 h = sampleClearcoatFacet(b, wo, u, v);
        sample.wi = h * (2.0f * glm::dot(wo, h)) - wo;
        if (!(sample.wi.z > 0.0f)) return std::nullopt;
    }
    else if (pmf.through > 0.0f && uLobe >= interface)
    {
        sample.wi = -squareToCosineHemisphere(u, v);
        if (!(sample.wi.z < 0.0f)) return std::nullopt;
        sample.transmitted = true;
    }
    else
    {
        if (!(pmf.interface > 0.0f)) return std::nullopt;
        const float uShare = std::min((uLobe - coated) / pmf.interface, 1.0f - 0x1p-24f);
        return sampleInterface(b, wo, uShare, pmf.interface, u, v, transport);
    }
    return sample;
}

/// Returns f cos of light that has been within the body. wi: in the frame of the facets.
BsdfValue evalLeaving(const Bsdf& b, Vec3 wi)
{
    BsdfValue value;
    if (!(wi.z > 0.0f)) return value;
    value.pdfW = squareToCosineHemispherePdf(wi.z);
    value.fCos = b.diffuse * (value.pdfW * aboveBase(b, wi) / b.baseAverage);
    return value;
}

std::optional<BsdfSample> sampleLeaving(const Bsdf& b, float u, float v)
{
    BsdfSample sample;
    sample.wi = squareToCosineHemisphere(u, v);
    const BsdfValue value = evalLeaving(b, toFacets(b, sample.wi));
    if (!(value.pdfW > 0.0f)) return std::nullopt;
    sample.pdfW = value.pdfW;
    sample.weight = value.fCos / value.pdfW;
    return sample;
}

} // namespace

SubsurfaceSplit splitSubsurface(const Bsdf& b, Vec3 wo, Vec3 walks)
{
    SubsurfaceSplit split;
    const Vec3 share = b.subsurface * walks;
    split.local = b;
    split.local.subsurface = 0.0f;
    split.local.diffuse = b.diffuse * (Vec3(1.0f) - share);
    split.leaving = leavingBody(b);
    split.color = glm::clamp(b.diffuse / b.baseShare, 0.0f, 1.0f);
    const Vec3 facets = toFacets(b, wo);
    split.entering = share * (b.baseShare * aboveBase(b, facets));
    const float whole = luminance(b.diffuse);
    if (whole > 0.0f)
        split.probability =
            std::min(lobePmf(b, facets).base * (luminance(b.diffuse * share) / whole), 1.0f);
    return split;
}

Bsdf leavingBody(const Bsdf& bsdf)
{
    Bsdf leaving = bsdf;
    leaving.subsurface = 0.0f;
    leaving.leavesBody = true;
    leaving.diffuse = Vec3(1.0f);
    leaving.alpha = 1.0f;
    leaving.transmission = leaving.diffuseTransmission = Vec3(0.0f);
    return leaving;
}

std::optional<BsdfSample> sampleLayered(const Bsdf& b, Vec3 wo, float uLobe, float u, float v,
                                        Transport transport)
{
    if (b.leavesBody) return sampleLeaving(b, u, v);
    std::optional<BsdfSample> sample = sampleFacets(b, toFacets(b, wo), uLobe, u, v, transport);
    if (!sample) return std::nullopt;
    sample->wi = fromFacets(b, sample->wi);
    if (sample->delta) return sample;
    const BsdfValue value = evalLayered(b, wo, sample->wi, transport);
    if (!(value.pdfW > 0.0f)) return std::nullopt;
    sample->pdfW = value.pdfW;
    sample->weight = value.fCos / value.pdfW;
    return sample;
}

BsdfValue evalLayered(const Bsdf& b, Vec3 localO, Vec3 localI, Transport transport)
{
    const Vec3 wo = toFacets(b, localO), wi = toFacets(b, localI);
    BsdfValue value;
    if (b.leavesBody) return evalLeaving(b, wi);
    const LobePmf pmf = lobePmf(b, wo);
    if (!pmf.any) return value;
    if (wi.z > 0.0f)
    {
        addSameSide(b, wo, wi, pmf, transport, value);
        return value;
    }
    if (b.diffuseTransmission != Vec3(0.0f)) addDiffused(b, wo, wi, pmf, value);
    if (!b.transmits() || transmitsSmoothly(b, wo)) return value;
    if (b.thin)
        addThrough(b, wo, wi, pmf, value);
    else
        addRefraction(b, wo, wi, pmf, transport, value);
    return value;
}

/// Adds what a smooth clear coat mirrors.
static void addClearcoatLobe(const Bsdf& b, Vec3 wo, SpecularLobes& lobes)
{
    const Vec3 wi = clearcoatMirrored(b, wo);
    const Vec3 share = clearcoatShare(b, wo, wi, Transport::Radiance);
    if (!b.coatTilted)
        lobes.reflection += share;
    else if (coatCosine(b, wo) > 0.0f)
    {
        lobes.coat = share;
        lobes.coatMirrored = fromFacets(b, wi);
    }
}

SpecularLobes layeredLobes(const Bsdf& b, Vec3 localO)
{
    const Vec3 wo = toFacets(b, localO);
    SpecularLobes lobes;
    if (b.reflects() && b.isSmooth()) lobes.reflection = mirroredShare(b, wo);
    if (hasClearcoat(b) && isClearcoatSmooth(b)) addClearcoatLobe(b, wo, lobes);
    if (!b.transmits() || !transmitsSmoothly(b, wo)) return lobes;
    const std::optional<Vec3> passed = refract(wo, Vec3(0.0f, 0.0f, 1.0f), b.transmittedEta());
    if (!passed) return lobes;
    lobes.refracted = fromFacets(b, *passed);
    lobes.refraction = passedShare(b, wo, *passed, Transport::Radiance);
    return lobes;
}

} // namespace osgRayTrace::engine
