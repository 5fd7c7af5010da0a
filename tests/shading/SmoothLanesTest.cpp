// SmoothLanesTest.cpp - sixteen rays at smooth interfaces compared with one ray at a time.
// SPDX-License-Identifier: MIT
#include "tests/Catch.h"
#include "tests/shading/BsdfKinds.h"

#include "osgRayTrace/sampling/Hash.h"
#include "osgRayTrace/sampling/Warp.h"
#include "osgRayTrace/shading/SmoothLanes.h"

#include <cmath>

using namespace osgRayTrace::engine;
using namespace osgRayTrace::engine::test;

namespace
{

constexpr float kUntouched = 1234.0f;

std::vector<BsdfKind> interfaceKinds()
{
    std::vector<BsdfKind> kinds;
    for (const std::vector<BsdfKind>& list : {smoothKinds(), extremeSmoothKinds()})
        for (const BsdfKind& kind : list)
            if (isSmoothInterface(kind.bsdf)) kinds.push_back(kind);
    BsdfKind tinted{"tinted glass", {}};
    tinted.bsdf.alpha = 0.0f;
    tinted.bsdf.coat = 1.0f;
    tinted.bsdf.eta = 1.0f / 1.7f;
    tinted.bsdf.transmission = Vec3(0.9f, 0.2f, 0.05f);
    kinds.push_back(tinted);
    BsdfKind gold{"gold", {}};
    gold.bsdf.alpha = 0.0f;
    gold.bsdf.reflectance = Vec3(1.0f, 0.7f, 0.3f);
    gold.bsdf.grazing = 1.0f;
    kinds.push_back(gold);
    BsdfKind black{"black", {}};
    black.bsdf.alpha = 0.0f;
    kinds.push_back(black);
    return kinds;
}

float number(uint32_t i)
{
    return static_cast<float>(hash(i) >> 8) * 0x1p-24f;
}

/// Holds sixteen rays, each at a surface of its own.
struct Block
{
    const Bsdf* bsdfs[kLanes];
    InterfaceLanes interfaces;
    Vec3Lanes direction, normal, wi, weight;
    FloatLanes lobe;
};

Block blockOf(const std::vector<BsdfKind>& kinds, uint32_t round)
{
    Block block;
    for (int i = 0; i < kLanes; ++i)
    {
        const uint32_t k = 8 * (round * kLanes + static_cast<uint32_t>(i));
        block.bsdfs[i] = &kinds[hash(k) % kinds.size()].bsdf;
        block.interfaces.set(i, *block.bsdfs[i]);
        const Vec3 normal = squareToCosineHemisphere(number(k + 1), number(k + 2));
        const Vec3 across = glm::normalize(glm::cross(normal, Vec3(0.6f, 0.64f, -0.48f)));
        // The angles go from normal to grazing incidence; some rays come from below.
        const float angle = 1.6f * number(k + 3);
        setLane(block.normal, i, normal);
        setLane(block.direction, i,
                glm::normalize(across * std::sin(angle) - normal * std::cos(angle)));
        setLane(block.wi, i, Vec3(kUntouched));
        setLane(block.weight, i, Vec3(kUntouched));
        block.lobe[i] = number(k + 4);
    }
    return block;
}

bool near(Vec3 a, Vec3 b, float bound)
{
    const Vec3 d = glm::abs(a - b);
    return d.x <= bound && d.y <= bound && d.z <= bound;
}

} // namespace

TEST_CASE("smooth lanes: what sampleBsdf says of each, and the other lanes untouched", "[shading]")
{
    const std::vector<BsdfKind> kinds = interfaceKinds();
    REQUIRE(kinds.size() > 12);
    int compared = 0, refracted = 0, discarded = 0, undecided = 0;
    for (const Transport transport : {Transport::Radiance, Transport::Importance})
        for (uint32_t round = 0; round < 4000; ++round)
        {
            Block block = blockOf(kinds, round);
            const LaneMask lanes = hash(round + 77) & kAllLanes;
            const IncidentLanes incident{block.direction.x, block.direction.y, block.direction.z,
                                         block.normal};
            const SmoothLanes result = sampleSmoothLanes(block.interfaces, incident, block.lobe,
                                                         lanes, transport, block.wi, block.weight);
            REQUIRE((result.alive & ~lanes) == 0);
            REQUIRE((result.transmitted & ~result.alive) == 0);
            for (int i = 0; i < kLanes; ++i)
            {
                const Vec3 wi = laneOf(block.wi, i), weight = laneOf(block.weight, i);
                if (!((lanes >> i) & 1u))
                {
                    REQUIRE(wi == Vec3(kUntouched));
                    REQUIRE(weight == Vec3(kUntouched));
                    continue;
                }
                const Vec3 normal = laneOf(block.normal, i), d = laneOf(block.direction, i);
                Vec3 tangent, bitangent;
                frameOf(normal.x, normal.y, normal.z, tangent, bitangent);
                const Vec3 wo(-glm::dot(d, tangent), -glm::dot(d, bitangent), -glm::dot(d, normal));
                if (std::fabs(wo.z) < 1e-6f) continue; // rounding decides on the side
                const std::optional<BsdfSample> sample =
                    sampleBsdf(*block.bsdfs[i], wo, block.lobe[i], 0.5f, 0.5f, transport);
                const bool alive = (result.alive >> i) & 1u;
                const bool transmitted = (result.transmitted >> i) & 1u;
                CAPTURE(round, i, wo.z, block.lobe[i], block.bsdfs[i]->eta);
                if (alive != sample.has_value() || (sample && transmitted != sample->transmitted))
                {
                    // The lobe number may be within rounding of its bound, also at the critical
                    // angle.
                    ++undecided;
                    continue;
                }
                ++compared;
                discarded += !alive;
                if (!alive) continue;
                refracted += transmitted;
                REQUIRE(sample->delta);
                const Vec3 expected =
                    tangent * sample->wi.x + bitangent * sample->wi.y + normal * sample->wi.z;
                // Refraction at grazing angles takes a root of a small remainder.
                REQUIRE(near(wi, expected, 1e-3f));
                REQUIRE(std::fabs(glm::length(wi) - 1.0f) < 1e-6f);
                const float largest =
                    std::max(sample->weight.x, std::max(sample->weight.y, sample->weight.z));
                REQUIRE(near(weight, sample->weight, 1e-4f * (1.0f + largest)));
            }
        }
    CHECK(compared > 60000);
    CHECK(refracted > 10000);
    CHECK(discarded > 1000);
    CHECK(undecided <= 4);
}
