// LightImportanceTest.cpp - what nodes of a light tree may send to a point: the variance of choices
// by it, the boxes that it reads, and nodes whose lights are all behind a surface or face away.
// SPDX-License-Identifier: MIT
#include "tests/Catch.h"
#include "tests/EngineScenes.h"
#include "tests/Statistics.h"

#include "osgRayTrace/shading/LightImportance.h"
#include "osgRayTrace/shading/LightTable.h"

using namespace osgRayTrace::engine;
using namespace osgRayTrace::engine::test;

namespace
{

Vec3 directionOf(Uniform& random)
{
    const double z = random.between(-1, 1), turn = random.between(0, 2 * M_PI);
    const double r = std::sqrt(1 - z * z);
    return {r * std::cos(turn), r * std::sin(turn), z};
}

constexpr float kSide = 0.1f;

enum class Lamps
{
    Hanging, ///< anywhere, all of them shine down
    Turned,  ///< anywhere, all directions
    Streets, ///< on lines 4.5 off multiples of 30, all of them shine down
};

/// Returns a thousand square lamps 5 to 6 above a square of 300 x 300 for streets, else 100 x 100.
SceneBuilder lampsAbove(Lamps lamps)
{
    Uniform random(1);
    SceneBuilder builder;
    for (int i = 0; i < 1000; ++i)
    {
        double x = random.between(0, 100), y = random.between(0, 100), z = random.between(5, 6);
        if (lamps == Lamps::Streets)
        {
            const double across = 30.0 * std::floor(x / 10.0) + (i % 4 < 2 ? 4.5 : -4.5);
            x = i % 2 ? across : 3.0 * y;
            y = i % 2 ? 3.0 * y : across;
            z = 6.0;
        }
        const Vec3 place(x, y, z);
        const Vec3 normal = lamps == Lamps::Turned ? directionOf(random) : Vec3(0, 0, -1);
        const Vec3 u = glm::normalize(glm::cross(normal, Vec3(0.6f, 0.8f, 0.1f))) * kSide;
        const Vec3 v = glm::cross(normal, u);
        builder.addQuadLight(place - 0.5f * (u + v), u, v, Vec3(1.0f));
    }
    return builder;
}

/// Returns the irradiance at a point from a small lamp of radiance 1 over its area.
double irradiance(const LightEmitter& e, Vec3 p, Vec3 normal)
{
    const Vec3d u(e.edgeU[0], e.edgeU[1], e.edgeU[2]), v(e.edgeV[0], e.edgeV[1], e.edgeV[2]);
    const Vec3d d = Vec3d(e.corner[0], e.corner[1], e.corner[2]) + 0.5 * (u + v) - Vec3d(p);
    const double cosines =
        std::max(0.0, glm::dot(d, Vec3d(normal))) *
        std::max(0.0, -glm::dot(d, glm::normalize(glm::cross(u, v)))); // times |d|^2
    return cosines / (glm::dot(d, d) * glm::dot(d, d));
}

/// Returns the variance of a choice of the tree over the square of the mean: sum f^2 / pmf / S^2
/// - 1.
double relativeVariance(const SceneLightTree& tree, Vec3 p, Vec3 normal)
{
    double sum = 0.0, squares = 0.0;
    for (uint32_t e = 0; e < tree.size(); ++e)
    {
        const double f = irradiance(tree.emitter(e), p, normal);
        if (!(f > 0.0)) continue;
        const double pmf = tree.pmf(p, normal, e);
        REQUIRE(pmf > 0.0);
        sum += f;
        squares += f * f / pmf;
    }
    return squares / (sum * sum) - 1.0;
}

} // namespace

TEST_CASE("light importance: a choice among a thousand lamps near a point has little variance",
          "[shading]")
{
    struct Case
    {
        Lamps lamps;
        Vec3 place, normal; ///< the place along streets and above ground; the rest is by chance
        double most;
    };
    const Vec3 up(0, 0, 1), across(-1, 0, 0);
    for (const Case& at :
         {Case{Lamps::Hanging, {0, 0, 0}, up, 0.3}, Case{Lamps::Hanging, {0, 0, 2}, up, 0.4},
          Case{Lamps::Hanging, {0, 0, 2}, across, 0.8}, Case{Lamps::Turned, {0, 0, 0}, up, 1.1},
          Case{Lamps::Turned, {0, 0, 2}, across, 2.0}, Case{Lamps::Streets, {0, 0, 0}, up, 0.7},
          Case{Lamps::Streets, {6, 0, 2}, across, 2.0}})
    {
        const SceneBuilder builder = lampsAbove(at.lamps);
        const LightTable table(*builder.scene);
        Uniform random(2);
        double mean = 0.0;
        constexpr int kPoints = 60;
        for (int k = 0; k < kPoints; ++k)
        {
            const double x = random.between(5, 95), y = random.between(5, 95);
            Vec3 p = at.place + Vec3(x, y, 0);
            if (at.lamps == Lamps::Streets) p = at.place + Vec3(30.0 * (1 + k % 8), 3.0 * y, 0);
            mean += relativeVariance(*table.tree(), p, at.normal) / kPoints;
        }
        CAPTURE(int(at.lamps), at.place.z, at.normal.x, mean);
        CHECK(mean < at.most);
    }
}

TEST_CASE("light importance: a node's extents hold its box, in steps of a thousandth", "[shading]")
{
    Uniform random(3);
    for (int i = 0; i < 20000; ++i)
    {
        LightBounds bounds;
        for (int c = 0; c < 3; ++c)
        {
            bounds.low[c] = static_cast<float>(random.between(-5, 5));
            const bool flat = ((i >> c) & 1) == 0;
            bounds.high[c] = bounds.low[c] + static_cast<float>(flat ? 0 : random.between(0, 3));
        }
        const LightNode node = nodeOf(bounds, 0);
        const Vec3d half = 0.5 * (Vec3d(bounds.high) - Vec3d(bounds.low));
        const double step = double(node.radius) / 1023.0;
        for (int c = 0; c < 3; ++c)
        {
            Vec3 along(0.0f);
            along[c] = -1.0f;
            const double extent = extentAlong(halfExtents(node), plainOf(along));
            REQUIRE(extent >= half[c] * (1.0 - 1e-6));
            REQUIRE(extent <= half[c] + 1.01 * step);
        }
    }
}

TEST_CASE("light importance: both kinds of nodes agree, and are 0 where no light can come from",
          "[shading]")
{
    Uniform random(4);
    int dark = 0, lit = 0;
    for (int i = 0; i < 100000; ++i)
    {
        LightBounds bounds;
        const Vec3 size = glm::abs(directionOf(random)) * static_cast<float>(random.between(0, 2));
        bounds.low = directionOf(random) * 2.0f;
        bounds.high = bounds.low + size;
        bounds.axis = directionOf(random);
        bounds.cosCone = i % 3 == 0 ? 1.0f : static_cast<float>(random.between(-1, 1));
        bounds.intensity = 1.0f;
        bounds.twoSided = i % 5 == 0;
        const LightNode node = nodeOf(bounds, 0);
        const Vec3 p = directionOf(random) * static_cast<float>(random.between(0, 4));
        const Vec3 normal = i % 7 == 0 ? Vec3(0.0f) : directionOf(random);
        const float areas = importance<NodeLights::Areas>(node, plainOf(p), plainOf(normal));
        const float any = importance<NodeLights::Any>(node, plainOf(p), plainOf(normal));
        REQUIRE(areas >= 0.0f);
        REQUIRE(any == Approx(areas).epsilon(1e-4));

        // The nearest that any light in the box comes to shine on the surface.
        double above = -kInfinity;
        for (int corner = 0; corner < 8; ++corner)
        {
            const Vec3 q = bounds.low + size * Vec3(corner & 1, (corner >> 1) & 1, corner >> 2);
            above = std::max(above, double(glm::dot(q - p, normal)));
        }
        if (normal == Vec3(0.0f)) above = 1.0;
        if (above > 1e-3 && (bounds.cosCone < -0.999f)) REQUIRE(areas > 0.0f);
        if (above < -0.01)
        {
            REQUIRE(areas == 0.0f);
            ++dark;
        }
        else
            ++lit;
    }
    CHECK(dark > 10000);
    CHECK(lit > 10000);
}
