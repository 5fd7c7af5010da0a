// MediaShapesTest.cpp - the mean length of ways through bodies of many shapes.
// SPDX-License-Identifier: MIT
#include "tests/EnclosedVolume.h"
#include "tests/integrators/MediaScenes.h"

using namespace osgRayTrace::engine;
using namespace osgRayTrace::engine::test;

namespace
{

constexpr double kTurn = 6.28318530717959;

/// Returns a prism over a polygon that is seen whole from its first corner.
std::shared_ptr<Mesh> prism(const std::vector<Vec2>& outline, float height)
{
    std::vector<Vec3> positions;
    for (const float z : {-0.5f * height, 0.5f * height})
        for (const Vec2& p : outline)
            positions.push_back({p.x, p.y, z});
    const auto count = static_cast<uint32_t>(outline.size());
    std::vector<UVec3> triangles;
    for (uint32_t k = 0; k < count; ++k)
    {
        const uint32_t next = (k + 1) % count;
        triangles.push_back({k, next, next + count});
        triangles.push_back({k, next + count, k + count});
        if (k < 1 || next == 0) continue;
        triangles.push_back({0, next, k});
        triangles.push_back({count, k + count, next + count});
    }
    return newMesh(positions, triangles);
}

/// Returns the solid of a closed profile that turns about the z axis; x of the profile is the
/// radius. The profile is anticlockwise.
std::shared_ptr<Mesh> turned(const std::vector<Vec2>& profile, uint32_t steps)
{
    std::vector<Vec3> positions;
    std::vector<UVec3> triangles;
    const auto count = static_cast<uint32_t>(profile.size());
    for (uint32_t step = 0; step < steps; ++step)
    {
        const double turn = kTurn * step / steps;
        const uint32_t here = step * count, there = (step + 1) % steps * count;
        for (uint32_t k = 0; k < count; ++k)
        {
            const uint32_t next = (k + 1) % count;
            positions.push_back({profile[k].x * float(std::cos(turn)),
                                 profile[k].x * float(std::sin(turn)), profile[k].y});
            triangles.push_back({here + k, there + k, there + next});
            triangles.push_back({here + k, there + next, here + next});
        }
    }
    return newMesh(positions, triangles);
}

std::vector<Vec2> circle(Vec2 centre, float radius, uint32_t corners)
{
    std::vector<Vec2> profile;
    for (uint32_t k = 0; k < corners; ++k)
    {
        const double turn = kTurn * k / corners;
        profile.push_back(centre + radius * Vec2(std::cos(turn), std::sin(turn)));
    }
    return profile;
}

std::shared_ptr<Mesh> both(const std::shared_ptr<Mesh>& a, const std::shared_ptr<Mesh>& b)
{
    std::vector<Vec3> positions(a->positions.begin(), a->positions.end());
    std::vector<UVec3> triangles(a->triangles.begin(), a->triangles.end());
    const auto first = static_cast<uint32_t>(positions.size());
    positions.insert(positions.end(), b->positions.begin(), b->positions.end());
    for (const UVec3& t : b->triangles)
        triangles.push_back({t.x + first, t.y + first, t.z + first});
    return newMesh(positions, triangles);
}

std::shared_ptr<Mesh> tetrahedron()
{
    return newMesh({{1, 1, 1}, {1, -1, -1}, {-1, 1, -1}, {-1, -1, 1}},
                   {{0, 1, 2}, {0, 3, 1}, {0, 2, 3}, {1, 3, 2}});
}

} // namespace

TEST_CASE("media: what a body emits comes out, however it scatters and whatever its shape",
          "[integrators][statistics][media][long]")
{
    // The mean length of ways through a body that does not absorb is 4 V/S, whatever scatters in it
    // [Blanco03]; so the flux through all parallel projections is the emission per length times the
    // volume.
    const std::pair<const char*, std::shared_ptr<Mesh>> bodies[] = {
        {"box", boxMesh({-0.5f, -0.8f, -0.3f}, {0.5f, 0.8f, 0.3f})},
        {"plate", boxMesh({-1.2f, -1.0f, -0.02f}, {1.2f, 1.0f, 0.02f})},
        {"sphere", sphereMesh(Vec3(0.0f), 1.0f, 24)},
        {"tetrahedron", tetrahedron()},
        {"L", prism({{-0.8f, -0.8f},
                     {1.2f, -0.8f},
                     {1.2f, 0.2f},
                     {0.2f, 0.2f},
                     {0.2f, 1.2f},
                     {-0.8f, 1.2f}},
                    1.0f)},
        {"cylinder", prism(circle(Vec2(0.0f), 0.9f, 24), 1.0f)},
        {"ring", turned(circle({1.0f, 0.0f}, 0.4f, 16), 32)},
        {"cup", turned({{0.01f, -0.9f},
                        {0.9f, -0.9f},
                        {0.9f, 0.9f},
                        {0.7f, 0.9f},
                        {0.7f, -0.6f},
                        {0.01f, -0.6f}},
                       24)},
        {"star", prism({{0, 0},
                        {0.4f, -0.2f},
                        {1.4f, 0},
                        {0.4f, 0.2f},
                        {0.1f, 1.3f},
                        {-0.3f, 0.3f},
                        {-1.3f, 0.2f}},
                       0.8f)},
        {"two balls",
         both(sphereMesh({-0.8f, 0, 0}, 0.6f, 16), sphereMesh({0.8f, 0, 0}, 0.7f, 16))}};
    for (const auto& [name, mesh] : bodies)
        for (const float ior : {1.0f, 1.5f})
        {
            const float g = ior == 1.0f ? 0.0f : 0.7f;
            Medium medium = mediumOf(4.0f, 1.0f, g);
            medium.emission = Vec3(1.0f);
            SceneBuilder builder;
            builder.add(mesh, bodyOf(medium, ior));
            const auto traced = builder.build();
            const double volume = enclosedVolume(*mesh), side = 4.4;
            Uniform random(5);
            Estimate flux;
            for (uint32_t k = 0; k < 384; ++k)
            {
                const double z = random.between(-1.0, 1.0), turn = random.between(0.0, kTurn);
                const double across = std::sqrt(1.0 - z * z);
                const Vec3d towards(across * std::cos(turn), across * std::sin(turn), z);
                const Picture picture = render(traced, patchView(Vec3d(0.0), towards, side, 32),
                                               optionsOf(IntegratorKind::Path, 64, k), 1);
                flux.add(double(picture.mean().y) * side * side);
            }
            CAPTURE(name, volume, ior, g, flux.mean(), flux.standardError());
            CHECK(flux.agrees(volume, 2e-3 * volume));
            CHECK(flux.standardError() < 0.03 * volume);
        }
}
