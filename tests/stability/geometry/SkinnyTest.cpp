// SkinnyTest.cpp - hits of rays at grazing angles on skinny triangles lie on the triangles. Layer:
// tests.
// SPDX-License-Identifier: MIT
#include "tests/Catch.h"
#include "tests/EngineScenes.h"
#include "tests/Rays.h"
#include "tests/Statistics.h"

#include "osgRayTrace/accel/Intersector.h"
#include "osgRayTrace/accel/Surface.h"

using namespace osgRayTrace::engine;
using namespace osgRayTrace::engine::test;

namespace
{

struct Triangle
{
    Vec3d corners[3]; ///< as they are in float
    Vec3d along;      ///< unit, the long side
    Vec3d normal;     ///< unit
};

Vec3d randomUnit(Uniform& random)
{
    const double z = random.between(-1, 1), phi = random.between(0, 2.0 * M_PI),
                 r = std::sqrt(1.0 - z * z);
    return {r * std::cos(phi), r * std::sin(phi), z};
}

Triangle skinny(double length, double aspect, Uniform& random)
{
    const Vec3d along = randomUnit(random);
    const Vec3d across = glm::normalize(glm::cross(along, randomUnit(random)));
    const Vec3d start =
        length * Vec3d(random.between(-1, 1), random.between(-1, 1), random.between(-1, 1));
    Triangle t;
    t.corners[0] = Vec3d(Vec3(start));
    t.corners[1] = Vec3d(Vec3(start + length * along));
    t.corners[2] =
        Vec3d(Vec3(start + random.between(0.2, 0.8) * length * along + length / aspect * across));
    t.along = glm::normalize(t.corners[1] - t.corners[0]);
    t.normal = glm::normalize(glm::cross(t.corners[1] - t.corners[0], t.corners[2] - t.corners[0]));
    return t;
}

double distanceToSegment(const Vec3d& p, const Vec3d& a, const Vec3d& b)
{
    const double s = glm::clamp(glm::dot(p - a, b - a) / glm::dot(b - a, b - a), 0.0, 1.0);
    return glm::length(p - (a + s * (b - a)));
}

double distanceTo(const Triangle& t, const Vec3d& p)
{
    bool inside = true;
    double nearest = kInfinity;
    for (int i = 0; i < 3; ++i)
    {
        const Vec3d &a = t.corners[i], &b = t.corners[(i + 1) % 3];
        inside = inside && glm::dot(glm::cross(b - a, p - a), t.normal) >= 0.0;
        nearest = std::min(nearest, distanceToSegment(p, a, b));
    }
    return inside ? std::abs(glm::dot(p - t.corners[0], t.normal)) : nearest;
}

} // namespace

TEST_CASE("stability 7: grazing rays meet skinny triangles on them", "[stability]")
{
    Uniform random(7);
    for (const double length : {1e-3, 10.0, 1e4})
    {
        int hits = 0;
        double worst = 0.0; // [ulp of the largest coordinate]
        for (int k = 0; k < 100; ++k)
        {
            const Triangle t = skinny(length, 1e3, random);
            SceneBuilder builder;
            builder.add(
                newMesh({Vec3(t.corners[0]), Vec3(t.corners[1]), Vec3(t.corners[2])}, {{0, 1, 2}}),
                lambert(Vec3(0.5f)));
            const auto traced = builder.build(1);
            double magnitude = 0.0;
            for (const Vec3d& c : t.corners)
                magnitude = std::max({magnitude, std::abs(c.x), std::abs(c.y), std::abs(c.z)});
            const double ulp = std::exp2(std::floor(std::log2(magnitude)) - 23.0);
            const Vec3d across = glm::cross(t.normal, t.along);
            for (int b = 0; b < 50; ++b)
            {
                RayHitBlock block = {};
                for (int i = 0; i < kLanes; ++i)
                {
                    double u = random(), v = random();
                    if (u + v > 1.0)
                    {
                        u = 1.0 - u;
                        v = 1.0 - v;
                    }
                    const Vec3d aim = t.corners[0] + u * (t.corners[1] - t.corners[0]) +
                                      v * (t.corners[2] - t.corners[0]);
                    const double angle = glm::radians(random.between(0.1, 1.0)),
                                 turn = random.between(0.0, 2.0 * M_PI);
                    const Vec3d d =
                        std::cos(angle) * (std::cos(turn) * t.along + std::sin(turn) * across) -
                        std::sin(angle) * t.normal;
                    const Vec3 origin(aim - d * length * random.between(10.0, 50.0)), direction(d);
                    setRay(block.ray, i, origin, direction);
                }
                traced->intersector().closestHits(block, kAllLanes, Coherence::Incoherent);
                SurfaceLanes surface;
                surfacesOf(traced->surfaces(), block, kAllLanes, surface);
                for (const int i : lanesIn(surface.hits))
                {
                    const Vec3d p(surface.position.x[i], surface.position.y[i],
                                  surface.position.z[i]);
                    worst = std::max(worst, distanceTo(t, p) / ulp);
                    ++hits;
                }
            }
        }
        CAPTURE(length, hits, worst);
        CHECK(hits > 10000);
        CHECK(worst <= 8.0);
    }
}
